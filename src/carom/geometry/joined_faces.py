"""Faces of a solid that are turned in nearly the same direction, joined as MuJoCo joins those of meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.geometry.polyhedron import Polyhedron, polyhedron

if TYPE_CHECKING:
    from numpy.typing import NDArray

CELL = 0.01
"""Faces are joined whose directions have the same azimuth and polar angle in steps of so much [rad]."""

_POLAR = 1e-7
"""Less than so much below 1 is the size of the third component of directions that are along the axis."""


def joined_by_direction(solid: Polyhedron) -> Polyhedron:
    """The same solid, faces that share an edge and have one direction joined.

    Vertices within a joined face stay, and are corners of none.
    """
    groups = _directions(solid.planes[:, :3])
    faces = np.repeat(np.arange(len(groups)), solid.corner_count)
    ends = solid.following()
    edges = {
        (a, b): face for a, b, face in zip(solid.corners.tolist(), ends.tolist(), faces.tolist(), strict=True)
    }
    parents = list(range(len(groups)))
    inner = set[tuple[int, int]]()
    for (a, b), face in edges.items():
        other = edges.get((b, a), face)
        if other != face and groups[face] == groups[other]:
            inner.add((a, b))
            parents[_root(parents, face)] = _root(parents, other)
    if not inner:
        return solid
    next_of: dict[int, dict[int, int]] = {}
    for (a, b), face in edges.items():
        if (a, b) not in inner:
            next_of.setdefault(_root(parents, face), {})[a] = b
    loops = [_loop(following) for following in next_of.values()]
    counts = np.array([len(loop) for loop in loops], dtype=np.int32)
    corners = np.array([corner for loop in loops for corner in loop], dtype=np.int32)
    firsts = (np.cumsum(counts) - counts).astype(np.int32)
    return polyhedron(solid.vertices, firsts, counts, corners)


def _directions(normals: NDArray[np.float64]) -> NDArray[np.int64]:
    """A number for the direction of each of (n, 3) unit normals."""
    azimuth = np.rint(np.arctan2(normals[:, 1] + 0.0, normals[:, 0] + 0.0) / CELL)
    polar = np.rint(np.arccos(np.clip(normals[:, 2], -1.0, 1.0)) / CELL)
    along = np.abs(normals[:, 2]) > 1.0 - _POLAR
    azimuth[along] = 0.0
    polar[along] = np.where(normals[along, 2] < 0.0, np.rint(np.pi / CELL), 0.0)
    return (azimuth * 1000.0 + polar).astype(np.int64)


def _root(parents: list[int], face: int) -> int:
    """The face that stands for those joined with a face."""
    while parents[face] != face:
        parents[face] = parents[parents[face]]
        face = parents[face]
    return face


def _loop(following: dict[int, int]) -> list[int]:
    """The corners around a face, from one to the next one."""
    first = next(iter(following))
    loop, corner = [first], following[first]
    while corner != first:
        loop.append(corner)
        corner = following[corner]
    return loop
