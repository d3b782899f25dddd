"""Repeated launches of a query kernel, with any number of items."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from carom.native.kernels import Kernel
from carom.native.launch import KernelStructs, Launch
from carom.native.tables import ArrayTable
from carom.native.uninterrupted import uninterrupted

# Up to this many items a kernel runs with the GIL held: releasing it would take longer than the kernel.
_FEW = 64


class Question:
    """A launch of a query kernel over arrays of its own, which grow as needed.

    The kernel takes these arrays as one of its structs, and the number of rows in use as `count`.

    Attributes:
        arrays: The arrays; all have one axis.
        room: Number of rows of the arrays.
        launch: The launch over the arrays.

    Args:
        kernel: The kernel.
        structs: Structs by the names of kernel arguments; the struct of the arrays is added.
        name: Name of the kernel argument that takes the arrays.
        arrays: The arrays.
        asked: Scalar arguments that may differ between calls, with their initial values.
        **fixed: The other scalar arguments.
    """

    def __init__(
        self,
        kernel: Kernel,
        structs: KernelStructs,
        name: str,
        arrays: ArrayTable,
        asked: dict[str, Any],
        **fixed: int,
    ) -> None:
        self.arrays = arrays
        self._kernel = kernel
        self._structs = structs
        self._name = name
        self._scalars = {"count": 0, **asked, **fixed}
        indices = kernel.indices
        self._places = [indices[scalar] for scalar in ("count", *asked)]
        self._prepare()

    def reserve(self, count: int, see: Callable[[], None]) -> None:
        """Replace the arrays by longer ones, which have room for `count` rows.

        Then `see` is called: whoever keeps views of them takes new ones.
        """
        with uninterrupted:
            self.arrays.reserve(dict.fromkeys(self.arrays.capacity, count))
            self._prepare()
            see()

    def __call__(self, *asked: float) -> None:
        """Run the kernel with these scalar arguments: the count, then those of `asked`."""
        for place, value in zip(self._places, asked, strict=True):
            self.launch.replace(place, value)
        (self._run_briefly if asked[0] <= _FEW else self._run)()

    def _prepare(self) -> None:
        (self.room,) = self.arrays.capacity.values()
        self._structs[self._name] = self.arrays.struct()
        self.launch: Launch = self._structs.launch(self._kernel, **self._scalars)
        self._run: Callable[[], None] = self.launch.function
        self._run_briefly: Callable[[], None] = self.launch.brief_function
