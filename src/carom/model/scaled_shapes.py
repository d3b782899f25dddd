"""Scaling of collision shapes along the axes of a body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from carom.description import Box, Capsule, Collision, Cylinder, Mesh, Plane, Sphere
from carom.description.geometry import MAX_SIZE, ConvexHull, Geometry, TriangleMesh
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
        geometry = _scaled(collision.geometry, factors)
        if not max(*map(abs, frame.position), *_sizes(geometry)) <= MAX_SIZE:
            raise ValueError(f"its shapes would be greater than {MAX_SIZE:g} m")
        scaled.append(replace(collision, geometry=geometry, frame=frame))
    return tuple(scaled)


def _scaled(geometry: Geometry, factors: Vector3) -> Geometry:
    fx, fy, fz = factors
    match geometry:
        case Sphere(radius):
            return Sphere(radius * fx)
        case Box((x, y, z)):
            return Box((x * fx, y * fy, z * fz))
        case Capsule(radius, length):
            return Capsule(radius * fy, length * fz)
        case Cylinder(radius, length):
            if fx != fy:
                raise ValueError("a cylinder has to stay round")
            return Cylinder(radius * fx, length * fz)
        case Plane():
            return geometry
        case Mesh():
            return replace(geometry, scale=_product(geometry.scale, factors))
        case ConvexHull():
            points = geometry.points * np.array(factors)
            return replace(geometry, points=points, scale=_product(geometry.scale, factors))
        case TriangleMesh():
            vertices = geometry.vertices * np.array(factors)
            return replace(geometry, vertices=vertices, scale=_product(geometry.scale, factors))
        case _:
            raise ValueError(f"a {type(geometry).__name__} cannot be scaled")


def _sizes(geometry: Geometry) -> Sequence[float]:
    """Lengths of a shape [m]; of meshes and hulls, which have any, the scale."""
    match geometry:
        case Sphere(radius):
            return (radius,)
        case Box(size):
            return size
        case Capsule(radius, length) | Cylinder(radius, length):
            return (radius, length)
        case Mesh() | ConvexHull() | TriangleMesh():
            return geometry.scale
        case _:
            return ()


def _product(a: Vector3, b: Vector3) -> Vector3:
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])
