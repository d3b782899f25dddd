"""Axis-aligned bounds of collision shapes, margins included; PyBullet computes inertias from them."""

from __future__ import annotations

from functools import reduce
from math import trunc
from typing import NamedTuple

import numpy as np

from carom.description import (
    Box,
    Capsule,
    ConvexHull,
    Cylinder,
    Geometry,
    Heightfield,
    Mesh,
    Plane,
    SignedDistanceField,
    Sphere,
    TriangleMesh,
)
from carom.description.pose import Vector3
from carom.description.transform import NO_ROTATION, Matrix3
from carom.formats.mesh import read_field_bounds, read_mesh
from carom.layouts.contacts import MARGIN

_HULL_GRID = 10216
"""Vertices of hulls from STL and DAE files lie on a grid of this many cells across their bounds."""

_UNBOUNDED = 1e30
"""Half extent of planes [m]; large enough to represent an infinite one."""


def turned_box(
    center: Vector3, half: Vector3, rotation: Matrix3, position: Vector3
) -> tuple[Vector3, Vector3]:
    """Centre and half sizes of the bounds of a box after rotation and translation."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rotation
    cx, cy, cz = center
    hx, hy, hz = half
    px, py, pz = position
    return (
        (
            xx * cx + xy * cy + xz * cz + px,
            yx * cx + yy * cy + yz * cz + py,
            zx * cx + zy * cy + zz * cz + pz,
        ),
        (
            abs(xx) * hx + abs(xy) * hy + abs(xz) * hz,
            abs(yx) * hx + abs(yy) * hy + abs(yz) * hz,
            abs(zx) * hx + abs(zy) * hy + abs(zz) * hz,
        ),
    )


class Bounds(NamedTuple):
    """An axis-aligned box.

    Attributes:
        center: Its centre [m].
        half: Half its size along each axis [m].
    """

    center: Vector3
    half: Vector3

    @classmethod
    def between(cls, low: Vector3, high: Vector3) -> Bounds:
        """The box with these corners."""
        return cls(
            (0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])),
            (0.5 * (high[0] - low[0]), 0.5 * (high[1] - low[1]), 0.5 * (high[2] - low[2])),
        )

    def grown(self, margin: float) -> Bounds:
        """The box, larger by a margin on every side."""
        x, y, z = self.half
        return Bounds(self.center, (x + margin, y + margin, z + margin))

    def placed(self, rotation: Matrix3, position: Vector3) -> Bounds:
        """Bounds of the box after rotation and translation."""
        return Bounds(*turned_box(self.center, self.half, rotation, position))

    def joined(self, other: Bounds) -> Bounds:
        """The bounding box of both boxes."""
        low = [
            min(a - h, b - k)
            for a, h, b, k in zip(self.center, self.half, other.center, other.half, strict=True)
        ]
        high = [
            max(a + h, b + k)
            for a, h, b, k in zip(self.center, self.half, other.center, other.half, strict=True)
        ]
        return Bounds.between((low[0], low[1], low[2]), (high[0], high[1], high[2]))


def placed_bounds(
    geometry: Geometry, rotation: Matrix3, position: Vector3, *, implicit_cylinder: bool
) -> Bounds:
    """Bounds after rotation and translation: those of the rotated box, except for spheres and planes."""
    bounds = shape_bounds(geometry, implicit_cylinder=implicit_cylinder)
    if isinstance(geometry, Plane):
        return bounds
    return bounds.placed(NO_ROTATION if isinstance(geometry, Sphere) else rotation, position)


def shape_bounds(geometry: Geometry, *, implicit_cylinder: bool) -> Bounds:
    """Bounds of a shape in its own frame, widened by its own margin.

    The margin of a hull counts twice: once in the bounds of its points and once around them. Unless cylinders
    are implicit, they are hulls of their rims.

    Raises:
        DescriptionError: The file of a mesh cannot be used.
    """
    origin = (0.0, 0.0, 0.0)
    match geometry:
        case Sphere(radius):
            return Bounds(origin, (radius, radius, radius))
        case Box(half_extents):
            return Bounds(origin, half_extents)
        case Capsule(radius, length):
            return Bounds(origin, (radius, radius, radius + 0.5 * length))
        case Cylinder(radius, length):
            exact = Bounds(origin, (radius, radius, 0.5 * length))
            return exact if implicit_cylinder else exact.grown(MARGIN).grown(MARGIN)
        case Plane():
            return Bounds(origin, (_UNBOUNDED, _UNBOUNDED, _UNBOUNDED))
        case SignedDistanceField(path):
            return Bounds.between(*read_field_bounds(path))
        case Mesh():
            return mesh_bounds(geometry)
        case ConvexHull(points=points):
            return _point_bounds(points).grown(MARGIN).grown(MARGIN)
        case TriangleMesh(vertices=vertices, margin=margin):
            return _point_bounds(vertices).grown(margin)
        case Heightfield(heights, (sx, sy, sz), middle):
            columns, rows = heights.shape
            low, high = sorted((sz * (float(heights.min()) - middle), sz * (float(heights.max()) - middle)))
            x, y = 0.5 * abs(sx) * (rows - 1), 0.5 * abs(sy) * (columns - 1)
            return Bounds.between((-x, -y, low), (x, y, high))


def _point_bounds(points: np.ndarray) -> Bounds:
    return Bounds.between(*_scaled_corners(points, (1.0, 1.0, 1.0)))


def mesh_bounds(mesh: Mesh) -> Bounds:
    """Bounds of a mesh: of its triangles where it is concave, of its hulls otherwise.

    The hulls of an OBJ file form a compound, which adds a margin of its own.

    Raises:
        DescriptionError: The file cannot be used.
    """
    corners = [_scaled_corners(part.vertices, mesh.scale) for part in read_mesh(mesh.path)]
    if mesh.concave:
        return reduce(Bounds.joined, (Bounds.between(*pair) for pair in corners))
    if mesh.path.suffix.lower() == ".obj":
        hulls = (Bounds.between(*pair).grown(MARGIN).grown(MARGIN) for pair in corners)
        return reduce(Bounds.joined, hulls).grown(MARGIN)
    (x0, x1), (y0, y1), (z0, z1) = (
        _on_hull_grid(min(low[axis] for low, _ in corners), max(high[axis] for _, high in corners))
        for axis in range(3)
    )
    return Bounds.between((x0, y0, z0), (x1, y1, z1)).grown(MARGIN).grown(MARGIN)


def vertex_bounds(mesh: Mesh) -> Bounds:
    """Bounds of the vertices of a mesh, without any margin; raises `DescriptionError` as `mesh_bounds`."""
    corners = [_scaled_corners(part.vertices, mesh.scale) for part in read_mesh(mesh.path)]
    return reduce(Bounds.joined, (Bounds.between(*pair) for pair in corners))


def _scaled_corners(vertices: np.ndarray, scale: Vector3) -> tuple[Vector3, Vector3]:
    """Lowest and highest corner of scaled vertices."""
    ends = np.stack([vertices.min(axis=0), vertices.max(axis=0)]) * np.asarray(scale)
    low, high = ends.min(axis=0).tolist(), ends.max(axis=0).tolist()
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])


def _on_hull_grid(low: float, high: float) -> tuple[float, float]:
    """The ends of a hull along one axis, truncated to the grid on which PyBullet builds it."""
    cell = (high - low) * (1.0 / _HULL_GRID)
    per_cell = 1.0 / cell if cell != 0.0 else 0.0
    middle = (low + high) * 0.5
    return trunc((low - middle) * per_cell) * cell + middle, trunc((high - middle) * per_cell) * cell + middle
