"""Legacy VTK files in text form: tetrahedra of an unstructured grid.

The format is that of "VTK File Formats", simple legacy formats: a header line with the version, a title,
`ASCII`, `DATASET UNSTRUCTURED_GRID`, and sections that each begin with a keyword. Cells that are not
tetrahedra, and data of points and cells, are ignored. Some of Bullet's own files have no space in the first
line, a wrong total size after `CELLS`, or nothing after `CELL_TYPES`; they are read, too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.files.bounded import read_bounded
from carom.files.budget import charge

TETRAHEDRON = 10
"""VTK's cell type of tetrahedra."""
# VTK's largest cell with a fixed number of corners has 27; polyhedra may have more.
_MAX_CORNERS = 10_000


@dataclass(frozen=True, slots=True, eq=False)
class TetraMesh:
    """Tetrahedra from a file.

    Attributes:
        points: (n, 3) positions [m].
        tetras: (t, 4) indices into `points`, in the order of the file.
    """

    points: NDArray[np.float64]
    tetras: NDArray[np.int32]


def read_vtk(path: Path) -> TetraMesh:
    """Reads the tetrahedra of a VTK file.

    Raises:
        DescriptionError: The file is missing, binary, cut off or broken, names points that do not exist, or
            has no tetrahedra.
    """
    with reading(path):
        data, _ = read_bounded(path.absolute())
        return _Sections(data, path).mesh()


class _Sections:
    """Reads the sections of a file word by word."""

    def __init__(self, data: bytes, file: Path) -> None:
        self._file = file
        lines = data.split(b"\n")
        if not lines[0].lower().replace(b" ", b"").startswith(b"#vtkdatafile"):
            raise self._wrong("it does not begin with '# vtk DataFile', as VTK's legacy files do", 1)
        kind = lines[2].strip().upper() if len(lines) > 2 else b""
        if kind == b"BINARY":
            raise self._wrong("it is binary; write it as ASCII", 3)
        if kind != b"ASCII":
            raise self._wrong("the third line has to be ASCII", 3)
        self._words: Iterator[tuple[int, bytes]] = (
            (number, word) for number, line in enumerate(lines[3:], start=4) for word in line.split()
        )
        self._line = 3

    def mesh(self) -> TetraMesh:
        points = np.empty((0, 3))
        cells: list[NDArray[np.int64]] = []
        kinds: NDArray[np.int64] | None = None
        for number, word in self._words:
            self._line = number
            keyword = word.upper()
            if keyword == b"DATASET":
                name = self._word("a kind of data set")
                if name.upper() != b"UNSTRUCTURED_GRID":
                    raise self._wrong("the data set has to be an UNSTRUCTURED_GRID")
            elif keyword == b"POINTS":
                count = self._count("POINTS")
                self._word("a type of numbers")
                points = self._numbers(3 * count, float, "coordinate").reshape(-1, 3)
            elif keyword == b"CELLS":
                count, _ = self._count("CELLS"), self._count("CELLS")
                cells = [self._cell() for _ in range(count)]
            elif keyword == b"CELL_TYPES":
                kinds = self._kinds()
            elif keyword in (b"POINT_DATA", b"CELL_DATA", b"METADATA"):
                break
            else:
                shown = word[:30].decode("utf-8", errors="backslashreplace")
                raise self._wrong(f"{shown!r} is no section of an unstructured grid")
        return self._checked(points, cells, kinds)

    def _checked(
        self, points: NDArray[np.float64], cells: list[NDArray[np.int64]], kinds: NDArray[np.int64] | None
    ) -> TetraMesh:
        if kinds is not None and len(kinds) != len(cells):
            raise self._wrong(f"there are {len(cells)} cells, but {len(kinds)} cell types")
        is_tetra = [len(cell) == 4 for cell in cells] if kinds is None else (kinds == TETRAHEDRON).tolist()
        chosen = [cell for cell, wanted in zip(cells, is_tetra, strict=True) if wanted]
        if any(len(cell) != 4 for cell in chosen):
            raise self._wrong("a tetrahedron has four corners")
        if not chosen:
            raise DescriptionError("there are no tetrahedra", file=self._file)
        tetras = np.array(chosen)
        if tetras.min() < 0 or tetras.max() >= len(points):
            raise DescriptionError(f"a cell names a point outside 0..{len(points) - 1}", file=self._file)
        if not np.isfinite(points).all():
            raise DescriptionError("a point is not finite", file=self._file)
        return TetraMesh(points, tetras.astype(np.int32))

    def _cell(self) -> NDArray[np.int64]:
        (length,) = self._numbers(1, int, "length of a cell").tolist()
        if not 1 <= length <= _MAX_CORNERS:
            raise self._wrong(f"a cell has from 1 to {_MAX_CORNERS} corners, not {length}")
        return self._numbers(length, int, "index")

    def _kinds(self) -> NDArray[np.int64] | None:
        count = self._count("CELL_TYPES")
        first = next(self._words, None)
        if first is None:
            return None
        self._words = chain([first], self._words)
        return self._numbers(count, int, "type")

    def _word(self, what: str) -> bytes:
        for number, word in self._words:
            self._line = number
            return word
        raise self._wrong(f"the file ends where {what} should be")

    def _count(self, section: str) -> int:
        word = self._word(f"the number of {section}")
        try:
            count = int(word)
        except ValueError:
            count = -1
        if count < 0:
            raise self._wrong(f"{section} needs a whole number, 0 or more")
        charge("vertices", count, file=self._file, line=self._line)
        return count

    def _numbers(self, count: int, kind: type, name: str) -> NDArray:
        values = []
        for _ in range(count):
            word = self._word(f"the next {name}")
            try:
                values.append(kind(word))
            except ValueError:
                shown = word[:30].decode("utf-8", errors="backslashreplace")
                raise self._wrong(f"{shown!r} is no {name}") from None
        try:
            return np.array(values, dtype=np.float64 if kind is float else np.int64)
        except OverflowError:
            raise self._wrong(f"an {name} is too large") from None

    def _wrong(self, reason: str, line: int | None = None) -> DescriptionError:
        return DescriptionError(reason, file=self._file, line=self._line if line is None else line)
