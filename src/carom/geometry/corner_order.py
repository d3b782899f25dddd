"""The corners of convex hulls on the grid on which PyBullet makes them, in the order in which it lists them.

Which corner a search finds first, of several that are equally far, is left to this order. It depends on all
points, also those inside, and on how often each is there: `native/source/hulls/corner_order.cpp` says how.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.hulls import CornerWork
from carom.native.library import library

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Points = NDArray[np.float64]
    Ints = NDArray[np.int32]

GRID = 10216
"""Cells across a hull of the grid on which its corners lie."""

_SPOKES_PER_POINT = 32
_CELLS = 2 * GRID
_ARRAYS = ("lead", "outline", "seen", "far", "after", "before", "bridges", "order")


class Grid:
    """The grid on which PyBullet makes the hull of points.

    The order of operations is PyBullet's: rounding decides whether an extreme point is on the outermost grid
    line or on the one below.
    """

    __slots__ = ("_extent", "_middle", "_step")

    def __init__(self, points: Points) -> None:
        """Take the bounds of (n, 3) points; their extent along each axis is 0, or has a reciprocal."""
        low, high = points.min(axis=0), points.max(axis=0)
        self._extent: Points = high - low
        self._step: Points = self._extent * (1.0 / GRID)
        self._middle: Points = (low + high) * 0.5

    def cells(self, points: Points) -> Points:
        """The whole numbers (n, 3) of the cells of points within the bounds."""
        flat = self._step == 0.0
        return np.trunc((points - self._middle) * (1.0 / np.where(flat, np.inf, self._step)))

    def places(self, cells: Points) -> Points:
        """Positions (n, 3) of cells."""
        return cells * self._step + self._middle

    def axes(self) -> tuple[int, int, int]:
        """The axes along which the extent is neither the greatest nor the least, the greatest, the least."""
        x, y, z = self._extent.tolist()
        greatest = (2 if y < z else 1) if x < y else (2 if x < z else 0)
        least = (0 if x < z else 2) if x < y else (1 if y < z else 2)
        if least == greatest:
            least = (greatest + 1) % 3
        return 3 - greatest - least, greatest, least


def corner_order(points: Points, grid: Grid, uses: Ints | None = None) -> tuple[NDArray[np.intp], Ints]:
    """The corners of the hull of (n, 3) points on their grid, in PyBullet's order.

    Args:
        points: The points that the grid is of.
        grid: The grid.
        uses: (n,) how often each of the points is there, at least once; None for once.

    Returns:
        The number of a point at each of the corners, and the place in this list of each point; of points that
        are no corners, the length of the list.
    """
    axes = grid.axes()
    cells = grid.cells(points)[:, axes].astype(np.int64)
    if (axes[0] + 1) % 3 != axes[1]:
        # The axes in this order are left-handed: all is mirrored, so that faces keep their outsides.
        cells = -cells
    keys = (cells[:, 1] * _CELLS + cells[:, 0]) * _CELLS + cells[:, 2]
    _, firsts, numbers = np.unique(keys, return_index=True, return_inverse=True)
    numbers = numbers.reshape(-1)
    listed = _listed(
        np.ascontiguousarray(cells[firsts], dtype=np.int32),
        np.bincount(numbers, weights=uses).astype(np.int64),
    )
    ranks = np.full(len(firsts), len(listed), np.int32)
    ranks[listed] = np.arange(len(listed))
    return firsts[listed], ranks[numbers]


def _listed(points: Ints, uses: NDArray[np.int64]) -> Ints:
    """Indices of corners of the hull of distinct points, sorted by y, then x, then z, in PyBullet's order."""
    count = len(points)
    point_of = np.repeat(np.arange(count, dtype=np.int32), uses)
    work = CornerWork(points.ctypes.data, point_of.ctypes.data, count, len(point_of), 0)
    function = library().symbols["carom_corner_order"]
    function.restype = ctypes.c_int64
    spokes = _SPOKES_PER_POINT * count
    while True:
        lengths = (count, 4 * count, count, spokes, spokes, spokes, 3 * spokes, count)
        arrays = [np.empty(length, np.int32) for length in lengths]
        for name, array in zip(_ARRAYS, arrays, strict=True):
            setattr(work, name, array.ctypes.data)
        work.most_spokes = spokes
        listed = function(ctypes.byref(work))
        if listed >= 0:
            return arrays[-1][:listed]
        # Edges that vanish on the way need room as well.
        spokes *= 2
