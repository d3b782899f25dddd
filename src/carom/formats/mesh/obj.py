"""Wavefront OBJ: vertices and faces, one part per object or group."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.formats.mesh.part import MeshPart, make_part

_AFTER_SLASH = re.compile(rb"/\S*")


@dataclass(slots=True)
class _Group:
    """Face lines between two `o` or `g` lines.

    Attributes:
        faces: What follows the `f` of each line.
        lines: Line number of each face.
        vertex_counts: How many vertices were known at each face: negative indices count back from there.
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
    for number, line in enumerate(data.splitlines(), start=1):
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
    words = b"\n".join(line for _, line in lines).split()
    if len(words) == 3 * len(lines):
        try:
            return np.array(list(map(float, words)), dtype=np.float64).reshape(-1, 3)
        except ValueError:
            pass  # the loop below finds the line
    positions = np.empty((len(lines), 3))
    for index, (number, line) in enumerate(lines):
        try:
            # Colours or a weight may follow.
            x, y, z = line.split()[:3]
            positions[index] = float(x), float(y), float(z)
        except ValueError:
            raise DescriptionError("a vertex needs three numbers", file=file, line=number) from None
    return positions


def _read_corners(group: _Group, vertex_count: int, file: Path) -> NDArray[np.int64]:
    """Triangles as (m, 3) vertex indices from 0."""
    faces = [face.split() for face in _AFTER_SLASH.sub(b"", b"\n".join(group.faces)).split(b"\n")]
    try:
        polygons = [list(map(int, face)) for face in faces]
    except ValueError:
        line = next(line for face, line in zip(faces, group.lines, strict=True) if not _all_integers(face))
        raise DescriptionError("a face needs whole numbers", file=file, line=line) from None
    triangles: list[tuple[int, int, int]] = []
    for polygon, known, line in zip(polygons, group.vertex_counts, group.lines, strict=False):
        if min(polygon, default=1) < 0:
            polygon = [known + index + 1 if index < 0 else index for index in polygon]
        if polygon and not 1 <= min(polygon) <= max(polygon) <= vertex_count:
            raise DescriptionError(
                f"a face names a vertex outside 1..{vertex_count}", file=file, line=line
            )
        first, *rest = polygon or [0]
        triangles.extend((first, rest[i], rest[i + 1]) for i in range(len(rest) - 1))
    return np.array(triangles, dtype=np.int64).reshape(-1, 3) - 1


def _all_integers(words: list[bytes]) -> bool:
    try:
        list(map(int, words))
    except ValueError:
        return False
    return True
