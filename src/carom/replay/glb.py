"""The container of binary glTF: a document in JSON, and one buffer with its arrays and images."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

FLOATS, WHOLES = 5126, 5125
"""Types of numbers, of four bytes each."""
ARRAY, INDICES = 34962, 34963
"""What an array is for: attributes of vertices, or their indices."""
_TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 2: "VEC2"}
_MAGIC, _VERSION, _JSON, _BINARY = 0x46546C67, 2, 0x4E4F534A, 0x004E4942
_MOST = 2**32 - 1


class Glb:
    """The buffer of a file, and what the document says of it."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []

    def part(self, data: bytes, target: int | None = None) -> int:
        """Adds bytes; returns the number of their view."""
        view = {"buffer": 0, "byteOffset": self._size, "byteLength": len(data)}
        if target is not None:
            view["target"] = target
        self._views.append(view)
        padded = data + bytes(-len(data) % 4)
        self._parts.append(padded)
        self._size += len(padded)
        return len(self._views) - 1

    def numbers(
        self, array: NDArray[Any], kind: int, target: int | None = None, *, bounded: bool = False
    ) -> int:
        """Adds an array.

        Args:
            array: (rows,) or (rows, columns) numbers of four bytes.
            kind: `FLOATS` or `WHOLES`.
            target: `ARRAY` or `INDICES`; None for those of animations.
            bounded: Whether its least and greatest values are told.

        Returns:
            The number of its accessor.
        """
        columns = 1 if array.ndim == 1 else array.shape[1]
        accessor: dict[str, Any] = {
            "bufferView": self.part(np.ascontiguousarray(array).tobytes(), target),
            "componentType": kind,
            "count": len(array),
            "type": _TYPES[columns],
        }
        if bounded:
            rows = array.reshape(len(array), columns)
            accessor["min"], accessor["max"] = rows.min(axis=0).tolist(), rows.max(axis=0).tolist()
        self._accessors.append(accessor)
        return len(self._accessors) - 1

    def packed(self, document: dict[str, Any]) -> bytes:
        """The file; of the document empty lists are left out, which glTF forbids.

        Raises:
            ValueError: It would be larger than 4 GiB.
        """
        document = {**document, "accessors": self._accessors, "bufferViews": self._views}
        if self._size:
            document["buffers"] = [{"byteLength": self._size}]
        document = {name: value for name, value in document.items() if value != []}
        text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        chunks = [struct.pack("<II", len(text), _JSON), text]
        if self._size:
            chunks += [struct.pack("<II", self._size, _BINARY), *self._parts]
        size = 12 + sum(map(len, chunks))
        if size > _MOST:
            raise ValueError(f"the replay needs {size} bytes, and a .glb file has at most 4 GiB")
        return b"".join((struct.pack("<III", _MAGIC, _VERSION, size), *chunks))
