"""Replaying a kernel launch at the least cost.

`wp.launch` costs tens of microseconds in Python and even a recorded launch about four. On CPU a
recorded launch is in the end one C call with two pointers, so that call is kept and made directly.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import warp as wp

_NOTICE_AFTER_SECONDS = 1.5
# Kernels that are compiled and loaded.
_launched_before: set[Any] = set()


class Launch:
    """A kernel with its arguments, ready to run again and again.

    Arrays are kept alive, scalars and structs are copied; `replace` changes a scalar argument.
    On CPU calling it returns when the kernel is done.

    Attributes:
        kernel: The kernel.
    """

    __slots__ = ("_bounds", "_command", "_entry_point", "_keep_alive", "_packed", "_pointer", "kernel")

    def __init__(self, kernel: Any, count: int, arguments: Sequence[Any], device: str = "cpu") -> None:
        """Compile or load `kernel` if need be and pack its arguments.

        Args:
            kernel: The kernel.
            count: Number of threads; for the engine's kernels one per world.
            arguments: Its arguments.
            device: Warp device name.
        """
        with contextlib.nullcontext() if kernel in _launched_before else CompilationNotice():
            self._command: Any = wp.launch(
                kernel, dim=count, inputs=list(arguments), device=device, record_cmd=True
            )
        _launched_before.add(kernel)
        self.kernel = kernel
        self._keep_alive = list(arguments)
        self._entry_point = None
        if self._command.device.is_cpu and self._command.block_dim <= 1:
            values = self._command.params[1:]
            fields = [(f"p{i}", type(value)) for i, value in enumerate(values)]
            self._packed = type("PackedArguments", (ctypes.Structure,), {"_fields_": fields})(*values)
            self._entry_point = self._command.hooks.forward
            self._bounds = ctypes.byref(self._command.params[0])
            self._pointer = ctypes.byref(self._packed)

    def __call__(self) -> None:
        """Run the kernel."""
        if self._entry_point is None:
            self._command.launch()
        else:
            self._entry_point(self._bounds, self._pointer)

    def replace(self, index: int, value: float) -> None:
        """Change a scalar argument for all later runs."""
        if self._entry_point is None:
            self._command.set_param_at_index(index, value)
        else:
            setattr(self._packed, f"p{index}", value)

    def replace_struct(self, index: int, struct: Any) -> None:
        """Change a struct argument for all later runs."""
        self._keep_alive[index] = struct
        if self._entry_point is None:
            self._command.set_param_at_index(index, struct)
        else:
            setattr(self._packed, f"p{index}", struct.__ctype__())

    def addresses(self, *scalars: str) -> list[int]:
        """What another native function needs to run the kernel on the CPU, as long as this launch is kept.

        Args:
            *scalars: Names of the scalar arguments that it will change.

        Returns:
            Addresses of the function, of its two arguments, and of these scalars; 0 where there is no such
            argument.
        """
        if self._entry_point is None:
            raise ValueError("a launch on a GPU has no addresses")
        entry: Any = ctypes.cast(self._entry_point, ctypes.c_void_p).value
        packed = ctypes.addressof(self._packed)
        indices, fields = argument_indices(self.kernel), type(self._packed)
        places = [
            packed + getattr(fields, f"p{indices[name]}").offset if name in indices else 0 for name in scalars
        ]
        return [entry, ctypes.addressof(self._command.params[0]), packed, *places]

    @property
    def function(self) -> Callable[[], None]:
        """The run as a plain function with the least overhead."""
        if self._entry_point is None:
            return self._command.launch
        return functools.partial(self._entry_point, self._bounds, self._pointer)

    @property
    def brief_function(self) -> Callable[[], None]:
        """The same for kernels that take less time than giving other threads a turn meanwhile."""
        if self._entry_point is None:
            return self._command.launch
        address: Any = ctypes.cast(self._entry_point, ctypes.c_void_p).value
        return functools.partial(ctypes.PYFUNCTYPE(None)(address), self._bounds, self._pointer)


class TreeLaunch:
    """A kernel one of whose arguments is a tree, ready to run on any: for what is over in a microsecond.

    Args:
        kernel: The kernel.
        structs: Structs by the name kernels give them.
        device: Warp device name.
    """

    __slots__ = ("_launch", "_place", "_run", "_tree")

    def __init__(self, kernel: Any, structs: KernelStructs, device: str) -> None:
        self._launch = structs.launch(kernel, device, tree=0, first_world=0)
        self._run = self._launch.brief_function
        self._place = argument_indices(kernel)["tree"]
        self._tree = 0

    def __call__(self, tree: int) -> None:
        """Run the kernel on a tree."""
        if tree != self._tree:
            self._launch.replace(self._place, tree)
            self._tree = tree
        self._run()


@functools.cache
def argument_indices(kernel: Any) -> Mapping[str, int]:
    """Place of each argument of a kernel, by name."""
    return {argument.label: index for index, argument in enumerate(kernel.adj.args)}


class KernelStructs(dict[str, Any]):
    """Structs by the names kernels give them.

    It remembers the last launch of each kernel over them, for each choice of its scalars. Making one takes
    a hundred times as long as running it, and most of what a world's users do between two steps leaves its
    arrays where they are.
    """

    def __init__(self, **structs: Any) -> None:
        super().__init__(structs)
        self._launches: dict[Any, tuple[dict[str, Any], Launch]] = {}

    def launch(self, kernel: Any, device: str, **scalars: float) -> Launch:
        """A launch of a kernel with these structs and scalars.

        Those made before of the same kernel and scalars become this one, or may keep arguments of the past.
        """
        indices = argument_indices(kernel)
        arguments = {name: scalars[name] if name in scalars else self[name] for name in indices}
        key = kernel, *scalars.items()
        before, made = self._launches.get(key) or ({}, None)
        if made is None:
            made = Launch(kernel, 1, list(arguments.values()), device)
        else:
            for name, argument in arguments.items():
                if name in scalars:
                    made.replace(indices[name], argument)
                elif argument is not before[name]:
                    made.replace_struct(indices[name], argument)
        self._launches[key] = arguments, made
        return made

    def changed(self, name: str) -> None:
        """Let the launches made before know that fields of a struct have other values now."""
        struct = self.get(name)
        for (kernel, *_), (arguments, made) in self._launches.items():
            if arguments.get(name) is struct:
                made.replace_struct(argument_indices(kernel)[name], struct)


def launch(kernel: Any, structs: KernelStructs, device: str, **scalars: float) -> Launch:
    """A launch of a kernel whose arguments are found by their names."""
    return structs.launch(kernel, device, **scalars)


class CompilationNotice:
    """Tells the user what is going on when a first use compiles kernels, and that it happens once."""

    def __init__(self) -> None:
        self._timer = threading.Timer(_NOTICE_AFTER_SECONDS, self._announce)
        self._timer.daemon = True
        self._announced = False
        self._started = 0.0

    def __enter__(self) -> None:
        self._started = time.perf_counter()
        self._timer.start()

    def __exit__(self, *_exception: object) -> None:
        self._timer.cancel()
        if self._announced:
            elapsed = time.perf_counter() - self._started
            print(f"carom: kernels compiled in {elapsed:.0f} s.", file=sys.stderr, flush=True)

    def _announce(self) -> None:
        self._announced = True
        print(
            "carom: compiling the physics kernels for this machine (about half a minute, once; "
            "the result is cached) ...",
            file=sys.stderr,
            flush=True,
        )
