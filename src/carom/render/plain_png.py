"""The plainest PNG files, decoded without Pillow, whose import takes longer than loading most scenes."""

from __future__ import annotations

from struct import unpack_from

import numpy as np
from numpy.typing import NDArray

MAX_BYTES = 1 << 24
"""Largest image that is decoded here."""

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_HEADER = b"\x00\x00\x00\rIHDR"
_SIZE_AT = len(_SIGNATURE) + len(_HEADER)
# What follows the size, if channels have eight bits and rows are not interlaced: the mode as Pillow names it,
# and the number of channels.
_KINDS = {b"\x08\x02\x00\x00\x00": ("RGB", 3), b"\x08\x06\x00\x00\x00": ("RGBA", 4)}


def read_plain_png(data: bytes) -> tuple[NDArray[np.uint8], str] | None:
    """The texels (height, width, 3) of a PNG file, without alpha, and its mode as Pillow names it.

    None for any other file, and for PNG files with more than that: palettes, filters, metadata or errors.
    """
    kind = _KINDS.get(data[_SIZE_AT + 8 : _SIZE_AT + 13])
    if kind is None or not data.startswith(_SIGNATURE + _HEADER):
        return None
    mode, channels = kind
    width, height = unpack_from(">II", data, _SIZE_AT)
    # Each row begins with the number of its filter; 0 is for none.
    length = height * (1 + width * channels)
    if not (width and height) or length > MAX_BYTES:
        return None
    rows = _image_data(data, length)
    if rows is None:
        return None
    filtered = np.frombuffer(rows, np.uint8).reshape(height, -1)
    if filtered[:, 0].any():
        return None
    return filtered[:, 1:].reshape(height, width, channels)[..., :3].copy(), mode


def _image_data(data: bytes, length: int) -> bytes | None:
    """The bytes of the image, so many; None if there are chunks of other kinds, or anything is broken."""
    from zlib import crc32, decompressobj, error

    packed, at, name = bytearray(), len(_SIGNATURE), b""
    while name != b"IEND":
        if len(data) < at + 12:
            return None
        size, name = unpack_from(">I4s", data, at)
        end = at + 8 + size
        if name not in (b"IHDR", b"IDAT", b"IEND") or (name == b"IHDR") != (at == len(_SIGNATURE)):
            return None
        if len(data) < end + 4 or unpack_from(">I", data, end) != (crc32(data[at + 4 : end]),):
            return None
        packed += data[at + 8 : end] if name == b"IDAT" else b""
        at = end + 4
    try:
        decoder = decompressobj()
        rows = decoder.decompress(packed, length + 1)
    except error:
        return None
    return rows if len(rows) == length and decoder.eof and at == len(data) else None
