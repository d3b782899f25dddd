"""What a step in fine launches is performed on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import Any, Protocol

import warp as wp

from carom.kernels.warp_types import warp_type

BLOCK_SIZE = 64
"""Threads of a block. The solver's kernels take 255 registers a thread, of which a multiprocessor has enough
for 256 threads: in smaller blocks they are shared out more evenly."""


class Device(Protocol):
    """Where arrays are and kernels run."""

    def zeros(self, struct: Any, shapes: Mapping[str, Sequence[int]]) -> Any:
        """A struct of arrays of zeros.

        Args:
            struct: The struct, as declared in `carom.layouts`.
            shapes: Shape of the array of each field.
        """
        ...

    def launch(
        self,
        module: str,
        kernel: str,
        dim: Sequence[int],
        structs: Mapping[str, Any],
        scalars: Mapping[str, int],
    ) -> Callable[[], None]:
        """A kernel with its arguments, ready to run.

        Args:
            module: The module in `carom.kernels` that it is in.
            kernel: Its name.
            dim: How many times it runs, along one or two axes.
            structs: Structs by the names that kernels give them.
            scalars: Numbers by these names.
        """
        ...


class WarpDevice(Device):
    """A device that Warp runs kernels on.

    Args:
        name: Warp's name of it: "cuda:0".

    Attributes:
        name: The same.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    def zeros(self, struct: Any, shapes: Mapping[str, Sequence[int]]) -> Any:  # noqa: D102
        made = warp_type(struct)()
        for field, shape in shapes.items():
            dtype = warp_type(struct.fields[field].entry)
            setattr(made, field, wp.zeros(tuple(shape), dtype=dtype, device=self.name))
        return made

    def launch(  # noqa: D102
        self,
        module: str,
        kernel: str,
        dim: Sequence[int],
        structs: Mapping[str, Any],
        scalars: Mapping[str, int],
    ) -> Callable[[], None]:
        function: Any = getattr(import_module(f"carom.kernels.{module}"), kernel)
        names = [argument.label for argument in function.adj.args]
        command: Any = wp.launch(
            function,
            dim=tuple(dim),
            inputs=[scalars[name] if name in scalars else structs[name] for name in names],
            device=self.name,
            record_cmd=True,
            block_dim=BLOCK_SIZE,
        )
        return command.launch

    def capture(self, launches: Callable[[], None]) -> Callable[[], None]:
        """Launches as one CUDA graph."""
        with wp.ScopedCapture(device=self.name) as capture:
            launches()
        graph: Any = capture.graph
        return lambda: wp.capture_launch(graph)
