"""STL, binary and ASCII: one part."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from carom.errors import DescriptionError
from carom.formats.budget import charge
from carom.formats.mesh.part import MeshPart, make_part

_HEADER_BYTES = 84
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


def read_stl(data: bytes, file: Path) -> list[MeshPart]:
    """Reads an STL file of either kind; raises `DescriptionError` if it is neither, cut off or empty."""
    # Binary files may begin with "solid" as well: only the length distinguishes them.
    if len(data) >= _HEADER_BYTES:
        count = int.from_bytes(data[80:84], "little")
        if len(data) == _HEADER_BYTES + count * _TRIANGLE.itemsize:
            corners = np.frombuffer(data, dtype=_TRIANGLE, offset=_HEADER_BYTES)["corners"]
            return _part(corners.reshape(-1, 3).astype(np.float64), file)
    if data.lstrip()[:5].lower() == b"solid":
        return _read_ascii(data, file)
    raise DescriptionError(
        f"not an STL file, or cut off: {len(data)} bytes do not fit the triangle count in the header",
        file=file,
    )


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
