"""Arrays with numbers of several worlds side by side, and the same rows in the arrays of single worlds."""

from __future__ import annotations

from collections.abc import Sequence
from math import prod
from typing import Any, NamedTuple

import numpy as np

from carom.layouts.programs import LANES, LaneRows
from carom.native.arrays import zeros
from carom.native.tables import array_view

NUMBER = np.dtype(np.float64)
# Bytes of a cache line.
_ALIGNMENT = 64


class Wide(NamedTuple):
    """An array of several worlds.

    Attributes:
        array: (rows, *shape of an entry, LANES), or rows of structs with such fields.
        axes: Axes that kernels see, of which the first may be that of worlds.
    """

    array: np.ndarray
    axes: int


def widened(lone: np.ndarray, count: int, axes: int = 2) -> Wide:
    """An array of `count` rows, which has several numbers for each of those in `lone`."""
    shape = (count, *lone.shape[axes:])
    if lone.dtype == NUMBER:
        return Wide(_aligned_zeros((*shape, LANES)), axes)
    fields: list[Any] = []
    for field in lone.dtype.names or ():
        kind = lone.dtype[field]
        if _has_numbers(kind):
            fields.append((field, NUMBER, (kind.itemsize // NUMBER.itemsize, LANES)))
        else:
            fields.append((field, kind))
    return Wide(zeros(shape, np.dtype(fields, align=True)), axes)


def _aligned_zeros(shape: tuple[int, ...]) -> np.ndarray:
    """Numbers whose lanes are not in two cache lines."""
    count = prod(shape)
    room = zeros((count + _ALIGNMENT // NUMBER.itemsize,), NUMBER)
    first = -room.ctypes.data % _ALIGNMENT // NUMBER.itemsize
    return room[first : first + count].reshape(shape)


def _has_numbers(kind: np.dtype[Any]) -> bool:
    """Whether a field of a struct is a number, a vector or a matrix; others are whole numbers."""
    while kind.subdtype is not None:
        kind = kind.base
    return kind == NUMBER


def struct_of(lone_struct: Any, shown: dict[str, Wide], lone: dict[str, np.ndarray]) -> Any:
    """A struct of some wide arrays, and of arrays of a single world which all lanes share."""
    struct = type(lone_struct)()
    for field, wide in shown.items():
        array = wide.array if wide.axes == 1 else wide.array[np.newaxis]
        setattr(struct, field, array_view(array, wide.axes))
    for field, array in lone.items():
        setattr(struct, field, array_view(array, array.ndim if array.ndim < 2 else 2))
    return struct


def rows_of_worlds(
    lone: np.ndarray, wide: np.ndarray, rows: slice, fields: tuple[str, str] | None = None
) -> LaneRows:
    """Some rows of an array of worlds that follow each other, and of that of lanes; they are one row.

    Of structs, these are rows of the numbers from one field to another.
    """
    world_stride = lone.strides[0] if len(lone) > 1 else 0
    return _rows_of([lone[0]] * LANES, world_stride, wide, rows, fields)


def rows_of_lanes(
    lone: Sequence[np.ndarray], wide: np.ndarray, rows: slice, fields: tuple[str, str] | None = None
) -> LaneRows:
    """As `rows_of_worlds`, of workspaces of which each lane has its own."""
    return _rows_of([array[0] for array in lone], 0, wide, rows, fields)


def each_row_of_lanes(
    lone: Sequence[np.ndarray], wide: np.ndarray, fields: tuple[str, str] | None = None
) -> LaneRows:
    """As `rows_of_lanes`, of all rows, each for itself."""
    together = rows_of_lanes(lone, wide, slice(None), fields)
    if fields is None:
        together.rows, together.numbers = len(wide), lone[0][0, 0].nbytes // NUMBER.itemsize
        together.row_stride, together.wide_stride = lone[0].strides[1], wide.strides[0]
    return together


def _rows_of(
    lone: Sequence[np.ndarray],
    world_stride: int,
    wide: np.ndarray,
    rows: slice,
    fields: tuple[str, str] | None,
) -> LaneRows:
    lone, wide = [array[rows] for array in lone], wide[rows]
    if fields is None:
        addresses = tuple(array.ctypes.data for array in lone)
        numbers = lone[0].nbytes // NUMBER.itemsize
        return LaneRows(addresses, world_stride, 0, wide.ctypes.data, 0, 1, numbers)
    first, last = fields
    begin, end = _place(lone[0].dtype, first)[0], _place(lone[0].dtype, last)[1]
    return LaneRows(
        tuple(array.ctypes.data + begin for array in lone),
        world_stride,
        lone[0].strides[0],
        wide.ctypes.data + _place(wide.dtype, first)[0],
        wide.strides[0],
        len(wide),
        (end - begin) // NUMBER.itemsize,
    )


def _place(dtype: np.dtype[Any], field: str) -> tuple[int, int]:
    """Where a field of a struct begins and ends [bytes]."""
    kind, offset = (dtype.fields or {})[field][:2]
    return offset, offset + kind.itemsize
