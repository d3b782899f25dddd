"""PLY, text and binary: one part."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.files.budget import charge
from carom.meshes.part import MeshPart, cut_into_fans, make_part

_KINDS = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip
_FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_LONGEST_HEADER = 1 << 16


class _Property(NamedTuple):
    name: str
    kind: str
    count_kind: str | None


class _Kind(NamedTuple):
    name: str
    rows: int
    properties: list[_Property]


def read_ply(data: bytes, file: Path) -> list[MeshPart]:
    """Reads the faces of a PLY file; raises `DescriptionError` if it is broken, cut off or has none."""
    try:
        order, kinds, at = _header(data)
        contents = _Ascii(data[at:]) if not order else _Binary(data, at, order)
        found: dict[str, Any] = {kind.name: _values(contents, kind) for kind in kinds}
        vertices, faces = found["vertex"], found["face"]
        positions = np.stack([np.asarray(vertices[axis], np.float64) for axis in "xyz"], axis=1)
        lists = faces.get("vertex_indices", faces.get("vertex_index"))
        if lists is None:
            raise ValueError("faces have no vertex_indices")
        sizes = np.array([len(corners) for corners in lists], np.int64)
        corners = np.concatenate([np.asarray(it, np.int64) for it in lists]) if len(lists) else sizes
    except (ValueError, KeyError, IndexError, TypeError, OverflowError) as problem:
        raise DescriptionError(f"not a valid PLY file, or cut off: {problem}", file=file) from None
    charge("vertices", len(corners))
    triangles = cut_into_fans(corners, sizes) if len(sizes) else np.empty((0, 3), np.int64)
    if not len(triangles):
        raise DescriptionError("there are no triangles", file=file)
    if not 0 <= triangles.min() <= triangles.max() < len(positions):
        raise DescriptionError("a face has a vertex that does not exist", file=file)
    return [make_part(file, positions, triangles)]


def _values(contents: _Ascii | _Binary, kind: _Kind) -> dict[str, Any]:
    """The values of an element by property; elements without properties have none, however many there are."""
    if not kind.properties:
        return {}
    charge("vertices", kind.rows)
    return contents.values(kind)


def _header(data: bytes) -> tuple[str, list[_Kind], int]:
    end = data.find(b"end_header", 0, _LONGEST_HEADER)
    line_end = data.find(b"\n", end)
    if not data.startswith(b"ply") or end < 0 or line_end < 0:
        raise ValueError("it has no header")
    order, kinds = None, []
    for words in (line.split() for line in data[:end].decode("latin-1").splitlines()):
        match words:
            case ["format", name, _]:
                order = _FORMATS[name]
            case ["element", name, count]:
                if int(count) < 0:
                    raise ValueError(f"{count} elements")
                charge("elements")
                kinds.append(_Kind(name, int(count), []))
            case ["property", "list", count_kind, kind, name]:
                kinds[-1].properties.append(_Property(name, _KINDS[kind], _KINDS[count_kind]))
            case ["property", kind, name]:
                kinds[-1].properties.append(_Property(name, _KINDS[kind], None))
    if order is None:
        raise ValueError("it states no format")
    return order, kinds, line_end + 1


class _Ascii:
    def __init__(self, data: bytes) -> None:
        self.words = data.split()
        self.at = 0

    def values(self, kind: _Kind) -> dict[str, list[object]]:
        """The values of an element by property, one for each of its kind."""
        result: dict[str, list[object]] = {it.name: [] for it in kind.properties}
        for _ in range(kind.rows):
            for one in kind.properties:
                if one.count_kind is None:
                    result[one.name].append(float(self._next()))
                else:
                    count = int(self._next())
                    if not 0 <= count <= len(self.words) - self.at:
                        raise ValueError("a list is longer than the file")
                    result[one.name].append([float(self._next()) for _ in range(count)])
        return result

    def _next(self) -> bytes:
        self.at += 1
        return self.words[self.at - 1]


class _Binary:
    def __init__(self, data: bytes, at: int, order: str) -> None:
        self.data = data
        self.at = at
        self.order = order

    def values(self, kind: _Kind) -> dict[str, NDArray[np.generic] | list[object]]:
        """The values of an element by property, one for each of its kind."""
        if all(one.count_kind is None for one in kind.properties):
            row = np.dtype([(one.name, self.order + one.kind) for one in kind.properties])
            rows = np.frombuffer(self.data, row, kind.rows, self.at) if kind.rows else np.empty(0, row)
            self.at += rows.nbytes
            return {one.name: rows[one.name] for one in kind.properties}
        result: dict[str, NDArray[np.generic] | list[object]] = {one.name: [] for one in kind.properties}
        for _ in range(kind.rows):
            for one in kind.properties:
                count = 1 if one.count_kind is None else int(self._take(one.count_kind, 1)[0])
                taken = self._take(one.kind, count)
                result[one.name].append(taken[0] if one.count_kind is None else taken)  # pyright: ignore
        return result

    def _take(self, kind: str, count: int) -> NDArray[np.generic]:
        taken = np.frombuffer(self.data, self.order + kind, count, self.at) if count else np.empty(0)
        self.at += taken.nbytes
        return taken
