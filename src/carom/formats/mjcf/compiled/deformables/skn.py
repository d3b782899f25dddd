"""MuJoCo's binary skin files: counts, vertices, texture coordinates, triangles, bones with their vertices."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from struct import Struct, error

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.files.bounded import read_bounded
from carom.files.budget import charge

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
_HEADER, _BONE = Struct("<4i"), Struct("<40s7fi")


@dataclass(frozen=True, eq=False, slots=True)
class RawBone:
    """A bone as a file states it.

    Attributes:
        body: Name of its body.
        bind: (7,) position and quaternion, w first, where the skin is at rest.
        vertices: (k,) numbers of its vertices.
        weights: (k,) its share of each, before those of a vertex are made to add up to 1.
    """

    body: str
    bind: Floats
    vertices: Ints
    weights: Floats


@dataclass(frozen=True, eq=False, slots=True)
class RawSkin:
    """A skin as a file states it.

    Attributes:
        vertices: (n, 3).
        coordinates: (n, 2) of textures, v downwards, or (0, 2).
        faces: (m, 3).
        bones: Its bones.
    """

    vertices: Floats
    coordinates: Floats
    faces: Ints
    bones: list[RawBone]


def read_skn(path: Path) -> RawSkin:
    """What a `.skn` file says; raises `DescriptionError` if it is missing, cut off or has too much."""
    with reading(path):
        data = read_bounded(path)[0]
        try:
            return _read(data, path)
        except (error, ValueError) as problem:
            raise DescriptionError("it is cut off, or no skin file of MuJoCo", file=path) from problem


def _read(data: bytes, path: Path) -> RawSkin:
    counts = _HEADER.unpack_from(data)
    if min(counts) < 0 or 4 * max(counts) > len(data):
        raise DescriptionError(
            f"its counts {counts} of vertices, texture coordinates, triangles and bones are more than it has",
            file=path,
        )
    vertices, coordinates, faces, bones = counts
    charge("vertices", vertices + faces)
    at = _HEADER.size

    def taken(kind: str, count: int) -> NDArray[np.generic]:
        nonlocal at
        found = np.frombuffer(data, kind, count, at)
        at += 4 * count
        return found

    points = taken("<f4", 3 * vertices).reshape(-1, 3).astype(np.float64)
    uvs = taken("<f4", 2 * coordinates).reshape(-1, 2).astype(np.float64)
    triangles = taken("<i4", 3 * faces).reshape(-1, 3).astype(np.int32)
    made: list[RawBone] = []
    for _ in range(bones):
        name, *bind, count = _BONE.unpack_from(data, at)
        at += _BONE.size
        if count < 0:
            raise ValueError(count)
        body = name.split(b"\0")[0].decode("utf-8", "replace")
        numbers = taken("<i4", count).astype(np.int32)
        made.append(RawBone(body, np.array(bind), numbers, taken("<f4", count).astype(np.float64)))
    if at != len(data):
        raise DescriptionError(f"its counts need {at} bytes; it has {len(data)}", file=path)
    return RawSkin(points, uvs, triangles, made)
