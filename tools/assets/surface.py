"""The surface of a signed-distance field as a mesh of quadrilaterals with smooth normals.

Surface nets (one vertex per grid cell the surface crosses, one face per grid edge), after which every
vertex is drawn onto the surface along the gradient: coarse meshes then look as round as fine ones.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from tools.assets.fields import Field, Points
from tools.assets.obj_mesh import ObjMesh

GRADIENT_STEP = 1e-5
PROJECTIONS = 12


def mesh_of(field: Field, lowest: Points, highest: Points, cell: float) -> ObjMesh:
    """Mesh the surface of a field that lies within a box.

    Args:
        field: The body.
        lowest: Corner of a box around the body (3,) [m].
        highest: The opposite corner.
        cell: Edge of the grid cells [m].
    """
    low = np.asarray(lowest) - 1.5 * cell
    counts = np.ceil((np.asarray(highest) + 1.5 * cell - low) / cell).astype(int) + 1
    axes = [low[i] + cell * np.arange(counts[i]) for i in range(3)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    inside = field(grid.reshape(-1, 3)).reshape(tuple(counts)) < 0.0
    if (
        inside[0].any()
        or inside[-1].any()
        or inside[:, 0].any()
        or inside[:, -1].any()
        or inside[..., (0, -1)].any()
    ):
        raise ValueError("the body reaches out of the box it was said to lie in")
    crossed = _crossed_cells(inside)
    numbers = np.full(crossed.shape, -1)
    numbers[crossed] = np.arange(crossed.sum())
    vertices = low + cell * (np.argwhere(crossed) + 0.5)
    vertices = _drawn_to_surface(field, vertices, cell)
    return ObjMesh(vertices, _quads(inside, numbers), _gradient(field, vertices))


def _crossed_cells(inside: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cells with corners both inside and outside."""
    corners = [
        inside[i : inside.shape[0] - 1 + i, j : inside.shape[1] - 1 + j, k : inside.shape[2] - 1 + k]
        for i in (0, 1)
        for j in (0, 1)
        for k in (0, 1)
    ]
    return np.any(corners, axis=0) & ~np.all(corners, axis=0)


def _quads(inside: NDArray[np.bool_], numbers: NDArray[np.int_]) -> list[tuple[int, ...]]:
    """One face per grid edge that crosses the surface, turned so that it is seen from outside."""
    faces: list[tuple[int, ...]] = []
    for axis in range(3):
        second, third = (axis + 1) % 3, (axis + 2) % 3
        for edge in np.argwhere(np.diff(inside.astype(np.int8), axis=axis) != 0):
            cells = []
            for back_second, back_third in ((1, 1), (0, 1), (0, 0), (1, 0)):
                cell = edge.copy()
                cell[second] -= back_second
                cell[third] -= back_third
                cells.append(int(numbers[tuple(cell)]))
            leaving = bool(inside[tuple(edge)])
            faces.append(tuple(cells if leaving else reversed(cells)))
    return faces


def _gradient(field: Field, points: Points) -> Points:
    """Unit gradient of the field, by central differences."""
    slopes = [
        field(points + GRADIENT_STEP * unit) - field(points - GRADIENT_STEP * unit) for unit in np.eye(3)
    ]
    gradient = np.stack(slopes, axis=1) / (2.0 * GRADIENT_STEP)
    return gradient / np.maximum(np.linalg.norm(gradient, axis=1, keepdims=True), 1e-9)


def _drawn_to_surface(field: Field, points: Points, cell: float) -> Points:
    """Points moved onto the zero of the field, none further than a cell in all."""
    drawn = points.copy()
    for _ in range(PROJECTIONS):
        drawn -= field(drawn)[:, None] * _gradient(field, drawn)
        drawn = points + np.clip(drawn - points, -cell, cell)
    return drawn
