"""Which vertices and faces of a hull are beside each other, for searches from vertex to vertex."""

from __future__ import annotations

from functools import cache
from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from carom.geometry.polyhedron import Polyhedron, polyhedron
from carom.layouts.codes import FIRST_LOOKED_AT
from carom.native.products import product
from carom.native.trigonometry import cos, sin

if TYPE_CHECKING:
    from numpy.typing import NDArray

CLIMBED = 64
"""Hulls of more vertices are climbed; of fewer, all vertices are looked at in less time."""

_TURN = pi * (3.0 - sqrt(5.0))


def spread_first(fine: Polyhedron, joined: Polyhedron) -> tuple[Polyhedron, Polyhedron]:
    """Two solids of the same vertices, those first that are farthest along directions all around."""
    count = len(fine.vertices)
    half = np.maximum(0.5 * (fine.vertices.max(axis=0) - fine.vertices.min(axis=0)), 1e-300)
    farthest = product(fine.vertices / half, _all_around().T).argmax(axis=0)
    order = np.array(list(dict.fromkeys([*farthest.tolist(), *range(count)])))
    rank = np.empty(count, dtype=np.int32)
    rank[order] = np.arange(count, dtype=np.int32)
    vertices = np.ascontiguousarray(fine.vertices[order])
    first, second = (
        polyhedron(vertices, each.first_corner, each.corner_count, rank[each.corners])
        for each in (fine, joined)
    )
    return first, second


@cache
def _all_around() -> NDArray[np.float64]:
    """Directions evenly all around, (n, 3): on a spiral from pole to pole."""
    found = []
    for number in range(FIRST_LOOKED_AT):
        height = 1.0 - (2.0 * number + 1.0) / FIRST_LOOKED_AT
        across, angle = sqrt(1.0 - height * height), _TURN * number
        found.append((across * cos(angle), across * sin(angle), height))
    return np.array(found)


def packed_graph(fine: Polyhedron, joined: Polyhedron) -> NDArray[np.float64]:
    """For each vertex its neighbours along edges of `fine`, and the faces of `joined` that it is a corner of.

    Returns:
        Numbers, three a row: of n vertices where the neighbours of each begin, and where its faces do, in
        turns, and where the last faces end; and from there on these, as indices of vertices and of faces.
    """
    count = len(fine.vertices)
    ends = fine.following()
    owners = np.concatenate([fine.corners, ends])
    others = np.concatenate([ends, fine.corners])
    pairs = np.unique(np.stack([owners, others], axis=1), axis=0)
    faces = np.repeat(np.arange(len(joined.planes)), joined.corner_count)
    by_vertex = np.lexsort((faces, joined.corners))
    neighbour_counts = np.bincount(pairs[:, 0], minlength=count)
    face_counts = np.bincount(joined.corners, minlength=count)
    starts = np.concatenate([[0], np.cumsum(np.stack([neighbour_counts, face_counts], axis=1).ravel())])
    values = np.empty(starts[-1], dtype=np.int64)
    kinds = np.concatenate([2 * pairs[:, 0], 2 * joined.corners[by_vertex] + 1])
    values[:] = np.concatenate([pairs[:, 1], faces[by_vertex]])[np.argsort(kinds, kind="stable")]
    flat = np.concatenate([starts + len(starts), values]).astype(np.float64)
    return np.concatenate([flat, np.zeros(-len(flat) % 3)]).reshape(-1, 3)


def rows_of_graph(vertices: NDArray[np.float64], count: int) -> int:
    """How many rows a graph has that stands after `count` vertices of a hull."""
    last = 2 * count
    return -(-int(vertices[count + last // 3, last % 3]) // 3)
