"""What of a replay a file of another format has no place for."""

from __future__ import annotations

from collections.abc import Callable

from carom.replay.replay import Replay

CONTACTS, TENDONS, VALUES = "contacts", "tendons", "values that the script plots"
JOINTS, SENSORS = "positions, velocities and torques of joints", "actuators and sensors"
VELOCITIES, TEXTURES = "velocities of links and loads of joints", "images on shapes"
COLLISIONS, EVENTS = "collision shapes", "drawings and controls of scripts, masses and constraints"


def lost(replay: Replay, *without: str) -> tuple[str, ...]:
    """Of some kinds of things those that the replay has."""
    return tuple(what for what in without if _HELD[what](replay))


def _holds_shape(replay: Replay, *, collision: bool) -> bool:
    return any(
        shape.collision if collision else shape.texture is not None and not shape.collision
        for body in replay.bodies.values()
        for look in body.looks
        for shape in look.shapes
    )


_HELD: dict[str, Callable[[Replay], bool]] = {
    CONTACTS: lambda replay: len(replay.contacts.frame) > 0,
    TENDONS: lambda replay: len(replay.tendons.frame) > 0,
    VALUES: lambda replay: len(replay.values) > 0,
    JOINTS: lambda replay: any(body.joints for body in replay.bodies.values()),
    SENSORS: lambda replay: any(body.actuators or body.sensors for body in replay.bodies.values()),
    VELOCITIES: lambda replay: any(
        link.velocity is not None for body in replay.bodies.values() for link in body.links.values()
    ),
    TEXTURES: lambda replay: _holds_shape(replay, collision=False),
    COLLISIONS: lambda replay: _holds_shape(replay, collision=True),
    EVENTS: lambda replay: len(replay.events) > 0,
}
