"""Gmsh's files, in formats 2.2 and 4.1: nodes, and edges, triangles or tetrahedra.

The formats are those of "MSH file format" in Gmsh's reference manual. As in MuJoCo, the elements of the
highest dimension count, and all others are left out.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.formats.boundary import reading
from carom.formats.budget import charge
from carom.formats.files import read_bounded

# Gmsh's types of elements by the number of their corners.
_KINDS = {1: 2, 2: 3, 4: 4}
_POINT = 15
_OLD, _NEW = "2.2", "4.1"


def read_gmsh(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Points (n, 3), and edges (m, 2), triangles (m, 3) or tetrahedra (m, 4) of a text file.

    Raises:
        DescriptionError: The file is missing, binary, of another format, or broken.
    """
    with reading(path):
        data, _ = read_bounded(path.absolute())
        try:
            return _read(data, path)
        except (ValueError, IndexError, OverflowError) as problem:
            raise DescriptionError(
                "it is cut off, or has a word where a number is needed", file=path
            ) from problem


def _read(data: bytes, path: Path) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    words = data.split()
    if words[:1] != [b"$MeshFormat"]:
        raise DescriptionError("it does not begin with $MeshFormat, as Gmsh's files do", file=path)
    version, binary = words[1].decode("ascii", "replace"), words[2]
    if binary != b"0":
        raise DescriptionError("it is binary; write it as text (Mesh.Binary = 0 in Gmsh)", file=path)
    if version not in (_OLD, _NEW):
        raise DescriptionError(f"its format is {version}; {_OLD} and {_NEW} are read", file=path)
    nodes, elements = _section(words, b"Nodes", path), _section(words, b"Elements", path)
    numbers, points = (_old_nodes if version == _OLD else _new_nodes)(nodes)
    cells = (_old_cells if version == _OLD else _new_cells)(elements)
    charge("vertices", len(points) + len(cells))
    if not cells:
        raise DescriptionError("it has no edges, triangles or tetrahedra", file=path)
    corners = max(map(len, cells))
    place = {number: row for row, number in enumerate(numbers)}
    chosen = [cell for cell in cells if len(cell) == corners]
    unknown = next((number for cell in chosen for number in cell if number not in place), None)
    if unknown is not None:
        raise DescriptionError(f"an element names node {unknown}, which is not there", file=path)
    rows = np.array([[place[number] for number in cell] for cell in chosen], np.int32)
    found = np.array(points)
    if not np.isfinite(found).all():
        raise DescriptionError("a coordinate is not finite", file=path)
    return found, rows


def _section(words: list[bytes], name: bytes, path: Path) -> list[bytes]:
    try:
        begin = words.index(b"$" + name)
        return words[begin + 1 : words.index(b"$End" + name, begin)]
    except ValueError:
        raise DescriptionError(f"it has no section ${name.decode()}", file=path) from None


def _old_nodes(words: list[bytes]) -> tuple[list[int], list[list[float]]]:
    count = int(words[0])
    rows = [words[1 + 4 * row : 5 + 4 * row] for row in range(count)]
    return [int(row[0]) for row in rows], [[float(word) for word in row[1:4]] for row in _full(rows, 4)]


def _old_cells(words: list[bytes]) -> list[list[int]]:
    cells, at = [], 1
    for _ in range(int(words[0])):
        kind, tags = int(words[at + 1]), int(words[at + 2])
        # Other types are not read: how long they are is not known.
        corners = _KINDS.get(kind, 1)
        first = at + 3 + tags
        if kind in _KINDS:
            cells.append([int(word) for word in _full([words[first : first + corners]], corners)[0]])
        elif kind != _POINT:
            raise ValueError(kind)
        at = first + corners
    return cells


def _new_nodes(words: list[bytes]) -> tuple[list[int], list[list[float]]]:
    numbers: list[int] = []
    points: list[list[float]] = []
    at = 4
    for _ in range(int(words[0])):
        parameters, count = int(words[at + 2]), int(words[at + 3])
        at += 4
        if parameters:
            raise ValueError(parameters)
        numbers += [int(word) for word in _full([words[at : at + count]], count)[0]]
        at += count
        rows = [words[at + 3 * row : at + 3 * row + 3] for row in range(count)]
        points += [[float(word) for word in row] for row in _full(rows, 3)]
        at += 3 * count
    return numbers, points


def _new_cells(words: list[bytes]) -> list[list[int]]:
    cells: list[list[int]] = []
    at = 4
    for _ in range(int(words[0])):
        kind, count = int(words[at + 2]), int(words[at + 3])
        at += 4
        corners = _KINDS.get(kind, 1)
        if kind not in _KINDS and kind != _POINT:
            raise ValueError(kind)
        rows = [words[at + (corners + 1) * row : at + (corners + 1) * (row + 1)] for row in range(count)]
        if kind in _KINDS:
            cells += [[int(word) for word in row[1:]] for row in _full(rows, corners + 1)]
        at += (corners + 1) * count
    return cells


def _full(rows: list[list[bytes]], count: int) -> list[list[bytes]]:
    """The rows; raises `ValueError` if one is cut off."""
    if any(len(row) != count for row in rows):
        raise ValueError(count)
    return rows
