"""Wavefront OBJ: vertices and faces, one part per object or group."""

from __future__ import annotations

import re
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from carom.errors import DescriptionError
from carom.files.budget import charge
from carom.meshes.ears import cut_by_ears
from carom.meshes.part import MeshPart, cut_into_fans, make_part
from carom.meshes.plain_obj import PlainObj, take_apart

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Lines that belong together: vertices, faces, others, or the one that begins an object or group. Blocks are
# bounded, because the matcher remembers each line.
_GROUP = rb"[ \t\v\f]*(?P<group>[og](?:[ \t].*)?)"
_BLOCKS = (
    rb"(?P<vertices>(?:[ \t\v\f]*v[ \t].*\n){1,20000})"
    rb"|(?P<faces>(?:[ \t\v\f]*f[ \t].*\n){1,20000})"
    rb"|" + _GROUP + rb"\n"
    rb"|(?:(?![ \t\v\f]*(?:[vfog][ \t]|[og]\n)).*\n){1,20000}"
)
_BEGINS_GROUP = re.compile(_GROUP)
_AFTER_SLASH = rb"/\S*"
# What a number has that is not whole.
_BROKEN = (b".", b"e", b"E")


class _Group:
    """What stands between two `o` or `g` lines.

    Attributes:
        corners: Indices of vertices from 0, of all polygons of each block of faces.
        sizes: Number of corners of each polygon, for each block.
        lines: Line number of the first polygon of each block.
    """

    def __init__(self, name: str = "") -> None:
        self.name = name
        self.corners: list[NDArray[np.int64]] = []
        self.sizes: list[NDArray[np.int64]] = []
        self.lines: list[int] = []


def read_obj(data: bytes, file: Path, *, by_ears: bool = False) -> list[MeshPart]:
    """Reads an OBJ file.

    Polygons become fans of triangles, as in PyBullet, or are cut `by_ears`, as in MuJoCo. Normals, texture
    coordinates, lines and materials are left out here.

    Returns:
        A part for each `o` or `g` that has faces, in file order. If there are none, one of all vertices
        without triangles for `by_ears`: MuJoCo knows such files.

    Raises:
        DescriptionError: A number is missing or broken, or a face names a vertex that does not exist.
    """
    data = data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n") + b"\n"
    if not by_ears and (plain := take_apart(data)) is not None:
        return _plain_parts(plain, file)
    blocks: list[NDArray[np.float64]] = [np.empty((0, 3))]
    known = line = at = 0
    groups = [_Group()]
    for block in re.finditer(_BLOCKS, data):
        line += data.count(b"\n", at, block.start())
        at = block.start()
        text = block.group()
        if block.lastgroup == "vertices":
            blocks.append(_read_positions(text, line + 1, file))
            known += len(blocks[-1])
        elif block.lastgroup == "faces":
            corners, sizes = _read_corners(text, line + 1, file)
            # Negative indices count back from the vertices known at the face.
            groups[-1].corners.append(np.where(corners < 0, corners + known, corners - 1))
            groups[-1].sizes.append(sizes)
            groups[-1].lines.append(line + 1)
        elif block.lastgroup == "group":
            groups.append(_Group(_name(text)))
    charge("vertices", known)
    positions = np.concatenate(blocks)
    parts = []
    for group in groups:
        triangles = _triangles(group, positions, file, by_ears=by_ears)
        if len(triangles):
            parts.append(make_part(file, positions, triangles, group.name))
    if not parts and by_ears and len(positions):
        every = np.arange(len(positions), dtype=np.int64)
        cloud = make_part(file, positions, np.repeat(every, 3))
        parts.append(MeshPart(cloud.vertices, np.empty((0, 3), np.int32)))
    return parts


def _plain_parts(plain: PlainObj, file: Path) -> list[MeshPart]:
    charge("vertices", len(plain.positions))
    charge("vertices", len(plain.corners) + 2 * plain.faces, file=file)
    triangles = plain.corners[:, :, 0]
    starts, names = [0], [""]
    for line, _, before in plain.others:
        if _BEGINS_GROUP.fullmatch(line):
            starts.append(before)
            names.append(_name(line))
    ends = [*starts[1:], len(triangles)]
    return [
        make_part(file, plain.positions, triangles[start:end], name)
        for start, end, name in zip(starts, ends, names, strict=True)
        if end > start
    ]


def _name(line: bytes) -> str:
    """The name of the object or group that a line begins."""
    words = line.split()
    return words[1].decode("utf-8", errors="backslashreplace") if len(words) > 1 else ""


def _read_positions(text: bytes, first_line: int, file: Path) -> NDArray[np.float64]:
    """Positions (n, 3) of a block of vertices; colours or a weight may follow each."""
    lines = text.splitlines()
    try:
        positions = np.loadtxt(BytesIO(text), usecols=(1, 2, 3), comments=None, ndmin=2)
    except ValueError:
        positions = np.empty((len(lines), 3))
        for index, line in enumerate(lines):
            try:
                x, y, z = line.split()[1:4]
                positions[index] = float(x), float(y), float(z)
            except ValueError:
                raise DescriptionError(
                    "a vertex needs three numbers", file=file, line=first_line + index
                ) from None
    return positions


def _read_corners(text: bytes, first_line: int, file: Path) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Corners of all polygons of a block of faces, as in the file, and how many each polygon has."""
    if b"/" in text:
        text = re.sub(_AFTER_SLASH, b"", text)
    text = text.replace(b"f", b" ")
    lines = text.splitlines()
    # NumPy warns of a text without numbers.
    if text.strip() and not any(sign in text for sign in _BROKEN):
        try:
            corners = np.loadtxt(BytesIO(text), dtype=np.int64, comments=None, ndmin=2)
        except (ValueError, OverflowError):
            pass  # a broken number, or polygons of different sizes
        else:
            # Lines without corners are skipped there.
            if len(corners) == len(lines):
                return corners.ravel(), np.full(len(lines), corners.shape[1], dtype=np.int64)
    words = [line.split() for line in lines]
    read: list[NDArray[np.int64]] = [np.empty(0, dtype=np.int64)]
    for index, face in enumerate(words):
        try:
            read.append(np.array(list(map(int, face)), dtype=np.int64))
        except (ValueError, OverflowError):
            raise DescriptionError("a face needs whole numbers", file=file, line=first_line + index) from None
    return np.concatenate(read), np.array(list(map(len, words)), dtype=np.int64)


def _triangles(
    group: _Group, positions: NDArray[np.float64], file: Path, *, by_ears: bool
) -> NDArray[np.int64]:
    """The triangles (m, 3) of a group, as indices of vertices from 0."""
    vertex_count = len(positions)
    if not group.corners:
        return np.empty((0, 3), dtype=np.int64)
    for corners, sizes, line in zip(group.corners, group.sizes, group.lines, strict=True):
        outside = (corners < 0) | (corners >= vertex_count)
        if outside.any():
            line += int(np.repeat(np.arange(len(sizes)), sizes)[outside.argmax()])
            raise DescriptionError(f"a face names a vertex outside 1..{vertex_count}", file=file, line=line)
    corners = np.concatenate(group.corners)
    charge("vertices", len(corners), file=file)
    sizes = np.concatenate(group.sizes)
    return cut_by_ears(positions, corners, sizes) if by_ears else cut_into_fans(corners, sizes)
