"""Gmsh's files, in formats 2.2 and 4.1: nodes, and edges, triangles or tetrahedra.

The formats are those of "MSH file format" in Gmsh's reference manual, as text or binary. As in MuJoCo, the
elements of the highest dimension count, and all others are left out.
"""

from __future__ import annotations

from itertools import count as numbers_from
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.files.bounded import read_bounded
from carom.files.budget import charge

_CORNERS = {1: 2, 2: 3, 4: 4, 15: 1}
"""Corners of Gmsh's types of elements that are read: edges, triangles, tetrahedra and points."""
_POINT = 15
_OLD, _NEW = "2.2", "4.1"
_INT, _LONG = 4, 8
_MOST = 1 << 31
Cells = list[list[int]]


def read_gmsh(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Points (n, 3), and edges (m, 2), triangles (m, 3) or tetrahedra (m, 4) of a file.

    Raises:
        DescriptionError: The file is missing, of another format, cut off or broken.
    """
    with reading(path):
        data, _ = read_bounded(path.absolute())
        try:
            return _read(data, path)
        except (ValueError, IndexError, OverflowError) as problem:
            message = "it is cut off, or has something else where a number is needed"
            raise DescriptionError(message, file=path) from problem


def _read(data: bytes, path: Path) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    if not data.startswith(b"$MeshFormat"):
        raise DescriptionError("it does not begin with $MeshFormat, as Gmsh's files do", file=path)
    version, kind = (word.decode("ascii", "replace") for word in data[:200].split()[1:3])
    if version not in (_OLD, _NEW):
        raise DescriptionError(f"its format is {version}; {_OLD} and {_NEW} are read", file=path)
    make = _Words if kind == "0" else _Bytes
    nodes, elements = (make(data, name, path) for name in (b"Nodes", b"Elements"))
    numbers, points = (_old_nodes if version == _OLD else _new_nodes)(nodes)
    if version == _NEW:
        cells = _new_cells(elements)
    else:
        cells = _old_cells(elements) if kind == "0" else _old_binary_cells(elements)
    charge("vertices", len(points) + len(cells))
    if not cells:
        raise DescriptionError("it has no edges, triangles or tetrahedra", file=path)
    place = {number: row for row, number in enumerate(numbers)}
    corners = max(map(len, cells))
    chosen = [cell for cell in cells if len(cell) == corners]
    unknown = next((number for cell in chosen for number in cell if number not in place), None)
    if unknown is not None:
        raise DescriptionError(f"an element names node {unknown}, which is not there", file=path)
    rows = np.array([[place[number] for number in cell] for cell in chosen], np.int32)
    found = np.array(points)
    if not np.isfinite(found).all():
        raise DescriptionError("a coordinate is not finite", file=path)
    return found, rows


def _section(data: bytes, name: bytes, path: Path) -> tuple[int, int]:
    """Where a section begins and ends, without the lines that say so."""
    begin = data.find(b"\n$" + name)
    end = data.rfind(b"$End" + name)
    if begin < 0 or end < begin:
        raise DescriptionError(f"it has no section ${name.decode()}", file=path)
    return data.index(b"\n", begin + 1) + 1, end


class _Words:
    """The numbers of a section of text."""

    def __init__(self, data: bytes, name: bytes, path: Path) -> None:
        begin, end = _section(data, name, path)
        self._words = data[begin:end].split()
        self._at = 0

    def total(self) -> int:
        """The first number of a section of the old format."""
        return self.integers(1)[0]

    def integers(self, count: int, size: int = _INT) -> list[int]:
        """The next whole numbers, which have this many bytes in binary files."""
        return [int(word) for word in self._next(count)]

    def reals(self, count: int) -> list[float]:
        """The next numbers."""
        return [float(word) for word in self._next(count)]

    def _next(self, count: int) -> list[bytes]:
        found = self._words[self._at : self._at + count]
        if not 0 <= count < _MOST or len(found) != count:
            raise ValueError(count)
        self._at += count
        return found


class _Bytes:
    """The numbers of a binary section, with the lowest byte first."""

    def __init__(self, data: bytes, name: bytes, path: Path) -> None:
        begin, end = _section(data, name, path)
        self._data, self._at = data[:end], begin

    def total(self) -> int:
        """The first number of a section of the old format, which is text."""
        end = self._data.index(b"\n", self._at)
        found = int(self._data[self._at : end])
        self._at = end + 1
        return found

    def integers(self, count: int, size: int = _INT) -> list[int]:
        """The next whole numbers of this many bytes."""
        return self._next(count, f"<i{size}").tolist()

    def reals(self, count: int) -> list[float]:
        """The next numbers."""
        return self._next(count, "<f8").tolist()

    def _next(self, count: int, kind: str) -> NDArray[np.generic]:
        size = np.dtype(kind).itemsize
        if not 0 <= count < _MOST or self._at + count * size > len(self._data):
            raise ValueError(count)
        found = np.frombuffer(self._data, kind, count, self._at)
        self._at += count * size
        return found


_Source = _Words | _Bytes


def _old_nodes(source: _Source) -> tuple[list[int], list[list[float]]]:
    numbers: list[int] = []
    points: list[list[float]] = []
    for _ in range(source.total()):
        numbers += source.integers(1)
        points.append(source.reals(3))
    return numbers, points


def _old_cells(source: _Source) -> Cells:
    cells: Cells = []
    for _ in range(source.total()):
        _, kind, tags = source.integers(3)
        source.integers(tags)
        _take(cells, kind, source.integers(_corners(kind)))
    return cells


def _old_binary_cells(source: _Source) -> Cells:
    cells: Cells = []
    total, done = source.total(), 0
    for _ in numbers_from():
        if done >= total:
            return cells
        kind, count, tags = source.integers(3)
        if count <= 0:
            raise ValueError(count)
        for _ in range(count):
            source.integers(1 + tags)
            _take(cells, kind, source.integers(_corners(kind)))
        done += count
    return cells


def _new_nodes(source: _Source) -> tuple[list[int], list[list[float]]]:
    numbers: list[int] = []
    points: list[list[float]] = []
    for _ in range(source.integers(4, _LONG)[0]):
        parameters, count = source.integers(3)[2], source.integers(1, _LONG)[0]
        if parameters:
            raise ValueError(parameters)
        numbers += source.integers(count, _LONG)
        rows = source.reals(3 * count)
        points += [rows[at : at + 3] for at in range(0, len(rows), 3)]
    return numbers, points


def _new_cells(source: _Source) -> Cells:
    cells: Cells = []
    for _ in range(source.integers(4, _LONG)[0]):
        kind, count = source.integers(3)[2], source.integers(1, _LONG)[0]
        for _ in range(count):
            _take(cells, kind, source.integers(1 + _corners(kind), _LONG)[1:])
    return cells


def _corners(kind: int) -> int:
    """Corners of a type of elements; how long others are is not known."""
    if kind not in _CORNERS:
        raise ValueError(kind)
    return _CORNERS[kind]


def _take(cells: Cells, kind: int, cell: list[int]) -> None:
    if kind != _POINT:
        cells.append(cell)
