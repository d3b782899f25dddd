"""Triangles of height fields."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from carom.geometry.polyhedron import Polyhedron, polyhedron


def heightfield_surface(
    heights: NDArray[np.float64], scale: tuple[float, float, float], middle: float
) -> Polyhedron:
    """The surface of a height field as triangles, two for each cell, cells row by row with x fastest.

    `heights` (columns, rows) are those of the points of the grid; `scale` has the size of a cell along x and
    y [m] and the factor on heights, of which `middle` is that of the origin of the frame.

    Each cell is cut from its corner (x + 1, y) to its corner (x, y + 1), the lower half first. The
    vertices are the points of the grid, row by row with x fastest.
    """
    columns, rows = heights.shape
    sx, sy, sz = scale
    xs = (np.arange(rows) - 0.5 * (rows - 1)) * sx
    ys = (np.arange(columns) - 0.5 * (columns - 1)) * sy
    grid_x, grid_y = np.meshgrid(xs, ys)
    zs = (heights - middle) * sz
    vertices = np.stack([grid_x, grid_y, zs], axis=-1).reshape(-1, 3)
    corner = (np.arange(columns - 1)[:, None] * rows + np.arange(rows - 1)).reshape(-1)
    right, above, across = corner + 1, corner + rows, corner + rows + 1
    lower, upper = np.stack([corner, right, above], axis=1), np.stack([right, across, above], axis=1)
    triangles = np.stack([lower, upper], axis=1).reshape(-1, 3)
    if sx * sy < 0.0:
        triangles = triangles[:, ::-1]
    count = len(triangles)
    firsts = np.arange(0, 3 * count, 3, dtype=np.int32)
    return polyhedron(vertices, firsts, np.full(count, 3, np.int32), triangles.reshape(-1).astype(np.int32))
