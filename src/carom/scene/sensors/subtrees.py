"""Mass and momentum of a link and all links after it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.description.sensor import SensorKind, SensorObject, SensorSpec
from carom.scene.sensors.frames import frame_of
from carom.scene.sensors.source import Source
from carom.scene.sensors.vectors import cross, turned, turned_back

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


def subtree_rows(body: BodyCore, spec: SensorSpec) -> list[int]:
    """Rows of the links of the subtree."""
    link = frame_of(body, SensorObject.LINK, spec.object).link
    members = {link}
    for index, other in enumerate(body.spec.links):
        if other.parent in members:
            members.add(index)
    return [body.first_link + 1 + member for member in sorted(members)]


def _mass(source: Source, rows: list[int]) -> Array:
    """Mass of links, (worlds, 1)."""
    total = np.zeros((source.count, 1))
    for row in rows:
        total = total + source.parameter("link_mass", row)[:, None]
    return total


def _mean(source: Source, rows: list[int], values: Array) -> Array:
    """Mean of vectors of links, weighted by mass; that of the first link if there is no mass."""
    mass, total = _mass(source, rows), np.zeros((source.count, 3))
    for row in rows:
        total = total + source.parameter("link_mass", row)[:, None] * values[:, row, :3]
    return np.where(mass > 0.0, total / np.where(mass > 0.0, mass, 1.0), values[:, rows[0], :3])


def _center(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    return _mean(source, subtree_rows(body, spec), source.poses(body))


def _velocity(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    return _mean(source, subtree_rows(body, spec), source.velocities(body))


def _momentum(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    rows = subtree_rows(body, spec)
    return _mass(source, rows) * _mean(source, rows, source.velocities(body))


def _angular_momentum(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    rows = subtree_rows(body, spec)
    velocities = source.velocities(body)
    poses = source.state("link_pose")
    center, mean = _mean(source, rows, poses), _mean(source, rows, velocities)
    total = np.zeros((source.count, 3))
    for row in rows:
        turn, inertia = poses[:, row, 3:], source.parameter("link_inertia", row)
        spin = turned(turn, inertia * turned_back(turn, velocities[:, row, 3:]))
        lever, speed = poses[:, row, :3] - center, velocities[:, row, :3] - mean
        total = total + spin + source.parameter("link_mass", row)[:, None] * cross(lever, speed)
    return total


OF_SUBTREES: dict[SensorKind, Callable[[Source, BodyCore, SensorSpec], Array]] = {
    SensorKind.SUBTREE_CENTER_OF_MASS: _center,
    SensorKind.SUBTREE_LINEAR_VELOCITY: _velocity,
    SensorKind.SUBTREE_LINEAR_MOMENTUM: _momentum,
    SensorKind.SUBTREE_ANGULAR_MOMENTUM: _angular_momentum,
}
