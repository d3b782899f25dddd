"""Flat arrays that grow: the memory behind `Model`, `State` and `Scratch`.

An `ArrayTable` owns one NumPy array per field. Arrays of the same axis (links, coordinates...)
grow together and geometrically, so that adding bodies one by one costs linear time; the struct that kernels
are given is filled with views of the same memory.

Fields whose arrays have two dimensions have a world axis in front. If that has a single row, all worlds
share it: kernels see a stride of zero.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from ctypes import addressof, c_char
from functools import cache, lru_cache, partial
from math import prod
from struct import Struct as Packing
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np

from carom.layouts.types import ArrayType, ArrayView, Struct, Type, Use
from carom.native.arrays import zeros
from carom.native.change import Change
from carom.native.row_changes import RowChanges, RowNumbers, RowsOfAxis

if TYPE_CHECKING:
    import numpy.typing as npt

ROOM_AT_FIRST = 64
"""Rows of the tables of a world's bodies from the start: few worlds have one body only."""

NUMPY_REAL = np.float64
"""The type of real numbers in kernels."""

_FIRST_CAPACITY = 16
# Tables with few rows get room for several times as many, so that the axes of a world grow at the same time.
_FEW_ROWS, _AHEAD = 1024, 8
# The first field of an `ArrayView`, and the others, as bytes.
_PACK_ADDRESS, _PACK_SHAPE = Packing("=Q").pack, Packing("=Q8iHH4x").pack
_BYTES = np.dtype(np.uint8)
# Arrays of one block begin at multiples of it [bytes], those of cache lines.
_ALIGNMENT = 64


def numbers_of(numbers: np.ndarray) -> memoryview[float]:
    """The memory of an array of numbers: access to single numbers is faster than with NumPy."""
    return cast("memoryview[float]", numbers.data)


def writer_of(numbers: np.ndarray) -> Callable[..., None]:
    """A function that writes all items of a flat array of numbers, which are its arguments.

    It raises `struct.error` for arguments that are not numbers, and if there are more or fewer.
    """
    return partial(Packing(f"{len(numbers)}{numbers.dtype.char}").pack_into, numbers.data, 0)


class Field(NamedTuple):
    """One array of a table.

    Attributes:
        axis: Name of the axis its rows belong to.
        per_world: Whether there is a world axis in front of it.
        shape: Shape of one entry; () for a number or a struct.
        scalar: NumPy type of the numbers, or of the struct.
        use: What it is for.
    """

    axis: str
    per_world: bool
    shape: tuple[int, ...]
    scalar: np.dtype[Any]
    use: Use


@cache
def fields_of(struct: type[Struct]) -> Mapping[str, Field]:
    """The array fields of a struct."""
    fields = {}
    for name, array in struct.fields.items():
        if not isinstance(array, ArrayType):
            continue
        entry = array.entry
        if isinstance(entry, Type):
            shape, scalar = entry.shape, np.dtype(entry.scalar)
        else:
            shape, scalar = (), np.dtype(entry)
        use = struct.uses[name]
        fields[name] = Field(use.axis, array.ndim == 2, shape, scalar, use)
    return fields


def array_view(array: np.ndarray, axes: int = 1) -> ArrayView:
    """An array as kernels are given it; it keeps the memory alive.

    Kernels see so many axes, those behind them are those of entries. Of two axes the first is the world axis;
    if it has a single row, all worlds see this row.

    Raises:
        ValueError: The entries along the last axis are not next to each other, as kernels expect.
    """
    shape, strides = array.shape, array.strides
    entry = strides[axes] * shape[axes] if len(shape) > axes else array.itemsize
    if strides[axes - 1] != entry and shape[axes - 1] > 1:
        raise ValueError("kernels need arrays whose entries are next to each other along the last axis")
    view = ArrayView(array.ctypes.data, 0, shape[:axes], strides[:axes], axes)
    if axes == 2 and shape[0] == 1:
        view.strides[0] = 0
    view.memory = array
    return view


def address_of(array: np.ndarray) -> int:
    """Address of a contiguous array that can be written to; quicker than with NumPy."""
    memory: Any = array
    return addressof(c_char.from_buffer(memory)) if array.size else array.ctypes.data


def put_array(struct: Any, name: str, values: npt.ArrayLike) -> np.ndarray:
    """Make a field of a struct an array of one axis with values of shape (n, *shape of an entry).

    Returns:
        The array that kernels see, which the struct keeps alive.
    """
    field = fields_of(type(struct))[name]
    array = np.ascontiguousarray(values, dtype=field.scalar).reshape(-1, *field.shape)
    setattr(struct, name, array_view(array))
    struct.__dict__.setdefault("memory", {})[name] = array
    return array


def put_zeros(struct: Any, name: str, count: int) -> np.ndarray:
    """Make a field of a struct an array of `count` zeros; see `put_array`."""
    field = fields_of(type(struct))[name]
    return put_array(struct, name, zeros((count, *field.shape), field.scalar))


def room_ahead(needed: Mapping[str, int]) -> dict[str, int]:
    """Rows to reserve on each axis if there is no room for those that are needed."""
    return {axis: _AHEAD * count if count <= _FEW_ROWS else count for axis, count in needed.items()}


@lru_cache(maxsize=4096)
def _shape_of_view(shape: tuple[int, ...], strides: tuple[int, ...], per_world: bool) -> bytes:
    """An `ArrayView` of a contiguous array, without its address."""
    if per_world:
        step = 0 if shape[0] == 1 else strides[0]
        return _PACK_SHAPE(0, shape[0], shape[1], 0, 0, step, strides[1], 0, 0, 2, 0)
    return _PACK_SHAPE(0, shape[0], 0, 0, 0, strides[0], 0, 0, 0, 1, 0)


@cache
def _first_fields(
    struct: type[Struct], capacity: int
) -> tuple[dict[str, tuple[int, tuple[int, ...], np.dtype[Any]]], int]:
    """Place [bytes], shape and type of the arrays of a struct in one block of memory, and its size."""
    fields, size = {}, 0
    for name, field in fields_of(struct).items():
        shape = (*((1,) if field.per_world else ()), capacity, *field.shape)
        fields[name] = size, shape, field.scalar
        size += -(-prod(shape) * field.scalar.itemsize // _ALIGNMENT) * _ALIGNMENT
    return fields, size


class ArrayTable:
    """Arrays by name, grouped by axis, those of two dimensions with a leading world axis.

    Attributes:
        numpy: The arrays by the names of their fields. For an array of structs there is one array for each of
            their fields, named after both: `link_mass` is the field `mass` of `link`.
        capacity: Number of allocated rows, by axis.
        replacements: Number of times that an array was replaced by another.
    """

    _in_one_block = True

    def __init__(
        self,
        struct: Any,
        world_count: int = 1,
        entry_views: Mapping[str, str] | None = None,
        first_capacity: int = _FIRST_CAPACITY,
        references: Mapping[str, str] | None = None,
    ) -> None:
        """Make the arrays of a struct, whose fields are all arrays, with `first_capacity` rows on each axis.

        The fields in `entry_views` show the vectors of another field scalar by scalar. The values of those in
        `references` are row numbers, of the axis named there; they are updated when rows move.
        """
        self._struct = struct
        self._entry_views = dict(entry_views or {})
        self._references = dict(references or {})
        self._fields = {
            name: field for name, field in fields_of(struct).items() if name not in self._entry_views
        }
        self._wholes: dict[str, str] = {}
        self._of_kinds: dict[str, list[str]] = {}
        self._world_counts = dict.fromkeys(self._fields, world_count)
        self.capacity: dict[str, int] = {field.axis: first_capacity for field in self._fields.values()}
        self.replacements: int = 0
        self._memory: dict[str, np.ndarray] = {}
        self.numpy: dict[str, np.ndarray] = {}
        self._made: Any = None
        self._views: dict[str, tuple[np.ndarray, bytes]] = {}
        self._addresses: dict[str, tuple[np.ndarray, int]] = {}
        self._bytes: dict[str, memoryview[int]] = {}
        self._by_axis: dict[str, list[np.ndarray]] = {}
        self._row_changes: RowChanges | None = None
        self._take(self._first_arrays(first_capacity))

    def _first_arrays(self, capacity: int) -> dict[str, np.ndarray]:
        """Arrays with so many rows, those of a single world next to each other in memory."""
        if set(self._world_counts.values()) != {1} or not self._in_one_block:
            return {name: self._allocate(name, capacity) for name in self._fields}
        fields, size = _first_fields(self._struct, capacity)
        block = zeros((size,), _BYTES)
        start = address_of(block)
        arrays = {}
        for name in self._fields:
            offset, shape, scalar = fields[name]
            arrays[name] = array = np.ndarray(shape, scalar, block, offset)
            self._addresses[name] = array, start + offset
        return arrays

    def _allocate(self, name: str, capacity: int) -> np.ndarray:
        field = self._fields[name]
        worlds = (self._world_counts[name],) if field.per_world else ()
        return self._new_array((*worlds, capacity, *field.shape), field.scalar)

    def _new_array(self, shape: tuple[int, ...], dtype: np.dtype[Any]) -> np.ndarray:
        """An array of zeros in the kind of memory that this table uses."""
        return zeros(shape, dtype)

    def _replace(self, arrays: Mapping[str, np.ndarray], change: Change) -> None:
        """Replace arrays by others, and what is derived from them, with a change."""
        # Others hold these dictionaries.
        change.put_all(self._memory, arrays)
        change.put_all(self.capacity, self._lengths(arrays))
        change.put_all(self.numpy, _by_part(arrays))
        change.set(self, "replacements", self.replacements + 1)
        change.set_all(self, _made=None, _bytes={}, _by_axis={}, _row_changes=None)

    def take_over(self, change: Change, other: ArrayTable, *, but: Collection[str] = ()) -> None:
        """Replace the arrays by those of an equal table with a change, except for those that are named."""
        self._replace({name: array for name, array in other._memory.items() if name not in but}, change)
        change.put_all(self._world_counts, other._world_counts)

    def _take(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Take the first arrays of a table that nobody has yet."""
        self._memory.update(arrays)
        self.capacity.update(self._lengths(arrays))
        self.numpy.update(_by_part(arrays))
        self.replacements += 1

    def _lengths(self, arrays: Mapping[str, np.ndarray]) -> dict[str, int]:
        """The number of rows by axis."""
        fields = self._fields
        return {fields[name].axis: array.shape[int(fields[name].per_world)] for name, array in arrays.items()}

    def whole_of(self, name: str) -> str:
        """The name of the field that the array of that name in `numpy` belongs to."""
        if name not in self._wholes:
            wholes = {whole: whole for whole in self._fields}
            for whole, field in self._fields.items():
                # An array of structs has one in `numpy` for each field of the struct.
                wholes.update((f"{whole}_{part}", whole) for part in field.scalar.names or ())
            # At once: who is interrupted before this leaves no half of it behind.
            self._wholes = wholes
        return self._wholes[name]

    def field_of(self, name: str) -> Field:
        """That field."""
        return self._fields[self.whole_of(name)]

    def axis_of(self, name: str) -> str:
        """The axis of the rows of the array of that name in `numpy`."""
        return self.field_of(name).axis

    def of_kind(self, kind: str) -> dict[str, np.ndarray]:
        """The arrays of `numpy` of a kind: `STATE`, `PARAMETER` or `CACHE` of `carom.layouts.types`."""
        names = self._of_kinds.get(kind)
        if names is None:
            names = [name for name in self.numpy if self.field_of(name).use.kind == kind]
            self._of_kinds[kind] = names
        return {name: self.numpy[name] for name in names}

    def is_per_world(self, name: str) -> bool:
        """Whether the array of that name in `numpy` has a world axis."""
        return (self._fields.get(name) or self.field_of(name)).per_world

    def bytes_of(self, name: str) -> memoryview[int]:
        """The memory of a field: reading a few rows takes less time than reading one row with NumPy."""
        memory = self._bytes.get(name)
        if memory is None:
            array: Any = self._memory[name]
            memory = self._bytes[name] = memoryview(array).cast("B")
        return memory

    def lacks(self, needed: Mapping[str, int]) -> bool:
        """Whether there is no room for `needed` rows on one of the axes."""
        capacity = self.capacity
        # A loop takes half the time of `any`.
        for axis, count in needed.items():  # noqa: SIM110
            if count > capacity.get(axis, count):
                return True
        return False

    def reserve(self, needed: Mapping[str, int], growth: float = 2.0) -> bool:
        """Make room for `needed` rows by axis, growing by a least factor; true if arrays were replaced."""
        if not self.lacks(needed):
            return False
        change = Change()
        self.grow(change, needed, growth)
        change.commit()
        return True

    def grow(self, change: Change, needed: Mapping[str, int], growth: float = 2.0) -> dict[str, np.ndarray]:
        """Make room for `needed` rows by axis with a change.

        Returns:
            The new arrays, by their names in `numpy`, which nobody else has yet; none if there is room.
        """
        if not self.lacks(needed):
            return {}
        capacity = self.capacity
        grown = {
            axis: max(count, int(growth * capacity[axis]))
            for axis, count in needed.items()
            if count > capacity.get(axis, count)
        }
        longer = {
            name: self._lengthened(name, grown[field.axis])
            for name, field in self._fields.items()
            if field.axis in grown
        }
        self._replace(longer, change)
        return _by_part(longer)

    def _lengthened(self, name: str, capacity: int) -> np.ndarray:
        """A longer copy of a field's array."""
        old = self._memory[name]
        new = self._allocate(name, capacity)
        new[tuple(map(slice, old.shape))] = old
        return new

    def spread(self, name: str, world_count: int) -> bool:
        """Give each world its own rows of a shared field; true if the field was shared before."""
        if self._world_counts[name] == world_count:
            return False
        spread = np.repeat(self._memory[name], world_count, axis=0)
        change = Change()
        change.put(self._world_counts, name, world_count)
        self._replace({name: spread}, change)
        change.commit()
        return True

    def copy(self, world_count: int | None = None, rows: Mapping[str, int] | None = None) -> ArrayTable:
        """A table with the same content.

        It has `world_count` worlds, each with a copy of the first world's rows, or the worlds as they are. If
        `rows` has an axis, so many of its rows are kept, without capacity for more.
        """
        rows = rows or {}
        other = self._without_arrays()
        other.capacity = {axis: max(1, rows.get(axis, count)) for axis, count in self.capacity.items()}
        arrays = {}
        for name, field in self._fields.items():
            array, count = self._memory[name], other.capacity[field.axis]
            if field.per_world:
                other._world_counts[name] = world_count or len(array)
                array = array[:, :count]
                array = array.copy() if world_count is None else _repeated(array[0], world_count)
            else:
                array = array[:count].copy()
            arrays[name] = array
        other._take(arrays)
        return other

    def twin(self, shared: Collection[str] = ()) -> ArrayTable:
        """A table of as many rows, all zero; on the shared axes it has the very arrays of this one.

        Arrays of its own are in one block of memory.
        """
        other = self._without_arrays()
        own = {name: array for name, array in self._memory.items() if self._fields[name].axis not in shared}
        places, size = {}, 0
        for name, array in own.items():
            places[name] = size
            size += -(-array.nbytes // _ALIGNMENT) * _ALIGNMENT
        block = zeros((size,), _BYTES)
        zeroed = {
            name: np.ndarray(array.shape, array.dtype, block, places[name]) for name, array in own.items()
        }
        other._take({name: zeroed.get(name, array) for name, array in self._memory.items()})
        return other

    def _without_arrays(self) -> ArrayTable:
        """A table of the same struct, worlds and capacity that has no arrays yet."""
        other = ArrayTable.__new__(ArrayTable)
        other.__dict__.update(self.__dict__)
        other.numpy, other._memory, other._made, other._bytes = {}, {}, None, {}
        other._views, other._addresses = {}, {}
        other._by_axis, other._row_changes = {}, None
        other._world_counts, other.capacity = self._world_counts.copy(), self.capacity.copy()
        return other

    def bytes_per_world(self, rows: Mapping[str, int] | None = None) -> int:
        """Memory of each world, given the number of rows on some axes [bytes]."""
        rows = rows or {}
        return sum(
            rows.get(field.axis, self.capacity[field.axis]) * self._memory[name][0, :1].nbytes
            for name, field in self._fields.items()
            if field.per_world
        )

    def __deepcopy__(self, memo: dict[int, Any]) -> ArrayTable:
        memo[id(self)] = other = self.copy()
        return other

    def cut(
        self, change: Change, first: Mapping[str, int], count: Mapping[str, int], used: Mapping[str, int]
    ) -> None:
        """With a change, remove `count` rows, from the row `first` on, of the `used` ones of some axes.

        Later rows move up and the freed rows are zero.
        """
        self.row_changes.cut(change, first, count, used)

    @property
    def row_changes(self) -> RowChanges:
        """Changes of rows of all arrays at once."""
        if self._row_changes is None:
            self._row_changes = RowChanges(self.row_fields, self.row_numbers)
        return self._row_changes

    @property
    def row_fields(self) -> list[RowsOfAxis]:
        """All arrays."""
        return [
            RowsOfAxis(field.axis, self._memory[name], field.per_world, self._address(name))
            for name, field in self._fields.items()
        ]

    @property
    def row_numbers(self) -> list[RowNumbers]:
        """The fields that contain row numbers."""
        return [
            RowNumbers(self.field_of(name).axis, target, self.numpy[name])
            for name, target in self._references.items()
        ]

    def _rows_along(self, axis: str) -> list[np.ndarray]:
        """All arrays of an axis, with their row axis first."""
        found = self._by_axis.get(axis)
        if found is None:
            found = [self._rows(name) for name, field in self._fields.items() if field.axis == axis]
            self._by_axis[axis] = found
        return found

    def clear_beyond(self, used: Mapping[str, int]) -> None:
        """Set all rows of the named axes to zero, except the first `used` ones."""
        for axis, count in used.items():
            for rows in self._rows_along(axis):
                rows[count:].fill(0)

    def _rows(self, name: str) -> np.ndarray:
        """The array of a field, with its row axis first."""
        array = self._memory[name]
        return array.swapaxes(0, 1) if self._fields[name].per_world else array

    def struct(self) -> Any:
        """A C struct whose fields are views of these arrays: the same object until arrays are replaced."""
        if self._made is None:
            self._made = self._make_struct()
        return self._made

    def _make_struct(self) -> Any:
        shown = self._shown()
        # All fields are arrays, so the struct is their views, one after the other.
        struct = self._struct.from_buffer_copy(
            b"".join([self._view(name, shown[name]) for name in fields_of(self._struct)])
        )
        # The views do not keep the arrays alive.
        struct.memory = shown
        return struct

    def _view(self, name: str, array: np.ndarray) -> bytes:
        """The `ArrayView` of a field, made once for an array."""
        known = self._views.get(name)
        if known is not None and known[0] is array:
            return known[1]
        source = self._entry_views.get(name, name)
        view = _PACK_ADDRESS(self._address(source)) + _shape_of_view(
            array.shape, array.strides, self._fields[source].per_world
        )
        self._views[name] = array, view
        return view

    def _address(self, name: str) -> int:
        """Address of a field's array."""
        array, known = self._memory[name], self._addresses.get(name)
        if known is not None and known[0] is array:
            return known[1]
        address = address_of(array)
        self._addresses[name] = array, address
        return address

    def _shown(self) -> dict[str, np.ndarray]:
        """The arrays of all fields, including `entry_views`, which show others scalar by scalar."""
        shown = {**self._memory}
        for name, source in self._entry_views.items():
            array = self._memory[source]
            shown[name] = array.reshape(*array.shape[:-2], -1)
        return shown

    def written(self, name: str) -> None:
        """Make writes to an array, by its name in `numpy`, visible to kernels; here they already are."""

    def clear(self) -> None:
        """Set every entry to zero."""
        for array in self.numpy.values():
            array.fill(0)


def _by_part(arrays: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The arrays by the names that `ArrayTable.numpy` has for them."""
    shown: dict[str, np.ndarray] = {}
    for name, array in arrays.items():
        if array.dtype.names is None:
            shown[name] = array
        for part in array.dtype.names or ():
            shown[f"{name}_{part}"] = array[part]
    return shown


def _repeated(rows: np.ndarray, count: int) -> np.ndarray:
    """The same rows `count` times. If all are zero, the memory is not written to and takes no space."""
    array = zeros((count, *rows.shape), rows.dtype)
    if rows.dtype.names is not None or rows.any():
        array[:] = rows
    return array
