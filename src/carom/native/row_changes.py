"""Rows of all arrays of one table or several, put in by one native call, and taken out with a change.

The functions are in `native/source/changes/table_rows.cpp`. They are called with the GIL held, so no signal
handler runs between the first array and the last.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from functools import cache
from math import prod
from struct import Struct
from typing import Any, NamedTuple

import numpy as np

from carom.layouts.table_rows import RowField, RowReference, RowTable
from carom.native.arrays import c_array
from carom.native.change import Change

_PACK_FIELD = Struct("5q").pack


class RowsOfAxis(NamedTuple):
    """An array of a table.

    Attributes:
        axis: Name of the axis its rows belong to.
        array: Its memory: one axis of rows, or an axis of worlds and one of rows, and those of an entry.
        per_world: Whether it has an axis of worlds.
        address: Address of the memory.
    """

    axis: str
    array: np.ndarray
    per_world: bool
    address: int


class RowNumbers(NamedTuple):
    """A field whose values are row numbers, negative where there is no row.

    Attributes:
        axis: Name of the axis its rows belong to.
        target: Name of the axis whose rows the numbers mean.
        array: Its numbers, the axis of rows first; int32.
    """

    axis: str
    target: str
    array: np.ndarray


class RowChanges:
    """Changes of the rows of tables, valid until one of their arrays is replaced.

    They take all arrays of the tables, and those fields that contain row numbers.
    """

    def __init__(self, fields: list[RowsOfAxis], references: list[RowNumbers]) -> None:
        names = [field.axis for field in fields] + [reference.target for reference in references]
        self._axes = tuple(dict.fromkeys(names))
        place = {axis: number for number, axis in enumerate(self._axes)}
        self._zeros = (0,) * len(self._axes)
        self._fields = fields
        field_records = type(c_array(RowField, len(fields))).from_buffer_copy(
            b"".join([_packed_field(field, place[field.axis]) for field in fields])
        )
        reference_records = c_array(RowReference, len(references))
        for record, (axis, target, array) in zip(reference_records, references, strict=True):
            record.memory, record.row_bytes = array.ctypes.data, array.strides[0]
            record.numbers = prod(array.shape[1:])
            record.axis, record.target = place[axis], place[target]
        records = field_records, reference_records
        table = RowTable(*map(ctypes.addressof, records), *map(len, records))
        self._kept = *records, table
        self._table = ctypes.addressof(table)
        self._pack = Struct(f"{len(self._axes)}q").pack
        self._put = _function()

    def first_rows(self, count: Mapping[str, int]) -> bytes:
        """The first rows of each array in turn, so many on each axis, of the first world."""
        return b"".join(
            (array[0] if per_world else array)[: count.get(axis, 0)].tobytes()
            for axis, array, per_world, _ in self._fields
        )

    def packed(self, numbers: Mapping[str, int]) -> bytes:
        """A number for each axis, as the native functions take them."""
        return self._pack(*map(numbers.get, self._axes, self._zeros))

    def put(self, rows: bytes, first: Mapping[str, int], count: bytes) -> None:
        """Put rows into unused places of every world, as `first_rows` returned them for equal tables.

        The rows have row numbers as if no other rows were there. They go to the rows `first`, by axis;
        `count`, how many there are, is `packed`.
        """
        self._put(self._table, rows, self.packed(first), count)

    def cut(
        self, change: Change, first: Mapping[str, int], count: Mapping[str, int], used: Mapping[str, int]
    ) -> None:
        """Remove rows with a change; see `ArrayTable.cut`."""
        change.cut(self._table, self.packed(first), self.packed(count), self.packed(used), self)


def _packed_field(field: RowsOfAxis, axis: int) -> bytes:
    """A field as a `RowField`."""
    strides = field.array.strides
    if field.per_world:
        worlds, rows = field.array.shape[:2]
        return _PACK_FIELD(field.address, worlds, strides[1] * rows, strides[1], axis)
    return _PACK_FIELD(field.address, 1, 0, strides[0], axis)


@cache
def _function() -> Any:
    """The native function that puts rows in."""
    from carom.native.library import library

    put = ctypes.PYFUNCTYPE(None, ctypes.c_void_p, *[ctypes.c_char_p] * 3)
    return put(("carom_put_rows", library().symbols))
