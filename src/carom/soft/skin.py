"""A visual mesh that follows the simulated one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

# The cell of a vertex is searched among this number of cells, those whose centres are nearest to it.
_CANDIDATES = 8
# Number of vertices handled at a time, to save memory.
_CHUNK = 256


def bind(vertices: Floats, nodes: Floats, cells: Ints) -> tuple[Ints, Floats]:
    """The nodes (v, k) that each vertex follows, and their weights (v, k), which add up to 1.

    A vertex keeps its barycentric coordinates in the triangle (m, 3) or tetrahedron (m, 4) that contains it.
    A vertex outside of all cells is extrapolated from the nearest cell, as in Bullet. Positions (v, 3) and
    (n, 3) are at rest [m].
    """
    corners = nodes[cells]
    middles = corners.mean(axis=1)
    count = min(_CANDIDATES, len(cells))
    chosen = np.empty((len(vertices), cells.shape[1]), dtype=np.int32)
    weights = np.empty(chosen.shape)
    for start in range(0, len(vertices), _CHUNK):
        points = vertices[start : start + _CHUNK]
        squares = ((points[:, None] - middles) ** 2).sum(axis=2)
        near = np.argpartition(squares, count - 1, axis=1)[:, :count]
        found = _weights(points[:, None], corners[near])
        best = found.min(axis=2).argmax(axis=1)
        rows = np.arange(len(points))
        chosen[start : start + _CHUNK] = cells[near[rows, best]]
        weights[start : start + _CHUNK] = found[rows, best]
    return chosen, weights


def _weights(points: Floats, corners: Floats) -> Floats:
    """Barycentric coordinates of points, or of their projections onto triangles: (..., 3 or 4)."""
    edges = np.swapaxes(corners[..., 1:, :] - corners[..., :1, :], -1, -2)
    offset = points - corners[..., 0, :]
    others = (np.linalg.pinv(edges) @ offset[..., None])[..., 0]
    return np.concatenate([1.0 - others.sum(axis=-1, keepdims=True), others], axis=-1)
