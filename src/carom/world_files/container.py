"""The container of a saved world: a header with checks, a document, and blocks of bytes.

All numbers are little-endian.

    offset  size
         0     8  the bytes 89 43 41 52 4F 4D 0D 0A ("CAROM" between bytes that a transfer as text changes)
         8     4  version of the format: 1
        12     4  0
        16     8  size of the payload
        24    32  SHA-256 of the payload
        56     -  the payload

The payload is the size of the document (8 bytes), the document (JSON, UTF-8) and the blocks. The document
names a block by its offset from the end of the document; see `carom.world_files.records`.
"""

from __future__ import annotations

import hashlib
import json
import struct
from pathlib import Path
from typing import Any

from carom.errors import DescriptionError

MAGIC = b"\x89CAROM\r\n"
VERSION = 1

_HEADER = struct.Struct("<8sIIQ32s")
_SIZE = struct.Struct("<Q")
_ALIGNMENT = 8


class Blocks:
    """Blocks of bytes that a document refers to, one after the other, at offsets that are multiples of 8."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0

    def add(self, data: bytes) -> int:
        """Append a block and return its offset."""
        offset = self._size
        padding = -len(data) % _ALIGNMENT
        self._parts += (data, bytes(padding))
        self._size += len(data) + padding
        return offset

    def joined(self) -> bytes:
        """All blocks as one byte string."""
        return b"".join(self._parts)


def packed(document: dict[str, Any], blocks: Blocks) -> bytes:
    """The content of a file with a document and its blocks."""
    text = json.dumps(document, separators=(",", ":"), ensure_ascii=False).encode()
    payload = _SIZE.pack(len(text)) + text + blocks.joined()
    return _HEADER.pack(MAGIC, VERSION, 0, len(payload), hashlib.sha256(payload).digest()) + payload


def unpacked(data: bytes, file: Path) -> tuple[dict[str, Any], memoryview]:
    """The document and the blocks in the content of a file, whose path is for error messages.

    Raises:
        DescriptionError: The file is not a saved world, has another version of the format, or is damaged.
    """
    if len(data) < _HEADER.size or data[: len(MAGIC)] != MAGIC:
        raise DescriptionError("this is not a world saved by Carom", file=file)
    _, version, _, size, digest = _HEADER.unpack_from(data)
    if version != VERSION:
        raise DescriptionError(
            f"it has version {version} of the format; this Carom reads version {VERSION}", file=file
        )
    payload = memoryview(data)[_HEADER.size :]
    if len(payload) != size:
        raise DescriptionError(f"it is damaged: {len(payload)} bytes instead of {size}", file=file)
    if hashlib.sha256(payload).digest() != digest:
        raise DescriptionError("it is damaged: its checksum is wrong", file=file)
    try:
        (length,) = _SIZE.unpack_from(payload)
        document = json.loads(bytes(payload[_SIZE.size : _SIZE.size + length]))
    except (struct.error, ValueError, RecursionError) as problem:
        raise DescriptionError(f"its document cannot be read: {problem}", file=file) from problem
    if not isinstance(document, dict) or length > len(payload):
        raise DescriptionError("its document is not a JSON object", file=file)
    return document, payload[_SIZE.size + length :]
