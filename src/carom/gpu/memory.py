"""Checking that worlds fit into the free memory of a device, before their arrays are allocated."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import prod
from typing import Any

import numpy as np

from carom.gpu.device import Device, FineLaunch

_GIGABYTE = 1e9


class CountingDevice(Device):
    """A device that counts the bytes of arrays instead of allocating them; it cannot launch anything."""

    name = "counting"

    def __init__(self) -> None:
        self.bytes = 0

    def zeros(self, shape: Sequence[int], dtype: np.dtype[Any]) -> Any:  # noqa: D102
        self.bytes += prod(shape) * dtype.itemsize
        # All entries share the memory of one.
        return np.lib.stride_tricks.as_strided(np.zeros(1, dtype), shape, (0,) * len(shape), writeable=True)

    def struct(self, declared: Any, arrays: Mapping[str, Any]) -> Any:  # noqa: D102
        return declared()

    def numbers(self, struct: Any) -> Any:  # noqa: D102
        return struct

    def take(self, value: Any) -> Any:  # noqa: D102
        return value

    def launch(  # noqa: D102
        self,
        module: str,
        kernel: str,
        dim: Sequence[int],
        structs: Mapping[str, Any],
        scalars: Mapping[str, float],
    ) -> FineLaunch:
        raise RuntimeError(f"{kernel} cannot run where arrays are only counted")

    def capture(self, launches: Callable[[], None]) -> Callable[[], None]:  # noqa: D102
        return launches

    def free_memory(self) -> int | None:  # noqa: D102
        return None


def check_room(device: Device, count: int, make: Callable[[CountingDevice], Any]) -> None:
    """Raise `MemoryError` unless the arrays that `make` makes fit into the free memory of a device."""
    free = device.free_memory()
    if free is None:
        return
    counter = CountingDevice()
    make(counter)
    if counter.bytes > free:
        raise MemoryError(
            f"{count} worlds of {counter.bytes / count / 1000:.1f} kB need "
            f"{counter.bytes / _GIGABYTE:.1f} GB, and {free / _GIGABYTE:.1f} GB are free on {device.name}: "
            f"ask for {int(free * count / counter.bytes)} worlds at most"
        )
