"""OBJ files as programs write them, taken apart by the native library: `native/source/obj.cpp`."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom.native.arrays import c_array
from carom.native.library import library

if TYPE_CHECKING:
    from numpy.typing import NDArray

_POSITION, _UV, _NORMAL, _TRIANGLE, _OTHER = range(5)
# Lines that the library reads, unless they begin in an unusual way.
_READ = (b"v", b"vt", b"vn", b"f")


@dataclass(repr=False, eq=False, slots=True)
class PlainObj:
    """What an OBJ file says.

    Attributes:
        positions: (n, 3).
        uvs: (n, 2) texture coordinates.
        normals: (n, 3).
        corners: (m, 3, 3) position, texture coordinate and normal of each corner of triangles; -1 for none.
        faces: How many faces it has.
        others: Lines of other kinds but comments, each with the faces and the triangles before it.
    """

    positions: NDArray[np.float64]
    uvs: NDArray[np.float64]
    normals: NDArray[np.float64]
    corners: NDArray[np.int64]
    faces: int
    others: list[tuple[bytes, int, int]]


def take_apart(data: bytes) -> PlainObj | None:
    """Takes an OBJ file apart whose lines all end with a line feed; polygons become fans of triangles.

    None if it is not so plain: broken, with fewer numbers than usual, or with more digits than are exact in
    a single step.
    """
    counts = np.zeros(5, np.int64)
    symbols, length = library().symbols, ctypes.c_int64(len(data))
    symbols["carom_count_obj"](data, length, ctypes.c_void_p(counts.ctypes.data))
    sizes = counts.tolist()
    positions, uvs = np.empty((sizes[_POSITION], 3)), np.empty((sizes[_UV], 2))
    normals, corners = np.empty((sizes[_NORMAL], 3)), np.empty((sizes[_TRIANGLE], 3, 3), np.int64)
    others = np.empty((sizes[_OTHER], 3), np.int64)
    numbers = [array.ctypes.data for array in (positions, uvs, normals)]
    function = symbols["carom_read_obj"]
    function.restype = ctypes.c_int64
    faces = function(
        data,
        length,
        ctypes.c_void_p(counts.ctypes.data),
        c_array(ctypes.c_void_p, 3, numbers),
        *(ctypes.c_void_p(array.ctypes.data) for array in (corners, others)),
    )
    if faces < 0:
        return None
    lines = []
    for at, faces_before, triangles_before in others.tolist():
        line = data[at : data.index(b"\n", at)]
        if parted(line)[0] in _READ:
            return None
        lines.append((line, faces_before, triangles_before))
    return PlainObj(positions, uvs, normals, corners, faces, lines)


def parted(line: bytes) -> tuple[bytes, bytes]:
    """The keyword of a line, and what follows it."""
    keyword, _, rest = line.strip().replace(b"\t", b" ").partition(b" ")
    return keyword, rest
