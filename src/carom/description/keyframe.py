"""Keyframes as data: states of the bodies of a scene, by name."""

from __future__ import annotations

from carom.description.pose import Pose, Vector3
from carom.record import record


@record
class BodyKeyframe:
    """The state of one body; what is None stays as it was loaded.

    Attributes:
        pose: The base link's frame in the world.
        linear_velocity: Of the origin of the base link's frame, world axes [m/s].
        angular_velocity: Of the base, world axes [rad/s].
        positions: Of all movable joints in order, four numbers (x, y, z, w) for a spherical one.
        velocities: Likewise, three for a spherical joint.
        controls: Of the actuators, in order.
        activations: Likewise.
    """

    pose: Pose | None = None
    linear_velocity: Vector3 | None = None
    angular_velocity: Vector3 | None = None
    positions: tuple[float, ...] | None = None
    velocities: tuple[float, ...] | None = None
    controls: tuple[float, ...] | None = None
    activations: tuple[float, ...] | None = None


@record
class KeyframeSpec:
    """A state of a scene.

    Attributes:
        name: Its name.
        time: Simulated time [s].
        bodies: States of bodies, by the index of the body in the scene; others stay as they were loaded.
    """

    name: str
    time: float = 0.0
    bodies: tuple[tuple[int, BodyKeyframe], ...] = ()
