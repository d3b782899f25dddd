"""The loops of quickhull, in the native library: `native/source/hulls/quickhull.cpp`. Memory is NumPy's."""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.hulls import HullEdge, HullEntry, HullFace, HullWork, MergeWork
from carom.native.library import library

if TYPE_CHECKING:
    from numpy.typing import NDArray

    _Entry = ctypes.Structure | ctypes.c_int32 | ctypes.c_double

COPLANAR = 1e-5
"""Distance from a plane, relative to the size of the hull, up to which a vertex counts as in the plane."""

MIN_FACES = 4
"""Fewest faces that can enclose a volume."""

PARALLEL = 0.999
"""Least cosine between the normals of triangles that are joined."""

_FACES_PER_VERTEX = 12
_FEWEST_FACES = 256


class _Memory:
    """Arrays that live as long as a call of the library needs them."""

    def __init__(self) -> None:
        self.arrays: list[np.ndarray] = []

    def new(self, length: int, kind: type[_Entry] = ctypes.c_int32) -> int:
        """The address of a new array."""
        # Of bytes: making a data type of a structure takes longer than a small hull.
        return self.address(np.empty(max(length, 1) * ctypes.sizeof(kind), np.uint8))

    def address(self, array: np.ndarray) -> int:
        """The address of an array, which is kept."""
        self.arrays.append(array)
        return array.__array_interface__["data"][0]


def hull_loops(
    points: NDArray[np.float64],
    corners: Sequence[int],
    size: float,
    *,
    rounding: float,
    tolerance: float,
    most_vertices: int | None,
    coplanar: float,
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """The faces of the hull of (n, 3) points, grown from a tetrahedron.

    The point farthest from the present faces is added again and again. Triangles in one plane are joined.

    Args:
        points: Contiguous.
        corners: Indices of four points that span a volume, the fourth below the plane of the others.
        size: Size of the hull [m].
        rounding: Points that are as near to a face count as on it [m].
        tolerance: Points outside by no more are left out [m].
        most_vertices: Number of points of the hull at most, at least 4; None for no limit.
        coplanar: Triangles count as in one plane up to so far from it [m].

    Returns:
        The corners of all faces, one after the other, each counter-clockwise from outside, as indices into
        `points`; and how many each has.
    """
    memory = _Memory()
    vertices = len(points) if most_vertices is None else min(len(points), most_vertices)
    most_faces = max(_FEWEST_FACES, _FACES_PER_VERTEX * vertices)
    work = HullWork(memory.address(points), len(points), -1 if most_vertices is None else most_vertices)
    work.rounding, work.tolerance = rounding, tolerance
    work.first_corners[:] = corners
    work.next, work.rim_at, work.rim_of = (memory.new(len(points)) for _ in range(3))
    alive = -1
    while alive < 0:
        # Faces that vanish on the way need room as well.
        most_faces *= 2
        work.most_faces = most_faces
        work.faces, work.queue = memory.new(most_faces, HullFace), memory.new(most_faces, HullEntry)
        work.rim, work.loop = memory.new(most_faces, HullEdge), memory.new(most_faces, HullEdge)
        work.seen = memory.new(most_faces)
        function = library().symbols["carom_hull"]
        function.restype = ctypes.c_int64
        alive = function(ctypes.byref(work))
    return _merged(memory, work, alive, coplanar)


def _merged(
    memory: _Memory, hull: HullWork, triangles: int, thin: float
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """The faces of a hull, those in one plane joined, without corners in the middle of an edge."""
    work = MergeWork(hull.points, hull.faces, hull.face_count, triangles, hull.count)
    work.thin, work.parallel, work.tiny = thin, PARALLEL, sys.float_info.min
    work.normals, work.areas = (memory.new(count, ctypes.c_double) for count in (3 * triangles, triangles))
    work.number = memory.new(hull.face_count)
    for name in ("face", "order", "spare", "group_of", "group"):
        setattr(work, name, memory.new(triangles))
    for name in ("following", "following_of", "uses"):
        setattr(work, name, memory.new(hull.count))
    corners, counts = np.empty(3 * triangles, np.int32), np.empty(triangles, np.int32)
    work.corners, work.counts = memory.address(corners), memory.address(counts)
    library().symbols["carom_merge_faces"](ctypes.byref(work), ctypes.c_int64(MIN_FACES))
    counts = counts[: work.loop_count]
    return corners[: counts.sum()], counts
