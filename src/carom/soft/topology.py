"""Data derived from the cells of a mesh: edges, bending pairs, the surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# Faces of a tetrahedron of positive volume, counter-clockwise from outside.
_FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))


def edges_of(cells: NDArray[np.int32]) -> NDArray[np.int32]:
    """Edges (e, 2) of (m, k) cells: pairs of nodes of the same cell, each once, the lower first, sorted."""
    corners = cells.shape[1]
    pairs = [cells[:, [i, j]] for i in range(corners) for j in range(i + 1, corners)]
    return _unique(np.concatenate(pairs)) if pairs else np.empty((0, 2), dtype=np.int32)


def bending_pairs(edges: NDArray[np.int32], node_count: int) -> NDArray[np.int32]:
    """Pairs of nodes (b, 2), sorted, with a common neighbour that are not neighbours themselves.

    Springs between them resist bending; Bullet has the same. `edges` are (e, 2) pairs of neighbours.
    """
    both = np.concatenate([edges, edges[:, ::-1]])
    both = both[np.argsort(both[:, 0], kind="stable")]
    starts = np.searchsorted(both[:, 0], np.arange(node_count + 1))
    pairs = [np.empty((0, 2), dtype=np.int32)]
    for node in range(node_count):
        neighbours = both[starts[node] : starts[node + 1], 1]
        i, j = np.triu_indices(len(neighbours), 1)
        pairs.append(np.stack([neighbours[i], neighbours[j]], axis=1))
    found = _unique(np.concatenate(pairs))
    known = {tuple(pair) for pair in edges.tolist()}
    return np.array([pair for pair in found.tolist() if tuple(pair) not in known], dtype=np.int32).reshape(
        -1, 2
    )


def surface_of(tetras: NDArray[np.int32]) -> NDArray[np.int32]:
    """Faces (f, 3) of only one tetrahedron, counter-clockwise from outside, in the order of the tetrahedra.

    The tetrahedra (t, 4) have positive volumes.
    """
    faces = np.concatenate([tetras[:, list(face)] for face in _FACES])
    order = np.arange(len(faces)).reshape(len(_FACES), -1).T.ravel()
    faces = faces[order]
    _, inverse, count = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True)
    return np.ascontiguousarray(faces[count[inverse.ravel()] == 1], dtype=np.int32)


def _unique(pairs: NDArray[np.int32]) -> NDArray[np.int32]:
    return np.unique(np.sort(pairs, axis=1), axis=0).astype(np.int32)
