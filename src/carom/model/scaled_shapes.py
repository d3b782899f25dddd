"""Scaling of collision shapes along the axes of a body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from carom.description import Collision
from carom.description.geometry import MAX_SIZE
from carom.description.pose import Pose, Vector3
from carom.description.transform import compose, inverse


def scaled_collisions(
    collisions: Sequence[Collision], inertial_frame: Pose, factors: Vector3
) -> tuple[Collision, ...]:
    """Collision shapes scaled by the rules of Bullet's `setLocalScaling`.

    Positions are scaled along the axes of the inertial frame, shapes along their own axes: spheres by the
    factor for x, capsules by those for y (radius) and z (length). Planes are not scaled. Poses are in the
    link frame, and factors, along x, y and z, greater than 0.

    Raises:
        ValueError: A cylinder would not stay round, a kind of shape cannot be scaled, or a shape or its
            offset would be greater than `MAX_SIZE`.
    """
    scaled = []
    for collision in collisions:
        seen = compose(inverse(inertial_frame), collision.frame)
        x, y, z = (a * b for a, b in zip(seen.position, factors, strict=True))
        frame = compose(inertial_frame, Pose((x, y, z), seen.orientation))
        geometry = collision.geometry.scaled(factors)
        if not max(*map(abs, frame.position), *geometry.lengths()) <= MAX_SIZE:
            raise ValueError(f"its shapes would be greater than {MAX_SIZE:g} m")
        scaled.append(replace(collision, geometry=geometry, frame=frame))
    return tuple(scaled)
