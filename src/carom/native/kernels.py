"""The kernels of the native library, by name: `from carom.native.kernels import step_kernel`.

Kernels are written in `carom.kernels`, which code on the host never imports. A name stands for the compiled
function; a name without a function raises an error only when it is first used.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

from carom.native.library import Library, library

_SCALARS: Mapping[str, Any] = {"int32": ctypes.c_int32, "float64": ctypes.c_double}


class Kernel:
    """A compiled kernel: a C function that takes two addresses, those of its bounds and of its arguments."""

    def __init__(self, name: str, find_library: Callable[[], Library] = library) -> None:
        self.name = name
        self._find_library = find_library

    def __repr__(self) -> str:
        return f"Kernel({self.name!r})"

    @cached_property
    def indices(self) -> Mapping[str, int]:
        """Index of each argument, by name."""
        return {name: index for index, (name, _) in enumerate(self._find_library().arguments(self.name))}

    @cached_property
    def scalars(self) -> Mapping[int, Any]:
        """C types of the arguments that are numbers, by index."""
        arguments = self._find_library().arguments(self.name)
        return {index: _SCALARS[kind] for index, (_, kind) in enumerate(arguments) if kind in _SCALARS}

    @cached_property
    def function(self) -> Any:
        """The function; calls release the GIL, so that other threads run meanwhile."""
        return self._find_library().function(self.name)

    @cached_property
    def brief_function(self) -> Any:
        """The function, called with the GIL held: for kernels that take less time than releasing it."""
        return ctypes.PYFUNCTYPE(None)(self.address)

    @cached_property
    def address(self) -> int:
        """Address of the function."""
        return ctypes.cast(self.function, ctypes.c_void_p).value or 0


_made: dict[str, Kernel] = {}


def __getattr__(name: str) -> Kernel:
    if not name.endswith("_kernel"):
        raise AttributeError(name)
    return _made.setdefault(name, Kernel(name))
