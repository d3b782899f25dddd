"""What the native library does for OBJ files: reading plain ones, and finding distinct corners."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.formats.visuals.mtl import ObjGroups
from carom.native.arrays import c_array
from carom.native.library import library

_POSITION, _UV, _NORMAL, _TRIANGLE, _OTHER = range(5)
# Lines that the library reads, unless they begin in an unusual way.
_READ = (b"v", b"vt", b"vn", b"f")


@dataclass(repr=False, eq=False, slots=True)
class ObjContents:
    """What an OBJ file says.

    Attributes:
        positions: (n, 3).
        uvs: (n, 2) texture coordinates.
        normals: (n, 3).
        corners: (m, 3, 3) position, texture coordinate and normal of each corner of triangles; -1 for none.
        groups: Its groups and their materials.
    """

    positions: NDArray[np.float64]
    uvs: NDArray[np.float64]
    normals: NDArray[np.float64]
    corners: NDArray[np.int64]
    groups: ObjGroups


def read_plain_obj(data: bytes) -> ObjContents | None:
    """Reads an OBJ file whose lines all end with a line feed.

    None if it is not so plain: broken, with fewer numbers than usual, or with more digits than are exact in
    a single step.
    """
    counts = np.zeros(5, np.int64)
    symbols, length = library().symbols, ctypes.c_int64(len(data))
    symbols["carom_count_obj"](data, length, ctypes.c_void_p(counts.ctypes.data))
    sizes = counts.tolist()
    contents = ObjContents(
        np.empty((sizes[_POSITION], 3)),
        np.empty((sizes[_UV], 2)),
        np.empty((sizes[_NORMAL], 3)),
        np.empty((sizes[_TRIANGLE], 3, 3), np.int64),
        ObjGroups(),
    )
    others = np.empty((sizes[_OTHER], 2), np.int64)
    numbers = [array.ctypes.data for array in (contents.positions, contents.uvs, contents.normals)]
    function = symbols["carom_read_obj"]
    function.restype = ctypes.c_int64
    face_count = function(
        data,
        length,
        ctypes.c_void_p(counts.ctypes.data),
        c_array(ctypes.c_void_p, 3, numbers),
        *(ctypes.c_void_p(array.ctypes.data) for array in (contents.corners, others)),
    )
    if face_count < 0:
        return None
    for at, faces in others.tolist():
        keyword, rest = parted(data[at : data.index(b"\n", at)])
        if keyword in _READ:
            return None
        contents.groups.note(keyword, rest, faces)
    contents.groups.end(face_count)
    return contents


def parted(line: bytes) -> tuple[bytes, bytes]:
    """The keyword of a line, and what follows it."""
    keyword, _, rest = line.strip().replace(b"\t", b" ").partition(b" ")
    return keyword, rest


def distinct_corners(
    corners: NDArray[np.int64], sizes: tuple[int, int, int]
) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """The distinct ones of (n, 3) corners, sorted.

    Args:
        corners: Position, texture coordinate and normal of each; -1 for none.
        sizes: How many of these there are.

    Returns:
        The index of the first one of each, and the number that each corner has among them.
    """
    corners = np.ascontiguousarray(corners)
    count = len(corners)
    first, numbers = np.empty(count, np.int64), np.empty(count, np.int32)
    work = np.empty(2 * count + max(sizes) + 2, np.int64)
    function = library().symbols["carom_distinct_corners"]
    function.restype = ctypes.c_int64
    found = function(
        ctypes.c_void_p(corners.ctypes.data),
        ctypes.c_int64(count),
        c_array(ctypes.c_int64, 3, sizes),
        *(ctypes.c_void_p(array.ctypes.data) for array in (first, numbers, work)),
    )
    return first[:found], numbers
