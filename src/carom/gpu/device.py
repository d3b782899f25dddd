"""Interface of the devices that hold many worlds and step them in fine launches."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

# Module in `carom.kernels` of each kernel that is launched with one thread per world; CPUs use them, too.
MODULES = {
    "forward_kinematics_kernel": "dynamics.kinematics",
    "link_poses_kernel": "dynamics.kinematics",
    "link_twist_kernel": "dynamics.kinematics",
    "nearest_pair_kernel": "queries.closest",
    "prepare_rays_kernel": "queries.rays",
    "rays_kernel": "queries.rays",
    "sensors_kernel": "sensors.reading",
    "settle_loads_kernel": "sensors.last_loads",
    "touching_kernel": "queries.touching",
}


class FineLaunch(Protocol):
    """A kernel with its arguments, which can be run many times."""

    def __call__(self) -> None:
        """Run the kernel; the call may return before the kernel has finished."""
        ...

    def replace(self, name: str, value: int) -> None:
        """Change a scalar argument, if the kernel has it, for all later runs."""
        ...


class Device(Protocol):
    """A device that holds arrays and runs kernels.

    Its arrays are NumPy arrays, or have the interface of `carom.gpu.array.DeviceArray`.

    Attributes:
        name: Name of the device in messages.
    """

    name: str

    def zeros(self, shape: Sequence[int], dtype: np.dtype[Any]) -> Any:
        """An array of zeros; raises `MemoryError` if the device has not enough free memory."""
        ...

    def struct(self, declared: Any, arrays: Mapping[str, Any]) -> Any:
        """A kernel argument: a struct declared in `carom.layouts`, of the arrays of its fields on the device.

        If the world axis of an array has only one row, all worlds share this row.
        """
        ...

    def numbers(self, struct: Any) -> Any:
        """A kernel argument: a copy of a struct of scalars declared in `carom.layouts`."""
        ...

    def take(self, value: Any) -> Any:
        """A user's value: as a device array if its memory is on the device already, otherwise unchanged."""
        ...

    def launch(
        self,
        module: str,
        kernel: str,
        dim: Sequence[int],
        structs: Mapping[str, Any],
        scalars: Mapping[str, float],
    ) -> FineLaunch:
        """A kernel in a module of `carom.kernels` with its arguments by name, ready to run.

        `dim` is the number of threads, along one or two axes.
        """
        ...

    def capture(self, launches: Callable[[], None]) -> Callable[[], None]:
        """Capture a sequence of launches, to be run by one call.

        A device that cannot capture launches runs them one by one, in the same order.
        """
        ...

    def free_memory(self) -> int | None:
        """Bytes that can still be allocated; None if unknown."""
        ...
