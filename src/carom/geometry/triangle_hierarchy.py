"""Bounding volume hierarchy of triangles: boxes around boxes, to find the triangles in a region quickly."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom.geometry.polyhedron import Polyhedron


class TriangleHierarchy(NamedTuple):
    """A complete binary tree of boxes over the faces of a surface.

    Node 1 is the root; nodes 2n and 2n + 1 lie below node n; leaf i is node `leaf_count` + i and holds face i
    of `surface`. Nodes without faces have a lower corner above their upper one. Node 0 is unused.
    `leaf_count` is a power of two; `lower` and `upper` are the corners, (2 * leaf_count, 3).
    """

    surface: Polyhedron
    leaf_count: int
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]


def triangle_hierarchy(surface: Polyhedron) -> TriangleHierarchy:
    """Build the hierarchy of a surface whose faces are all triangles."""
    corners = surface.corners.reshape(-1, 3)
    count = len(corners)
    leaf_count = 1
    while leaf_count < count:
        leaf_count *= 2
    points = surface.vertices[corners]
    lower, upper = points.min(axis=1), points.max(axis=1)
    order = _sorted_in_halves(0.5 * (lower + upper), leaf_count)
    low = np.full((2 * leaf_count, 3), np.inf)
    high = np.full((2 * leaf_count, 3), -np.inf)
    low[leaf_count : leaf_count + count] = lower[order]
    high[leaf_count : leaf_count + count] = upper[order]
    first = leaf_count
    while first > 1:
        first //= 2
        low[first : 2 * first] = low[2 * first : 4 * first].reshape(first, 2, 3).min(axis=1)
        high[first : 2 * first] = high[2 * first : 4 * first].reshape(first, 2, 3).max(axis=1)
    sorted_surface = Polyhedron(
        surface.vertices,
        surface.planes[order],
        surface.first_corner,
        surface.corner_count,
        corners[order].reshape(-1),
    )
    return TriangleHierarchy(sorted_surface, leaf_count, low, high)


def _sorted_in_halves(centers: NDArray[np.float64], leaf_count: int) -> NDArray[np.int64]:
    """An order in which the faces of every node are sorted along the axis of their largest extent."""
    order = np.arange(len(centers))
    run = leaf_count
    while run > 1:
        firsts = np.arange(0, len(centers), run)
        spread = np.maximum.reduceat(centers[order], firsts) - np.minimum.reduceat(centers[order], firsts)
        group = np.arange(len(centers)) // run
        along = centers[order, spread.argmax(axis=1)[group]]
        order = order[np.lexsort((along, group))]
        run //= 2
    return order
