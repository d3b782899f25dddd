"""Flat arrays that grow: the memory behind `Model`, `State` and `Scratch`.

An `ArrayTable` owns one NumPy array per field. Arrays of the same axis (links, coordinates...)
grow together and geometrically, so that adding bodies one by one costs linear time; a Warp struct
is filled with views of the same memory.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp

_FIRST_CAPACITY = 16


@dataclass(frozen=True, slots=True)
class Field:
    """One array of a table.

    Attributes:
        axis: Name of the axis its rows belong to.
        dtype: Warp type of one entry.
        shape: Shape of one entry; () for a scalar.
        scalar: NumPy type of the scalars.
    """

    axis: str
    dtype: Any
    shape: tuple[int, ...]
    scalar: type[np.generic]


def fields_of(struct: Any) -> dict[str, Field]:
    """The array fields of a Warp struct; a field's axis is the first word of its name."""
    fields = {}
    for name, annotation in struct.cls.__annotations__.items():
        dtype = annotation.dtype
        shape = tuple(getattr(dtype, "_shape_", ()))
        scalar = wp.dtype_to_numpy(getattr(dtype, "_wp_scalar_type_", dtype))
        fields[name] = Field(name.partition("_")[0], dtype, shape, scalar)
    return fields


class ArrayTable:
    """Arrays by name, grouped by axis, with an optional leading world axis."""

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
        self.capacity = {field.axis: _FIRST_CAPACITY for field in self._fields.values()}
        self.numpy: dict[str, np.ndarray] = {}
        for name in self._fields:
            self.numpy[name] = self._allocate(name)

    def _allocate(self, name: str) -> np.ndarray:
        field = self._fields[name]
        shape: tuple[int, ...] = (self.capacity[field.axis],)
        if self._world_count is not None:
            shape = (self._world_count, *shape)
        return np.zeros((*shape, *field.shape), dtype=field.scalar)

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
                old = self.numpy[name]
                new = self._allocate(name)
                if self._world_count is None:
                    new[: len(old)] = old
                else:
                    new[:, : old.shape[1]] = old
                self.numpy[name] = new
        return bool(grown)

    def delete(self, axis: str, start: int, count: int) -> None:
        """Remove `count` rows of an axis; later rows move up and the freed ones are zero."""
        for name, field in self._fields.items():
            if field.axis == axis:
                array = self.numpy[name]
                rows = array if self._world_count is None else array.swapaxes(0, 1)
                rows[start:-count] = rows[start + count :].copy()
                rows[-count:] = 0

    def struct(self, device: str) -> Any:
        """A Warp struct whose fields are views of these arrays."""
        struct = self._struct()
        for name, field in self._fields.items():
            setattr(struct, name, wp.array(self.numpy[name], dtype=field.dtype, device=device, copy=False))
        for name, source in self._entry_views.items():
            array = self.numpy[source]
            entries = array.reshape(*array.shape[:-2], -1)
            dtype = fields_of(self._struct)[name].dtype
            setattr(struct, name, wp.array(entries, dtype=dtype, device=device, copy=False))
        return struct

    def clear(self) -> None:
        """Set every entry to zero."""
        for array in self.numpy.values():
            array.fill(0)
