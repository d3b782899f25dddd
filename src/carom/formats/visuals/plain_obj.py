"""Plain OBJ files for drawing, and distinct corners, which the native library finds."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.formats.visuals.mtl import ObjGroups
from carom.meshes.plain_obj import parted, take_apart
from carom.native.arrays import c_array
from carom.native.library import library


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
    """Reads an OBJ file whose lines all end with a line feed; None if it is not plain, see `take_apart`."""
    plain = take_apart(data)
    if plain is None:
        return None
    groups = ObjGroups()
    for line, faces, _ in plain.others:
        groups.note(*parted(line), faces)
    groups.end(plain.faces)
    return ObjContents(plain.positions, plain.uvs, plain.normals, plain.corners, groups)


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
