"""STL, binary and ASCII: one part."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from carom.errors import DescriptionError
from carom.files.budget import charge
from carom.meshes.part import MeshPart, make_part

if TYPE_CHECKING:
    from numpy.typing import NDArray

_HEADER_BYTES = 84
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_NUMBERS = rb"\s+(\S+)\s+(\S+)\s+(\S+)"
_VERTEX = re.compile(rb"\bvertex" + _NUMBERS, re.IGNORECASE)
_NORMAL = re.compile(rb"\bfacet\s+normal" + _NUMBERS, re.IGNORECASE)


def read_stl(data: bytes, file: Path) -> list[MeshPart]:
    """Reads an STL file of either kind; raises `DescriptionError` if it is neither, cut off or empty."""
    facets = _binary_facets(data)
    if facets is not None:
        return _part(facets["corners"].reshape(-1, 3).astype(np.float64), file)
    if data.lstrip()[:5].lower() == b"solid":
        return _read_ascii(data, file)
    raise DescriptionError(
        f"not an STL file, or cut off: {len(data)} bytes do not fit the triangle count in the header",
        file=file,
    )


def stl_normals(data: bytes, count: int) -> NDArray[np.float64]:
    """(count, 3) normals of the triangles of an STL file as it gives them; zero where it gives none."""
    facets = _binary_facets(data)
    if facets is not None:
        return facets["normal"].astype(np.float64)
    matches = _NORMAL.findall(data)
    if len(matches) != count:
        return np.zeros((count, 3))
    return np.array([_numbers_or_zero(words) for words in matches])


def _binary_facets(data: bytes) -> NDArray[np.void] | None:
    """Rows of a binary file; it may begin with "solid" as well: only the length distinguishes it."""
    if len(data) >= _HEADER_BYTES:
        count = int.from_bytes(data[80:84], "little")
        if len(data) == _HEADER_BYTES + count * _TRIANGLE.itemsize:
            return np.frombuffer(data, dtype=_TRIANGLE, offset=_HEADER_BYTES)
    return None


def _numbers_or_zero(words: tuple[bytes, ...]) -> list[float]:
    try:
        return [float(word) for word in words]
    except ValueError:
        return [0.0, 0.0, 0.0]


def _read_ascii(data: bytes, file: Path) -> list[MeshPart]:
    matches = list(_VERTEX.finditer(data))
    positions = np.empty((len(matches), 3))
    for index, match in enumerate(matches):
        try:
            positions[index] = [float(word) for word in match.groups()]
        except ValueError:
            line = data.count(b"\n", 0, match.start()) + 1
            raise DescriptionError("a vertex needs three numbers", file=file, line=line) from None
    if len(positions) % 3 or len(re.findall(rb"\bvertex\b", data, re.IGNORECASE)) != len(positions):
        raise DescriptionError("cut off: a facet lacks vertices or numbers", file=file)
    return _part(positions, file)


def _part(positions: np.ndarray, file: Path) -> list[MeshPart]:
    charge("vertices", len(positions) + len(positions) // 3)
    if len(positions) == 0:
        raise DescriptionError("there are no triangles", file=file)
    corners = np.arange(len(positions), dtype=np.int64).reshape(-1, 3)
    return [make_part(file, positions, corners)]
