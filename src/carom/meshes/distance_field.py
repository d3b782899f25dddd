"""Signed distance fields (CDF): the bounds of the grid."""

from __future__ import annotations

import struct
from pathlib import Path

from carom.errors import DescriptionError
from carom.files.bounded import open_regular
from carom.files.unpacking import unpack

Corner = tuple[float, float, float]

_DOMAIN = struct.Struct("<6d")
_FURTHEST = 1e30


def read_field_bounds(path: Path) -> tuple[Corner, Corner]:
    """Lowest and highest corner of the grid [m], read from the start of the file.

    Raises:
        DescriptionError: The file is missing or too short, or the corners are too far away or not in order.
    """
    unpack(path)
    try:
        with open_regular(path)[0] as stream:
            header = stream.read(_DOMAIN.size)
    except OSError as error:
        raise DescriptionError(f"cannot be read: {error.strerror}", file=path) from error
    if len(header) < _DOMAIN.size:
        raise DescriptionError("cut off before the bounds of the grid", file=path)
    x0, y0, z0, x1, y1, z1 = _DOMAIN.unpack(header)
    sides = ((x0, x1), (y0, y1), (z0, z1))
    if not all(-_FURTHEST <= low <= high <= _FURTHEST for low, high in sides):
        raise DescriptionError("the bounds of the grid are too far away, or not in order", file=path)
    return (x0, y0, z0), (x1, y1, z1)
