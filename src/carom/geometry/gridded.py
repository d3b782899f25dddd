"""Hulls of points on PyBullet's grid, by one call of the library: `native/source/hulls/gridded.cpp`."""

from __future__ import annotations

import ctypes
import sys
from typing import TYPE_CHECKING

import numpy as np

from carom.geometry.corner_order import GRID
from carom.geometry.native_hull import COPLANAR, PARALLEL
from carom.geometry.polyhedron import polyhedron
from carom.native.arrays import c_array
from carom.native.library import library

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from carom.geometry.polyhedron import Polyhedron

ROUNDING = 1e-9
"""Height above a face below which a point counts as lying on it, relative to the size of the hull."""

SMALLEST, LARGEST = 1e-60, 1e70
"""Sizes below which points coincide and above which they are refused: squares of areas stay in range [m]."""

FLAT = 1e-6
"""Relative thickness below which points count as lying in a plane, on a line or in one point."""

_DONE, _NO_ROOM = range(2)


def hull_on_grid(
    points: NDArray[np.float64], uses: NDArray[np.int32] | None, tolerance: float, most_vertices: int
) -> Polyhedron | None:
    """What `carom.geometry.hull.gridded_hull` gives; None if points have to be looked at there.

    That is so where they are in a plane, too far apart, or not finite.
    """
    points = np.ascontiguousarray(points, dtype=np.float64)
    uses = None if uses is None else np.ascontiguousarray(uses, dtype=np.int32)
    numbers = c_array(
        ctypes.c_double,
        9,
        (FLAT, ROUNDING, tolerance, COPLANAR, PARALLEL, sys.float_info.min, SMALLEST, LARGEST, GRID),
    )
    places = c_array(ctypes.c_int64, 6)
    total = len(points) if uses is None else int(uses.sum())
    symbols, factor = library().symbols, 1
    room, make = symbols["carom_gridded_bytes"], symbols["carom_gridded_hull"]
    room.restype = make.restype = ctypes.c_int64
    while True:
        sizes = c_array(ctypes.c_int64, 4, (len(points), total, most_vertices, factor))
        memory = np.empty(room(sizes), np.uint8)
        outcome = make(_pointer(points), _pointer(uses), sizes, numbers, _pointer(memory), places)
        if outcome != _NO_ROOM:
            break
        # Faces and edges that vanish on the way need room as well.
        factor *= 2
    if outcome != _DONE:
        return None
    at, vertices, at_corners, corner_count, at_counts, faces = places
    counts = np.frombuffer(memory, np.int32, faces, at_counts).copy()
    return polyhedron(
        np.frombuffer(memory, np.float64, 3 * vertices, at).reshape(-1, 3).copy(),
        (counts.cumsum() - counts).astype(np.int32),
        counts,
        np.frombuffer(memory, np.int32, corner_count, at_corners).copy(),
    )


def first_corners(points: NDArray[np.float64], thin: float) -> list[int]:
    """Four of (n, 3) points that span a volume, or fewer if all lie in a plane, on a line or in one point.

    They do so up to a distance `thin` [m].
    """
    points = np.ascontiguousarray(points)
    corners = c_array(ctypes.c_int32, 4)
    function = library().symbols["carom_first_corners"]
    function.restype = ctypes.c_int64
    count = function(
        _pointer(points), ctypes.c_int64(len(points)), ctypes.byref(ctypes.c_double(thin)), corners
    )
    return corners[:count]


def _pointer(array: NDArray[np.generic] | None) -> ctypes.c_void_p:
    # `array.ctypes` takes several times as long.
    return ctypes.c_void_p(None if array is None else array.__array_interface__["data"][0])
