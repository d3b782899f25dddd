"""Faces of a solid that are turned in nearly the same direction, joined as MuJoCo joins those of meshes."""

from __future__ import annotations

from math import pi

import numpy as np

from carom.geometry.polyhedron import Polyhedron, polyhedron
from carom.native.trigonometry import acos, atan2

CELL = 0.01
"""Faces are joined whose directions have the same azimuth and polar angle in steps of so much [rad]."""

_POLAR = 1e-7
"""Less than so much below 1 is the size of the third component of directions that are along the axis."""

_NEAR = 1.0 - 1.1 * CELL * CELL
"""Less than the cosine between any two directions in one cell."""


def joined_by_direction(solid: Polyhedron) -> Polyhedron:
    """The same solid, faces that share an edge and have one direction joined.

    Those that would enclose others, or meet themselves at a corner, stay as they are. Vertices within a
    joined face stay, and are corners of none.
    """
    normals = solid.planes[:, :3].tolist()
    faces = np.repeat(np.arange(len(normals)), solid.corner_count)
    ends = solid.following()
    edges = {
        (a, b): face for a, b, face in zip(solid.corners.tolist(), ends.tolist(), faces.tolist(), strict=True)
    }
    parents = list(range(len(normals)))
    inner = set[tuple[int, int]]()
    for (a, b), face in edges.items():
        other = edges.get((b, a), face)
        if other != face and _have_one_direction(normals[face], normals[other]):
            inner.add((a, b))
            parents[_root(parents, face)] = _root(parents, other)
    if not inner:
        return solid
    edges_of: dict[int, list[tuple[int, int]]] = {}
    for edge, face in edges.items():
        if edge not in inner:
            edges_of.setdefault(_root(parents, face), []).append(edge)
    loops = {root: _loop(outer) for root, outer in edges_of.items()}
    kept: list[list[int]] = [loop for loop in loops.values() if loop]
    for face, first in enumerate(solid.first_corner.tolist()):
        if not loops[_root(parents, face)]:
            kept.append(solid.corners[first : first + int(solid.corner_count[face])].tolist())
    counts = np.array([len(loop) for loop in kept], dtype=np.int32)
    corners = np.array([corner for loop in kept for corner in loop], dtype=np.int32)
    firsts = (np.cumsum(counts) - counts).astype(np.int32)
    return polyhedron(solid.vertices, firsts, counts, corners)


def _have_one_direction(normal: list[float], other: list[float]) -> bool:
    """Whether two unit normals have the same azimuth and polar angle, in steps of `CELL`."""
    x, y, z = normal
    if x * other[0] + y * other[1] + z * other[2] < _NEAR:
        return False
    return _direction(*normal) == _direction(*other)


def _direction(x: float, y: float, z: float) -> tuple[int, int]:
    """Azimuth and polar angle of a unit normal, in steps of `CELL`."""
    if abs(z) > 1.0 - _POLAR:
        return 0, 0 if z > 0.0 else round(pi / CELL)
    # Zeros have no sign, which would turn the azimuth around.
    return round(atan2(y + 0.0, x + 0.0) / CELL), round(acos(z) / CELL)


def _root(parents: list[int], face: int) -> int:
    """The face that stands for those joined with a face."""
    while parents[face] != face:
        parents[face] = parents[parents[face]]
        face = parents[face]
    return face


def _loop(edges: list[tuple[int, int]]) -> list[int]:
    """The corners around a face by its edges; none if these are more than one loop."""
    following = dict(edges)
    first, corner = edges[0]
    loop = [first]
    while corner != first and len(loop) < len(edges):
        loop.append(corner)
        corner = following.get(corner, first)
    return loop if len(loop) == len(edges) == len(following) and corner == first else []
