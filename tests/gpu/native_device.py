"""Fine launches on the CPU, of kernels that are compiled as those of the native library are."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import carom
from carom.gpu.device import Device, FineLaunch
from carom.native.building.library import build
from carom.native.digest import source_digest
from carom.native.kernel_modules import PARALLEL_MODULES
from carom.native.kernels import Kernel
from carom.native.launch import Launch
from carom.native.library import Library, library
from carom.native.tables import array_view, fields_of
from carom.native.targets import this_target


@functools.cache
def parallel_library() -> Library:
    """The kernels that are for GPUs only, for the CPU."""
    root = Path(carom.__file__).parents[1]
    # Those that are also in the main library have to be of the same level.
    level = Path(library().path).stem.rpartition("-")[2]
    path = build(root, this_target(), level, None, modules=PARALLEL_MODULES)
    return Library(path, source_digest(root))


class NativeDevice(Device):
    """The CPU: NumPy's arrays, and the native library's kernels. It has the bits of a step of one world.

    Attributes:
        room: Bytes there are; None for as many as asked for.
        captured: How many sequences of launches have been captured.
    """

    name = "native"

    def __init__(self, room: int | None = None) -> None:
        self.room = room
        self.captured = 0

    def zeros(self, shape: Sequence[int], dtype: np.dtype[Any]) -> np.ndarray:
        return np.zeros(shape, dtype)

    def struct(self, declared: Any, arrays: Mapping[str, np.ndarray]) -> Any:
        made = declared()
        for name, array in arrays.items():
            setattr(made, name, array_view(array, 2 if fields_of(declared)[name].per_world else 1))
        made.memory = dict(arrays)
        return made

    def numbers(self, struct: Any) -> Any:
        return struct

    def take(self, value: Any) -> Any:
        return value

    def launch(
        self,
        module: str,
        kernel: str,
        dim: Sequence[int],
        structs: Mapping[str, Any],
        scalars: Mapping[str, float],
    ) -> FineLaunch:
        found = Kernel(kernel, parallel_library if module.startswith("parallel") else library)
        return _NativeLaunch(found, dim, [scalars.get(name, structs.get(name)) for name in found.indices])

    def capture(self, launches: Callable[[], None]) -> Callable[[], None]:
        self.captured += 1
        return launches

    def free_memory(self) -> int | None:
        return self.room


class _NativeLaunch(FineLaunch):
    def __init__(self, kernel: Kernel, dim: Sequence[int], arguments: Sequence[Any]) -> None:
        self._indices = kernel.indices
        self._launch = Launch(kernel, tuple(dim), arguments)

    def __call__(self) -> None:
        self._launch()

    def replace(self, name: str, value: int) -> None:
        if name in self._indices:
            self._launch.replace(self._indices[name], value)
