"""Keyframes as data: states of bodies, by name."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from carom.description.pose import Pose, Vector3
from carom.errors import DescriptionError


@dataclass(frozen=True, slots=True)
class BodyKeyframe:
    """A state of one body; those of several bodies with the same name are a state of their scene.

    A reset to it keeps the pose of the base and the positions of joints where they are None. Velocities,
    controls and activations become 0 where they are None.

    Attributes:
        name: Its name among the keyframes of the body.
        time: Simulated time [s].
        pose: The base link's frame in the world.
        linear_velocity: Of the origin of the base link's frame, world axes [m/s].
        angular_velocity: Of the base, world axes [rad/s].
        positions: Of all movable joints in order, four numbers (x, y, z, w) for a spherical one.
        velocities: Likewise, three for a spherical joint, as in `Joints.velocities`.
        controls: Of the actuators, in order.
        activations: Likewise.
    """

    name: str
    time: float = 0.0
    pose: Pose | None = None
    linear_velocity: Vector3 | None = None
    angular_velocity: Vector3 | None = None
    positions: tuple[float, ...] | None = None
    velocities: tuple[float, ...] | None = None
    controls: tuple[float, ...] | None = None
    activations: tuple[float, ...] | None = None

    def check(self, positions: int, velocities: int, actuators: int) -> None:
        """Raise `DescriptionError` unless it fits a body with so many coordinates and actuators."""
        counts = {
            "positions": positions,
            "velocities": velocities,
            "controls": actuators,
            "activations": actuators,
        }
        for field, count in counts.items():
            values = getattr(self, field)
            if values is not None and len(values) != count:
                raise DescriptionError(
                    f"keyframe {self.name!r} has {len(values)} {field}; the body needs {count}"
                )
        pose = () if self.pose is None else (*self.pose.position, *self.pose.orientation)
        parts = (self.linear_velocity, self.angular_velocity, *(getattr(self, field) for field in counts))
        numbers = [self.time, *pose, *(number for part in parts for number in part or ())]
        if not all(-inf < number < inf for number in numbers):
            raise DescriptionError(f"keyframe {self.name!r} has numbers that are not finite")
