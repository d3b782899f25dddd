"""Axis-aligned bounds of collision shapes, margins included; PyBullet computes inertias from them."""

from __future__ import annotations

from functools import lru_cache, reduce
from math import trunc

from carom.description import Geometry, Mesh, SignedDistanceField
from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds, scaled_ends
from carom.description.transform import NO_ROTATION, Matrix3
from carom.layouts.contacts import MARGIN
from carom.meshes import MeshPart, read_field_bounds, read_mesh

_HULL_GRID = 10216
"""Vertices of hulls from STL and DAE files lie on a grid of this many cells across their bounds."""

# Few: they are for the body that is being made, and keep the parts of meshes in memory.
_CACHED = 64


def placed_bounds(
    geometry: Geometry, rotation: Matrix3, position: Vector3, *, implicit_cylinder: bool
) -> Bounds:
    """Bounds after rotation and translation: those of the rotated box, except for spheres and planes."""
    bounds = shape_bounds(geometry, implicit_cylinder=implicit_cylinder)
    if geometry.is_unbounded:
        return bounds
    return bounds.placed(rotation if geometry.bounds_turn else NO_ROTATION, position)


def shape_bounds(geometry: Geometry, *, implicit_cylinder: bool) -> Bounds:
    """Bounds of a shape in its own frame, widened by its own margin; see `Shape.bounds`.

    Raises:
        DescriptionError: The file of a mesh cannot be used.
    """
    match geometry:
        case SignedDistanceField(path):
            return Bounds.between(*read_field_bounds(path))
        case Mesh():
            return mesh_bounds(geometry)
        case _:
            return geometry.bounds(implicit_cylinder=implicit_cylinder)


def mesh_bounds(mesh: Mesh) -> Bounds:
    """Bounds of a mesh: of its triangles where it is concave, of its hulls otherwise.

    The hulls of an OBJ file form a compound, which adds a margin of its own.

    Raises:
        DescriptionError: The file cannot be used.
    """
    # For an unchanged file, `read_mesh` returns the same part objects.
    return _bounds_of_parts(mesh, tuple(read_mesh(mesh.path)))


# Inertia, bounds of links and the order of their shapes ask for them, one after the other.
@lru_cache(_CACHED)
def _bounds_of_parts(mesh: Mesh, parts: tuple[MeshPart, ...]) -> Bounds:
    corners = [scaled_ends(part.ends, mesh.scale) for part in parts]
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
    corners = [scaled_ends(part.ends, mesh.scale) for part in read_mesh(mesh.path)]
    return reduce(Bounds.joined, (Bounds.between(*pair) for pair in corners))


def _on_hull_grid(low: float, high: float) -> tuple[float, float]:
    """The ends of a hull along one axis, truncated to the grid on which PyBullet builds it."""
    cell = (high - low) * (1.0 / _HULL_GRID)
    per_cell = 1.0 / cell if cell != 0.0 else 0.0
    middle = (low + high) * 0.5
    return trunc((low - middle) * per_cell) * cell + middle, trunc((high - middle) * per_cell) * cell + middle
