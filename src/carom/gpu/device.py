"""What many worlds are kept on and stepped on in fine launches."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

# The module in `carom.kernels` that has each kernel that is launched over worlds, on the processor as well.
MODULES = {
    "forward_kinematics_kernel": "dynamics.kinematics",
    "link_poses_kernel": "dynamics.kinematics",
    "link_twist_kernel": "dynamics.kinematics",
    "prepare_rays_kernel": "queries.rays",
    "rays_kernel": "queries.rays",
    "touching_kernel": "queries.touching",
}


class FineLaunch(Protocol):
    """A kernel with its arguments, ready to run many times over."""

    def __call__(self) -> None:
        """Run the kernel; this may return before it is done."""
        ...

    def replace(self, name: str, value: int) -> None:
        """Change an argument that is a number, if the kernel has it, for all later runs."""
        ...


class Device(Protocol):
    """Where arrays are and kernels run.

    Arrays are NumPy's, or can be used like them as far as `carom.gpu.array.DeviceArray` says.

    Attributes:
        name: Its name for users.
    """

    name: str

    def zeros(self, shape: Sequence[int], dtype: np.dtype[Any]) -> Any:
        """An array of zeros.

        Raises:
            MemoryError: There is no room for it.
        """
        ...

    def struct(self, declared: Any, arrays: Mapping[str, Any]) -> Any:
        """A struct for kernels, of arrays on the device.

        Args:
            declared: The struct, as declared in `carom.layouts`.
            arrays: The array of each field. Where a world axis has one row, all worlds are shown it.
        """
        ...

    def numbers(self, struct: Any) -> Any:
        """A struct of numbers for kernels, from one of `carom.layouts`."""
        ...

    def take(self, value: Any) -> Any:
        """A user's value: as an array on the device if it is there already, otherwise unchanged."""
        ...

    def launch(
        self,
        module: str,
        kernel: str,
        dim: Sequence[int],
        structs: Mapping[str, Any],
        scalars: Mapping[str, float],
    ) -> FineLaunch:
        """A kernel with its arguments, ready to run.

        Args:
            module: The module in `carom.kernels` that it is in.
            kernel: Its name.
            dim: Number of threads, along one or two axes.
            structs: Structs by the names that kernels give them.
            scalars: Numbers by these names.
        """
        ...

    def capture(self, launches: Callable[[], None]) -> Callable[[], None]:
        """A captured sequence of launches, to be run as one.

        What cannot be captured is launched one by one, in the same order.
        """
        ...

    def free_memory(self) -> int | None:
        """Bytes that can still be had; None where that is not known."""
        ...
