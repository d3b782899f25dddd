"""OBJ files of any form, line by line, for drawing; says where a file is broken."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass, field
from io import BytesIO
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.formats.visuals.mtl import ObjGroups
from carom.formats.visuals.plain_obj import ObjContents
from carom.meshes.part import cut_into_fans
from carom.meshes.plain_obj import parted

_VERTEX, _UV, _NORMAL = 0, 1, 2
# Images are rendered in single precision.
_GREATEST = float(np.finfo(np.float32).max)
_GREATEST_INDEX = np.iinfo(np.int64).max
# Keyword: kind of value, and how many numbers are used and required; colours or weights may follow.
_KINDS = {b"v": (_VERTEX, 3, 3), b"vt": (_UV, 2, 1), b"vn": (_NORMAL, 3, 3)}
# Lines with the same keyword, or another line. Runs are bounded, because the matcher remembers each line.
_RUNS = re.compile(rb"(?:[ \t]*(?P<keyword>v[tn]?|f)[ \t].*\n)(?:[ \t]*(?P=keyword)[ \t].*\n){0,20000}|.*\n")


@dataclass(repr=False, eq=False, slots=True)
class _Lines:
    """The lines of an OBJ file, by keyword.

    Attributes:
        values: Positions, texture coordinates and normals: runs of lines, each after the number of its first.
        faces: Words after the `f` of each face.
        face_lines: Line number of each face.
        known: How many positions, texture coordinates and normals were known at each face.
        groups: The groups and their materials.
    """

    values: tuple[list[tuple[int, bytes]], ...] = field(default_factory=lambda: ([], [], []))
    faces: list[list[bytes]] = field(default_factory=list)
    face_lines: list[int] = field(default_factory=list)
    known: list[tuple[int, int, int]] = field(default_factory=list)
    groups: ObjGroups = field(default_factory=ObjGroups)


def read_obj_lines(data: bytes, file: Path) -> ObjContents:
    """Reads an OBJ file whose lines all end with a line feed.

    Raises:
        DescriptionError: A number is missing or broken, or a face names something that does not exist.
    """
    lines = _take_apart(data)
    positions, uvs, normals = (
        _numbers(lines.values[kind], width, least, file) for kind, width, least in _KINDS.values()
    )
    corners = _corners(lines, (len(positions), len(uvs), len(normals)), file)
    return ObjContents(positions, uvs, normals, corners, lines.groups)


def _take_apart(data: bytes) -> _Lines:
    lines = _Lines()
    known = [0, 0, 0]
    number = 1
    for run in _RUNS.finditer(data):
        text, keyword, rest = run.group(), run["keyword"], b""
        if keyword is None:
            keyword, rest = parted(text)
        count = text.count(b"\n")
        if keyword in _KINDS:
            kind = _KINDS[keyword][0]
            lines.values[kind].append((number, text))
            known[kind] += count
        elif keyword == b"f":
            lines.faces += [line.split()[1:] for line in text.splitlines()]
            lines.face_lines += range(number, number + count)
            lines.known += [(known[_VERTEX], known[_UV], known[_NORMAL])] * count
        else:
            lines.groups.note(keyword, rest, len(lines.faces))
        number += count
    lines.groups.end(len(lines.faces))
    return lines


def _numbers(runs: list[tuple[int, bytes]], width: int, least: int, file: Path) -> NDArray[np.float64]:
    """The first `width` numbers of each line, 0 for those left out after `least`."""
    text = b"".join(run for _, run in runs)
    count = text.count(b"\n")
    # Lines of a file usually have the same form and are correct: then NumPy parses them.
    if count and text.isascii():
        with suppress(ValueError):
            rows = np.loadtxt(BytesIO(text), usecols=range(1, width + 1), comments=None, ndmin=2)
            if len(rows) == count and (np.abs(rows) <= _GREATEST).all():
                return rows
    rows = np.zeros((count, width))
    lines = [it for number, run in runs for it in enumerate(run.splitlines(), start=number)]
    for index, (number, line) in enumerate(lines):
        try:
            values = [float(word) for word in line.split()[1 : width + 1]]
        except ValueError:
            values = []
        if len(values) < least:
            raise DescriptionError(f"at least {least} numbers are needed", file=file, line=number)
        rows[index, : len(values)] = values
        if not all(abs(value) <= _GREATEST for value in values):
            raise DescriptionError("a number is too large, or not finite", file=file, line=number)
    return rows


def _corners(lines: _Lines, counts: tuple[int, int, int], file: Path) -> NDArray[np.int64]:
    """Triangles (m, 3 corners, 3): position, texture coordinate and normal of each corner; -1 for none."""
    sizes = np.array([len(face) for face in lines.faces], dtype=np.int64)
    words = list(chain.from_iterable(lines.faces))
    try:
        indices = _indices(words)
    except (ValueError, OverflowError):
        raise DescriptionError("a face needs whole numbers", file=file, line=_bad_face(lines)) from None
    known = np.repeat(np.array(lines.known, dtype=np.int64).reshape(-1, 3), sizes, axis=0)
    # Indices start at 1; negative ones count back from the values known at the face; 0 means none.
    indices = np.where(indices < 0, indices + known, indices - 1)
    for kind, (count, name) in enumerate(
        zip(counts, ("vertex", "texture coordinate", "normal"), strict=True)
    ):
        least = 0 if kind == _VERTEX else -1
        outside = (indices[:, kind] < least) | (indices[:, kind] >= count)
        if outside.any():
            line = int(np.repeat(lines.face_lines, sizes)[outside.argmax()])
            raise DescriptionError(f"a face names a {name} outside 1..{count}", file=file, line=line)
    order = cut_into_fans(np.arange(len(indices)), sizes)
    return indices[order]


def _indices(words: list[bytes]) -> NDArray[np.int64]:
    """(k, 3) indices as in the file: position, texture coordinate, normal; 0 where there is none."""
    result = np.zeros((len(words), 3), dtype=np.int64)
    text = b" ".join(words)
    slashes, double = text.count(b"/"), text.count(b"//")
    # All words of a file usually have the same form: then NumPy parses them.
    if slashes == 0:
        result[:, _VERTEX] = _integers(text, len(words))
    elif slashes == 2 * len(words) and double == 0 and all(word.count(b"/") == 2 for word in words):
        result[:] = _integers(text.replace(b"/", b" "), 3 * len(words)).reshape(-1, 3)
    elif slashes == 2 * len(words) and double == len(words):
        result[:, [_VERTEX, _NORMAL]] = _integers(text.replace(b"//", b" "), 2 * len(words)).reshape(-1, 2)
    else:
        for row, word in zip(result, words, strict=True):
            entries = word.split(b"/")
            row[: len(entries)] = [int(entry) if entry else 0 for entry in entries[:3]]
    return result


def _integers(text: bytes, count: int) -> NDArray[np.int64]:
    """The whole numbers, so many, that spaces part."""
    # NumPy takes the nearest number that it has for one that is too large.
    if not text.translate(None, b"0123456789 "):
        numbers = np.fromstring(text, dtype=np.int64, sep=" ")
        if len(numbers) == count and (numbers < _GREATEST_INDEX).all():
            return numbers
    return np.array(list(map(int, text.split())), dtype=np.int64)


def _bad_face(lines: _Lines) -> int | None:
    for face, line in zip(lines.faces, lines.face_lines, strict=True):
        try:
            _indices(face)
        except (ValueError, OverflowError):
            return line
    return None
