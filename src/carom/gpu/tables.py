"""Tables whose arrays are on a device."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from carom.gpu.device import Device
from carom.native.tables import ArrayTable, fields_of


class DeviceTable(ArrayTable):
    """A table whose arrays are on a device only.

    `numpy` has the arrays by name, as in any table; writing to them changes the memory on the device. Arrays
    get exactly the requested length, without room to grow, because every world has each row. Those of a table
    that `lasts` keep their contents when they grow.
    """

    _in_one_block = False

    def __init__(
        self,
        device: Device,
        struct: Any,
        world_count: int = 1,
        entry_views: Mapping[str, str] | None = None,
        *,
        lasts: bool = True,
    ) -> None:
        self._device = device
        self._lasts = lasts
        super().__init__(struct, world_count, entry_views, first_capacity=1)

    @classmethod
    def repeated(
        cls, device: Device, table: ArrayTable, struct: Any, world_count: int, rows: Mapping[str, int]
    ) -> DeviceTable:
        """A table of `world_count` copies of the first world of another table; `rows` to keep are by axis."""
        other = cls(device, struct, world_count)
        other.reserve({axis: max(1, count) for axis, count in rows.items()}, growth=1.0)
        for name, array in other.numpy.items():
            # Every world gets the rows of the first world of `table`.
            array[...] = np.asarray(table.numpy[name])[:1, : array.shape[1]]
        return other

    def reserve(self, needed: Mapping[str, int], growth: float = 1.0) -> bool:  # noqa: D102
        return super().reserve(needed, growth)

    def _new_array(self, shape: tuple[int, ...], dtype: np.dtype[Any]) -> Any:
        return self._device.zeros(shape, dtype)

    def _lengthened(self, name: str, capacity: int) -> Any:
        return super()._lengthened(name, capacity) if self._lasts else self._allocate(name, capacity)

    def _make_struct(self) -> Any:
        return self._device.struct(self._struct, self._shown())


class MirroredTable(ArrayTable):
    """A table on the host that takes over the arrays of another, with a copy on a device for the kernels.

    After an array on the host has been changed, `written` has to be called.
    """

    def __init__(self, device: Device, table: ArrayTable) -> None:
        self.__dict__.update(table.__dict__)
        self._made = None
        self._device = device
        self._mirrors: dict[str, Any] = {}

    def written(self, name: str) -> None:  # noqa: D102
        field = self.whole_of(name)
        mirror, array = self._mirrors.get(field), self._memory[field]
        if mirror is not None and mirror.shape == array.shape:
            mirror[...] = array

    def _make_struct(self) -> Any:
        for name, array in self._memory.items():
            mirror = self._mirrors.get(name)
            if mirror is None or mirror.shape != array.shape:
                self._mirrors[name] = mirror = self._device.zeros(array.shape, array.dtype)
            mirror[...] = array
        return self._device.struct(self._struct, self._mirrors)


def struct_of_zeros(device: Device, declared: Any, shapes: Mapping[str, tuple[int, ...]]) -> dict[str, Any]:
    """Arrays of zeros for the fields of a struct, of these shapes without the shape of an entry."""
    fields = fields_of(declared)
    return {
        name: device.zeros((*shape, *fields[name].shape), fields[name].scalar)
        for name, shape in shapes.items()
    }
