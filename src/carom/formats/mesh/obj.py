"""Wavefront OBJ: vertices and faces, one part per object or group."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.formats.mesh.part import MeshPart, cut_into_fans, make_part

_AFTER_SLASH = re.compile(rb"/\S*")


@dataclass(slots=True)
class _Group:
    """Face lines between two `o` or `g` lines.

    Attributes:
        faces: Text after the `f` of each line.
        lines: Line number of each face.
        vertex_counts: Number of vertices known at each face: negative indices count back from there.
    """

    name: str = ""
    faces: list[bytes] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)
    vertex_counts: list[int] = field(default_factory=list)


def read_obj(data: bytes, file: Path) -> list[MeshPart]:
    """Reads an OBJ file.

    Polygons become fans of triangles. Normals, texture coordinates, lines and materials are left out here.

    Returns:
        A part for each `o` or `g` that has faces, in file order.

    Raises:
        DescriptionError: A number is missing or broken, or a face names a vertex that does not exist.
    """
    vertex_lines: list[tuple[int, bytes]] = []
    groups = [_Group()]
    for number, line in enumerate(data.removeprefix(b"\xef\xbb\xbf").splitlines(), start=1):
        line = line.lstrip()
        head = line[:2]
        if head in (b"v ", b"v\t"):
            vertex_lines.append((number, line[2:]))
        elif head in (b"f ", b"f\t"):
            group = groups[-1]
            group.faces.append(line[2:])
            group.lines.append(number)
            group.vertex_counts.append(len(vertex_lines))
        elif head in (b"o ", b"o\t", b"g ", b"g\t") or line in (b"o", b"g"):
            words = line.split()
            name = words[1].decode("utf-8", errors="backslashreplace") if len(words) > 1 else ""
            groups.append(_Group(name))
    positions = _read_positions(vertex_lines, file)
    parts = []
    for group in groups:
        corners = _read_corners(group, len(positions), file)
        if len(corners):
            parts.append(make_part(file, positions, corners, group.name))
    return parts


def _read_positions(lines: list[tuple[int, bytes]], file: Path) -> NDArray[np.float64]:
    words = [line.split() for _, line in lines]
    if all(len(line) == 3 for line in words):
        try:
            return np.array([*map(float, chain.from_iterable(words))], dtype=np.float64).reshape(-1, 3)
        except ValueError:
            pass  # the loop below finds the line
    positions = np.empty((len(lines), 3))
    for index, (number, _) in enumerate(lines):
        try:
            # Colours or a weight may follow.
            x, y, z = words[index][:3]
            positions[index] = float(x), float(y), float(z)
        except ValueError:
            raise DescriptionError("a vertex needs three numbers", file=file, line=number) from None
    return positions


def _read_corners(group: _Group, vertex_count: int, file: Path) -> NDArray[np.int64]:
    """Triangles as (m, 3) vertex indices from 0."""
    if not group.faces:
        return np.empty((0, 3), dtype=np.int64)
    faces = _AFTER_SLASH.sub(b"", b"\n".join(group.faces)).split(b"\n")
    sizes = np.array([len(face.split()) for face in faces])
    try:
        indices = np.array(list(map(int, b" ".join(faces).split())), dtype=np.int64)
    except (ValueError, OverflowError):
        line = next(line for face, line in zip(faces, group.lines, strict=True) if not _is_integers(face))
        raise DescriptionError("a face needs whole numbers", file=file, line=line) from None
    # Negative indices count back from the vertices known at the face.
    indices = np.where(indices < 0, indices + np.repeat(group.vertex_counts, sizes), indices - 1)
    outside = (indices < 0) | (indices >= vertex_count)
    if outside.any():
        line = int(np.repeat(group.lines, sizes)[outside.argmax()])
        raise DescriptionError(f"a face names a vertex outside 1..{vertex_count}", file=file, line=line)
    return cut_into_fans(indices, sizes)


def _is_integers(face: bytes) -> bool:
    try:
        np.array(list(map(int, face.split())), dtype=np.int64)
    except (ValueError, OverflowError):
        return False
    return True
