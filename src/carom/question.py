"""A kernel that is asked about a world again and again, with as many items to ask about as there may be."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from carom.model.arrays import ArrayTable
from carom.model.launch import KernelStructs, Launch, argument_indices, launch

# A kernel is done with as many items as this before another thread would have had its turn.
_FEW = 64


class Question:
    """A launch over arrays that belong to the question alone, which grow as needed.

    The kernel takes these arrays as one of its structs, and how many of their rows are in use as `count`.

    Args:
        kernel: The kernel.
        structs: Warp structs by the name kernels give them; that of the arrays is put there.
        table: Name of the arrays among these structs, also of the axis of their rows, and the arrays.
        device: Warp device name.
        **scalars: The other arguments, as they are at first.
    """

    def __init__(
        self, kernel: Any, structs: KernelStructs, table: tuple[str, ArrayTable], device: str, **scalars: Any
    ) -> None:
        self._kernel = kernel
        self._structs = structs
        self._name, self.table = table
        self._device = device
        self._scalars = scalars
        self._index = argument_indices(kernel)
        self._prepare()

    def reserve(self, count: int) -> bool:
        """Make room for `count` rows; true if arrays were replaced."""
        grown = self.table.reserve(dict.fromkeys(self.table.capacity, count))
        if grown:
            self._prepare()
        return grown

    def __call__(self, **scalars: Any) -> None:
        """Run the kernel with other scalars, `count` among them."""
        if scalars != self._asked:
            for name, value in scalars.items():
                self._launch.replace(self._index[name], value)
            self._asked = scalars
        (self._run_briefly if scalars["count"] <= _FEW else self._run)()

    def _prepare(self) -> None:
        self._structs[self._name] = self.table.struct(self._device)
        self._launch: Launch = launch(self._kernel, self._structs, self._device, count=0, **self._scalars)
        self._asked: dict[str, Any] = {}
        self._run: Callable[[], None] = self._launch.function
        self._run_briefly: Callable[[], None] = self._launch.brief_function
