"""Fine launches on the CPU, of kernels that are compiled as those of the native library are."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import carom
from carom.gpu.device import Device
from carom.native.building.library import build
from carom.native.digest import source_digest
from carom.native.kernel_modules import PARALLEL_MODULES
from carom.native.kernels import Kernel
from carom.native.launch import Launch
from carom.native.library import Library, library
from carom.native.tables import array_view
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
    """The CPU."""

    def zeros(self, struct: Any, shapes: Mapping[str, Sequence[int]]) -> Any:
        made = struct()
        made.memory = []
        for name, shape in shapes.items():
            entry = struct.fields[name].entry
            inner = getattr(entry, "shape", ())
            dtype = entry.scalar if hasattr(entry, "scalar") else np.dtype(entry)
            array = np.zeros((*shape, *inner), dtype)
            made.memory.append(array)
            view = array_view(array, len(shape))
            # Rows are of worlds or of workers here: each has its own, even if there is only one.
            view.strides[0] = array.strides[0]
            setattr(made, name, view)
        return made

    def launch(
        self,
        module: str,
        kernel: str,
        dim: Sequence[int],
        structs: Mapping[str, Any],
        scalars: Mapping[str, int],
    ) -> Callable[[], None]:
        find = parallel_library if module.startswith("parallel") else library
        found = Kernel(kernel, find)
        arguments = [scalars[name] if name in scalars else structs[name] for name in found.indices]
        return Launch(found, tuple(dim), arguments)
