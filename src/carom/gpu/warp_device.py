"""Devices on which Warp runs the kernels."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from math import prod
from typing import Any

import numpy as np
import warp as wp

# This import registers NumPy functions for arrays on a device.
import carom.gpu.arithmetic  # noqa: F401
from carom.gpu.array import BLOCK_SIZE, DeviceArray
from carom.gpu.device import Device, FineLaunch
from carom.kernels.warp_start import start_warp
from carom.kernels.warp_types import warp_type
from carom.layouts.types import ArrayType

# DLPack's codes of devices whose memory the CPU can access.
_HOST_DEVICES = (1, 3)
_GIGABYTE = 1e9

start_warp()


def cuda_devices() -> list[str]:
    """Warp's names of the available GPUs."""
    return [device.alias for device in wp.get_cuda_devices()]


class WarpDevice(Device):
    """A device, by its name such as "cuda:0", on which Warp runs the kernels."""

    def __init__(self, name: str) -> None:
        self._device: Any = wp.get_device(name)
        self.name = str(self._device.alias)

    def zeros(self, shape: Sequence[int], dtype: np.dtype[Any]) -> DeviceArray:  # noqa: D102
        size, free = prod(shape) * dtype.itemsize, self.free_memory()
        if free is not None and size > free:
            raise MemoryError(
                f"an array of {size / _GIGABYTE:.1f} GB does not fit on {self.name}: "
                f"{free / _GIGABYTE:.1f} GB are free"
            )
        return DeviceArray.zeros(shape, dtype, self.name)

    def struct(self, declared: Any, arrays: Mapping[str, DeviceArray]) -> Any:  # noqa: D102
        made = warp_type(declared)()
        for name, array in arrays.items():
            setattr(made, name, self._argument(declared.fields[name], array))
        return made

    def numbers(self, struct: Any) -> Any:  # noqa: D102
        made = warp_type(type(struct))()
        for name in struct.fields:
            setattr(made, name, getattr(struct, name))
        return made

    def take(self, value: Any) -> Any:  # noqa: D102
        if isinstance(value, DeviceArray):
            return value
        if isinstance(value, wp.array):
            return DeviceArray.of(value) if value.device == self._device else value.numpy()
        if not hasattr(value, "__dlpack_device__") or isinstance(value, np.ndarray | np.generic):
            return value
        here, *_ = value.__dlpack_device__()
        if self._device.is_cpu or int(here) not in _HOST_DEVICES:
            # Tensors that require gradients cannot be exported by DLPack.
            plain = value.detach() if hasattr(value, "detach") else value
            return self.take(wp.from_dlpack(plain))
        return value

    def launch(  # noqa: D102
        self,
        module: str,
        kernel: str,
        dim: Sequence[int],
        structs: Mapping[str, Any],
        scalars: Mapping[str, float],
    ) -> FineLaunch:
        function: Any = getattr(import_module(f"carom.kernels.{module}"), kernel)
        names = [argument.label for argument in function.adj.args]
        arguments = [scalars[name] if name in scalars else structs[name] for name in names]
        command: Any = wp.launch(
            function, dim=tuple(dim), inputs=arguments, device=self._device, record_cmd=True,
            block_dim=BLOCK_SIZE,
        )  # fmt: skip
        return _WarpLaunch(command, names, arguments)

    def capture(self, launches: Callable[[], None]) -> Callable[[], None]:
        """Launches captured as one CUDA graph; on other devices they are returned unchanged."""
        if not self._device.is_cuda:
            return launches
        with wp.ScopedCapture(device=self._device) as capture:
            launches()
        graph: Any = capture.graph
        return lambda: wp.capture_launch(graph)

    def free_memory(self) -> int | None:  # noqa: D102
        return int(self._device.free_memory) if self._device.is_cuda else None

    def _argument(self, declared: ArrayType, array: DeviceArray) -> Any:
        """An array as a kernel argument."""
        axes = declared.ndim
        strides = list(array.strides[:axes])
        if axes == 2 and array.shape[0] == 1:
            # All worlds share the single row.
            strides[0] = 0
        made: Any = wp.array(
            ptr=array.pointer,
            dtype=warp_type(declared.entry),
            shape=array.shape[:axes],
            strides=tuple(strides),
            device=self._device,
        )
        # Keeps the memory alive as long as the argument.
        made.owner = array
        return made


class _WarpLaunch(FineLaunch):
    """A recorded Warp launch; it keeps its arguments alive."""

    def __init__(self, command: Any, names: Sequence[str], arguments: Sequence[Any]) -> None:
        self._run = command.launch
        self._command = command
        self._names = names
        self._arguments = arguments

    def __call__(self) -> None:
        self._run()

    def replace(self, name: str, value: int) -> None:
        if name in self._names:
            self._command.set_param_at_index(self._names.index(name), value)
