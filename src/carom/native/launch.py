"""Kernels with packed arguments: running one again costs a single C call."""

from __future__ import annotations

import ctypes
import functools
import math
from collections.abc import Callable, Sequence
from typing import Any

from carom.native.change import packed_run
from carom.native.kernels import Kernel


@functools.cache
def _bounds(axes: int) -> Any:
    """The C struct with the number of runs of a kernel along each of so many axes."""
    fields = [
        ("shape", ctypes.c_uint32 * axes),
        ("size", ctypes.c_size_t),
        ("threads_per_item", ctypes.c_size_t),
    ]
    return type("Bounds", (ctypes.Structure,), {"_fields_": fields})


class Launch:
    """A kernel with its packed arguments, which can be run repeatedly.

    Arrays are kept alive, numbers and structs are copied; `replace` changes an argument. A call returns when
    the kernel is done.
    """

    __slots__ = ("_addresses", "_bounds", "_keep_alive", "_packed", "kernel")

    def __init__(self, kernel: Kernel, count: int | tuple[int, ...], arguments: Sequence[Any]) -> None:
        """Pack the arguments of a kernel: numbers, arrays (`carom.native.tables.array_view`) and structs.

        It will run `count` times, or so many times along each axis.

        Raises:
            TypeError: There are too many or too few arguments.
        """
        if len(arguments) != len(kernel.indices):
            raise TypeError(f"{kernel.name} takes {', '.join(kernel.indices)}; {len(arguments)} were given")
        self.kernel = kernel
        self._keep_alive = list(arguments)
        # Arguments are changed in place.
        self._addresses: dict[tuple[str, ...], list[int]] = {}
        counts = count if isinstance(count, tuple) else (count,)
        self._bounds = _bounds(len(counts))(counts, math.prod(counts), 1)
        self._packed: Any = _packed_arguments(
            *(kernel.scalars.get(place) or type(value) for place, value in enumerate(arguments))
        )(*arguments)

    def __call__(self) -> None:
        """Run the kernel."""
        self.kernel.function(ctypes.byref(self._bounds), ctypes.byref(self._packed))

    def replace(self, index: int, value: Any) -> None:
        """Change an argument for all later runs."""
        self._keep_alive[index] = value
        setattr(self._packed, f"p{index}", value)

    def addresses(self, *scalars: str) -> list[int]:
        """The addresses that another native function needs to run the kernel; valid while this launch exists.

        They are those of the function, of its two arguments, and of the named numbers among the arguments,
        which the function will change; 0 where there is no such argument.
        """
        found = self._addresses.get(scalars)
        if found is None:
            packed = ctypes.addressof(self._packed)
            indices, fields = self.kernel.indices, type(self._packed)
            places = [
                packed + getattr(fields, f"p{indices[name]}").offset if name in indices else 0
                for name in scalars
            ]
            found = [self.kernel.address, ctypes.addressof(self._bounds), packed, *places]
            self._addresses[scalars] = found
        return found

    @property
    def function(self) -> Callable[[], None]:
        """The run as a plain function with the least overhead."""
        return functools.partial(self.kernel.function, ctypes.byref(self._bounds), ctypes.byref(self._packed))

    @property
    def brief_function(self) -> Callable[[], None]:
        """The same with the GIL held: for kernels that take less time than releasing it."""
        return functools.partial(
            self.kernel.brief_function, ctypes.byref(self._bounds), ctypes.byref(self._packed)
        )


@functools.cache
def _packed_arguments(*types: Any) -> Any:
    """The C struct of arguments of these types."""
    fields = [(f"p{place}", kind) for place, kind in enumerate(types)]
    return type("PackedArguments", (ctypes.Structure,), {"_fields_": fields})


class TreeLaunch:
    """A kernel with a tree among its arguments that can be run on any tree; for kernels of a microsecond."""

    __slots__ = ("_addresses", "_all", "_launch", "_place", "_records", "_run", "_tree")

    def __init__(self, kernel: Kernel, structs: KernelStructs) -> None:
        self._launch = structs.launch(kernel, tree=0, first_world=0)
        self._run = self._launch.brief_function
        self._place = kernel.indices["tree"]
        self._tree = 0
        self._addresses = self._launch.addresses("tree")
        self._records: dict[int, bytes] = {}
        self._all: tuple[int, bytes] = 0, b""

    def addresses(self) -> list[int]:
        """Addresses of the kernel, its two arguments and the tree; a caller must restore the tree's value."""
        return self._addresses

    def record(self, tree: int) -> bytes:
        """What `Change.run_record` needs to run it on a tree."""
        record = self._records.get(tree)
        if record is None:
            record = self._records[tree] = packed_run(*self._addresses, tree)
        return record

    def records(self, count: int) -> bytes:
        """Those to run it on each of the first trees, so many; the last ones asked for are kept."""
        if self._all[0] != count:
            self._all = count, b"".join(map(self.record, range(count)))
        return self._all[1]

    def __call__(self, tree: int) -> None:
        """Run the kernel on a tree."""
        if tree != self._tree:
            self._launch.replace(self._place, tree)
            self._tree = tree
        self._run()


class KernelStructs(dict[str, Any]):
    """Structs by the names of kernel arguments, with a cache of launches.

    The last launch of each kernel is kept, for each choice of its numbers. Making a launch takes a hundred
    times as long as running it, and most calls between two steps leave a world's arrays where they are.
    """

    def __init__(self, **structs: Any) -> None:
        super().__init__(structs)
        self._launches: dict[Any, tuple[dict[str, Any], Launch]] = {}

    def launch(self, kernel: Kernel, **scalars: float) -> Launch:
        """A launch of a kernel with these structs and numbers.

        An earlier launch of the same kernel with the same numbers is updated and returned. Launches that are
        not asked for again may keep outdated structs.
        """
        indices = kernel.indices
        arguments = {name: scalars[name] if name in scalars else self[name] for name in indices}
        key = kernel, *scalars.items()
        before, made = self._launches.get(key) or ({}, None)
        if made is None:
            made = Launch(kernel, 1, list(arguments.values()))
        else:
            for name, argument in arguments.items():
                if name in scalars or argument is not before[name]:
                    made.replace(indices[name], argument)
        self._launches[key] = arguments, made
        return made

    def changed(self, name: str) -> None:
        """Update the cached launches after the fields of a struct have changed."""
        struct = self.get(name)
        for (kernel, *_), (arguments, made) in self._launches.items():
            if arguments.get(name) is struct:
                made.replace(kernel.indices[name], struct)
