"""OBJ files as programs write them, read by the native library: `native/source/obj.cpp`."""

from __future__ import annotations

import ctypes
from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from carom.lazy_dataclasses import dataclass
from carom.native.library import library

_POSITION, _UV, _NORMAL, _TRIANGLE, _OTHER = range(5)


@dataclass(repr=False, eq=False, slots=True)
class PlainObj:
    """What an OBJ file says.

    Attributes:
        positions: (n, 3).
        uvs: (n, 2) texture coordinates.
        normals: (n, 3).
        triangles: (m, 3, 3) position, texture coordinate and normal of each corner; -1 for none.
        face_count: How many polygons there are.
        others: Lines that are neither numbers nor faces, and how many faces are before each.
    """

    positions: NDArray[np.float64]
    uvs: NDArray[np.float64]
    normals: NDArray[np.float64]
    triangles: NDArray[np.int64]
    face_count: int = 0
    others: list[tuple[bytes, int]] = field(default_factory=list)


def read_plain_obj(data: bytes) -> PlainObj | None:
    """Reads an OBJ file whose lines all end with a line feed.

    None if it is not so plain: broken, with fewer numbers than usual, or with more digits than are exact in
    a single step.
    """
    counts = np.zeros(5, np.int64)
    symbols, length = library().symbols, ctypes.c_int64(len(data))
    symbols["carom_count_obj"](data, length, ctypes.c_void_p(counts.ctypes.data))
    sizes = counts.tolist()
    plain = PlainObj(
        np.empty((sizes[_POSITION], 3)),
        np.empty((sizes[_UV], 2)),
        np.empty((sizes[_NORMAL], 3)),
        np.empty((sizes[_TRIANGLE], 3, 3), np.int64),
    )
    others = np.empty((sizes[_OTHER], 2), np.int64)
    numbers = [array.ctypes.data for array in (plain.positions, plain.uvs, plain.normals)]
    function = symbols["carom_read_obj"]
    function.restype = ctypes.c_int64
    plain.face_count = function(
        data,
        length,
        ctypes.c_void_p(counts.ctypes.data),
        (ctypes.c_void_p * 3)(*numbers),
        *(ctypes.c_void_p(array.ctypes.data) for array in (plain.triangles, others)),
    )
    if plain.face_count < 0:
        return None
    plain.others = [(data[at : data.index(b"\n", at)], faces) for at, faces in others.tolist()]
    return plain
