"""Flat arrays that grow: the memory behind `Model`, `State` and `Scratch`.

An `ArrayTable` owns one NumPy array per field. Arrays of the same axis (links, coordinates...)
grow together and geometrically, so that adding bodies one by one costs linear time; a Warp struct
is filled with views of the same memory.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, cast

import numpy as np
import warp as wp

_FIRST_CAPACITY = 16


def numbers_of(numbers: np.ndarray) -> memoryview[float]:
    """The memory of an array of numbers: quicker than NumPy for single ones."""
    return cast("memoryview[float]", numbers.data)


@dataclass(frozen=True, slots=True)
class Field:
    """One array of a table.

    Attributes:
        axis: Name of the axis its rows belong to.
        dtype: Warp type of one entry.
        shape: Shape of one entry; () for a scalar or a struct.
        scalar: NumPy type of the scalars, or of the struct.
    """

    axis: str
    dtype: Any
    shape: tuple[int, ...]
    scalar: np.dtype[Any]


@cache
def fields_of(struct: Any) -> Mapping[str, Field]:
    """The array fields of a Warp struct; a field's axis is the first word of its name."""
    fields = {}
    for name, annotation in struct.cls.__annotations__.items():
        dtype = annotation.dtype
        if hasattr(dtype, "numpy_dtype"):
            shape, scalar = (), np.dtype(dtype.numpy_dtype())
        else:
            shape = tuple(getattr(dtype, "_shape_", ()))
            scalar = np.dtype(wp.dtype_to_numpy(getattr(dtype, "_wp_scalar_type_", dtype)))
        fields[name] = Field(name.partition("_")[0], dtype, shape, scalar)
    return fields


class ArrayTable:
    """Arrays by name, grouped by axis, with an optional leading world axis.

    Attributes:
        numpy: The arrays by the names of their fields. An array of structs is there as one array for
            each of their fields, named after both: `link_mass` is the field `mass` of `link`.
        capacity: Rows there are, by axis.
    """

    def __init__(
        self, struct: Any, world_count: int | None, entry_views: Mapping[str, str] | None = None
    ) -> None:
        """Make the arrays with the least capacity.

        Args:
            struct: Warp struct class whose fields are all arrays.
            world_count: Length of the leading world axis; None for arrays shared by all worlds.
            entry_views: Fields that show the vectors of another field scalar by scalar.
        """
        self._struct = struct
        self._entry_views = dict(entry_views or {})
        self._fields = {
            name: field for name, field in fields_of(struct).items() if name not in self._entry_views
        }
        self._world_count = world_count
        self.capacity: dict[str, int] = {field.axis: _FIRST_CAPACITY for field in self._fields.values()}
        self._memory: dict[str, np.ndarray] = {}
        self.numpy: dict[str, np.ndarray] = {}
        self._made: dict[str, Any] = {}
        self._bytes: dict[str, memoryview[int]] = {}
        for name in self._fields:
            self._replace(name, self._allocate(name))

    def _allocate(self, name: str) -> np.ndarray:
        field = self._fields[name]
        shape: tuple[int, ...] = (self.capacity[field.axis],)
        if self._world_count is not None:
            shape = (self._world_count, *shape)
        return np.zeros((*shape, *field.shape), dtype=field.scalar)

    def _replace(self, name: str, array: np.ndarray) -> None:
        self._memory[name] = array
        self._made.clear()
        self._bytes.pop(name, None)
        if array.dtype.names is None:
            self.numpy[name] = array
        for part in array.dtype.names or ():
            self.numpy[f"{name}_{part}"] = array[part]

    def bytes_of(self, name: str) -> memoryview[int]:
        """The memory of a field, for reading a few rows at less cost than NumPy has for one."""
        memory = self._bytes.get(name)
        if memory is None:
            array: Any = self._memory[name]
            memory = self._bytes[name] = memoryview(array).cast("B")
        return memory

    def reserve(self, needed: Mapping[str, int]) -> bool:
        """Make room for `needed` rows on each axis; true if arrays were replaced."""
        grown = set()
        for axis, count in needed.items():
            if axis not in self.capacity or count <= self.capacity[axis]:
                continue
            self.capacity[axis] = max(count, 2 * self.capacity[axis])
            grown.add(axis)
        for name, field in self._fields.items():
            if field.axis in grown:
                old = self._memory[name]
                new = self._allocate(name)
                if self._world_count is None:
                    new[: len(old)] = old
                else:
                    new[:, : old.shape[1]] = old
                self._replace(name, new)
        return bool(grown)

    def delete(self, axis: str, start: int, count: int, used: int) -> None:
        """Remove `count` of the `used` rows of an axis; later ones move up and the freed ones are zero."""
        after = start + count
        for name, field in self._fields.items():
            if field.axis == axis:
                array = self._memory[name]
                rows = array if self._world_count is None else array.swapaxes(0, 1)
                if after < used:
                    rows[start : used - count] = rows[after:used]
                rows[used - count : used].fill(0)

    def struct(self, device: str) -> Any:
        """A Warp struct whose fields are views of these arrays: the same one until some are replaced."""
        if device not in self._made:
            self._made[device] = self._make_struct(device)
        return self._made[device]

    def _make_struct(self, device: str) -> Any:
        struct = self._struct()
        for name, field in self._fields.items():
            setattr(struct, name, wp.array(self._memory[name], dtype=field.dtype, device=device, copy=False))
        for name, source in self._entry_views.items():
            array = self._memory[source]
            entries = array.reshape(*array.shape[:-2], -1)
            dtype = fields_of(self._struct)[name].dtype
            setattr(struct, name, wp.array(entries, dtype=dtype, device=device, copy=False))
        return struct

    def clear(self) -> None:
        """Set every entry to zero."""
        for array in self.numpy.values():
            array.fill(0)
