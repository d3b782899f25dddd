"""A rigid transform: the pose of one frame in another."""

from __future__ import annotations

from dataclasses import dataclass

Vector3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Pose:
    """Position and orientation of a frame in its parent frame.

    Attributes:
        position: Origin of the frame [m].
        orientation: Unit quaternion (x, y, z, w).
    """

    position: Vector3 = (0.0, 0.0, 0.0)
    orientation: Quaternion = (0.0, 0.0, 0.0, 1.0)


IDENTITY = Pose()
