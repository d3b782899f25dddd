"""A native library in another process, in the place of the one of this machine."""

from __future__ import annotations

import ctypes
import json
import math
import os
import struct
import subprocess
import threading
import traceback
from collections.abc import Sequence
from functools import cache, partial
from pathlib import Path
from typing import Any

from tools.wheels.elsewhere.memory import Layouts, Memory
from tools.wheels.elsewhere.quick_calls import add_call

from carom.native import library as native
from carom.scene import changes

_NAME_BYTES = 64
_CALL = struct.Struct(f"<{_NAME_BYTES}s6Q")
_FUNCTION_PLACE = struct.Struct(f"<Q{_NAME_BYTES}s")
# What `Interpreter` asks of `carom_perform`: addresses of program, worlds, substeps, counter, lanes, and of
# the times of worlds, what is unspent of them, and what will be after each step; the duration; numbers.
_RUN = struct.Struct("<9Qd9i4x")
_LANES_AT, _TIMES_AT, _UNSPENT_AT, _UNSPENT_AFTER_AT, _WATCH_AT = 32, 40, 48, 56, 64
# A program: address and stride of statuses, ends of the five parts, and for each launch six addresses.
_PROGRAM = struct.Struct("<7q")
_KERNEL_CALL = struct.Struct("<3Q")
_LAUNCH = struct.Struct("<6Q")
_INT, _DOUBLE = 4, 8


class Elsewhere:
    """A library that another program has loaded; it does what `carom.native.library.Library` does.

    Args:
        command: Starts `calls.c`; the path of the library is added.
        path: The library; its manifest is beside it.
        digest: What the library has to be made from.

    Raises:
        RuntimeError: The program does not start, or the library is made from something else.
    """

    # Builtins of this process cannot call what is in another.
    symbols = None

    def __init__(self, command: Sequence[str], path: Path, digest: str) -> None:
        self._layouts = Layouts(json.loads((path.parent / native.MANIFEST).read_text("utf-8")))
        self.path = path
        self.calls = 0
        self._names: dict[int, str] = {}
        self._alone = threading.Lock()
        self._program = subprocess.Popen(
            [*command, str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0
        )
        assert self._program.stdin is not None and self._program.stdout is not None
        self._to, self._from = self._program.stdin, self._program.stdout
        said = b""
        while not said.endswith(b"\n"):
            said += self._read(1)
        if said.decode().strip() != digest:
            raise RuntimeError(f"{path} was made from other kernels than those that are here")
        self.function = cache(self._function)
        # Programs name their launches by addresses: the proxies are made before anybody asks for one.
        for kernel in self._layouts.names():
            self.function(kernel)

    def arguments(self, kernel: str) -> native.Arguments:
        """Name and type of each argument of a kernel."""
        return self._layouts.arguments(kernel)

    def maths(self, name: str) -> Any:
        """What replaces a number, given by reference, by its sine and the like."""

        def replace(number: Any) -> None:
            memory = Memory(self._layouts)
            address = ctypes.addressof(number._obj)
            memory.add(address, ctypes.sizeof(number._obj))
            self._call(f"carom_{name}_of", memory, address, address)

        return replace

    def number_kernel(self, kernel: str) -> Any:
        """What calls a kernel of quick calls.

        Without a world there is no result where the first number has not been written; with one there is.
        """

        def work_out(numbers: bytes, results: Any, call: int | None) -> bool:
            memory = Memory(self._layouts)
            given = ctypes.cast(ctypes.c_char_p(numbers), ctypes.c_void_p).value or 0
            memory.add(given, len(numbers))
            found = ctypes.addressof(results)
            memory.add(found, ctypes.sizeof(results))
            if call is not None:
                add_call(memory, call, partial(self._add_kernel, memory))
            results[0] = math.nan
            self._call(f"carom_{kernel}", memory, given, found, call)
            return call is not None or not math.isnan(results[0])

        return work_out

    def close(self) -> None:
        """End the other program."""
        self._to.close()
        self._program.wait()

    def perform(self, run: Any) -> None:
        """Perform a program of launches; see `native/source/perform.cpp`."""
        address = ctypes.addressof(run._obj)
        # Worlds move one at a time there, with the same bits: what lanes have is spread over too many places.
        # Signals that come here are none there.
        absent = [ctypes.c_uint64.from_address(address + place) for place in (_LANES_AT, _WATCH_AT)]
        kept = [pointer.value for pointer in absent]
        for pointer in absent:
            pointer.value = 0
        try:
            self._perform(address)
        finally:
            for pointer, value in zip(absent, kept, strict=True):
                pointer.value = value

    def _perform(self, address: int) -> None:
        memory = Memory(self._layouts)
        memory.add(address, _RUN.size)
        worlds, steps = _RUN.unpack(ctypes.string_at(address, _RUN.size))[10:12]
        program = memory.add_pointer(address, _PROGRAM.size)
        highest = max(
            memoryview(ctypes.string_at(memory.add_pointer(address + 8, worlds * _INT), worlds * _INT)).cast(
                "i"
            )
        )
        memory.add_pointer(address + 16, steps * _INT)
        memory.add_pointer(address + 24, _INT)
        for place in (_TIMES_AT, _UNSPENT_AT):
            memory.add_pointer(address + place, (highest + 1) * _DOUBLE)
        memory.add_pointer(address + _UNSPENT_AFTER_AT, steps * _DOUBLE)
        _, stride, *ends = _PROGRAM.unpack(ctypes.string_at(program, _PROGRAM.size))
        memory.add_pointer(program, (highest + 1) * stride)
        for index in range(ends[-1]):
            place = program + _PROGRAM.size + index * _LAUNCH.size
            memory.add(place, _LAUNCH.size)
            self._add_kernel(memory, place)
            memory.add_pointer(place + 24, _INT)
            memory.add_pointer(place + 32, _INT)
        self._call("carom_perform", memory, address, address)

    def _add_kernel(self, memory: Memory, place: int) -> None:
        """Add a kernel whose address, and those of its bounds and arguments, are at a place."""
        function, bounds, arguments = _KERNEL_CALL.unpack(ctypes.string_at(place, _KERNEL_CALL.size))
        kernel = self._names[function]
        memory.add_function(place, self._layouts.symbol(kernel))
        memory.add_launch(kernel, bounds, arguments)
        memory.add_pointer(place + 8, self._layouts.bounds_bytes(kernel))
        memory.add_pointer(place + 16, self._layouts.argument_bytes(kernel))

    def _function(self, kernel: str) -> Any:
        """What stands for a kernel here: a C function that has it run elsewhere."""
        function = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)(partial(self._launch, kernel))
        self._names[ctypes.cast(function, ctypes.c_void_p).value or 0] = kernel
        return function

    def _launch(self, kernel: str, bounds: int, arguments: int) -> None:
        memory = Memory(self._layouts)
        try:
            memory.add_launch(kernel, bounds, arguments)
            self._call(self._layouts.symbol(kernel), memory, bounds, arguments)
        except BaseException:
            # C has no exceptions: it would be printed, and the kernel taken to have run.
            traceback.print_exc()
            os._exit(1)

    def _call(self, function: str, memory: Memory, first: int, second: int, third: int | None = None) -> None:
        # Threads that share an image of the world's memory take turns.
        with self._alone:
            image, pointers, functions = memory.image()
            arguments = [memory.offset(place) for place in (first, second, third or first)]
            numbers = len(image), len(pointers), len(functions), *arguments
            self._write(
                _CALL.pack(function.encode(), *numbers)
                + struct.pack(f"<{len(pointers)}Q", *pointers)
                + b"".join(_FUNCTION_PLACE.pack(offset, name.encode()) for offset, name in functions)
            )
            self._write(image)
            memory.put_back(self._read(len(image)))
            self.calls += 1

    def _write(self, content: bytes | bytearray) -> None:
        rest = memoryview(content)
        while rest:
            rest = rest[self._to.write(rest) :]

    def _read(self, size: int) -> bytearray:
        content = bytearray(size)
        rest = memoryview(content)
        while rest:
            count = self._from.readinto(rest)  # type: ignore[attr-defined]
            if not count:
                raise RuntimeError(
                    f"the program that has loaded {self.path.name} has ended: {self._program.wait()}"
                )
            rest = rest[count:]
        return content


def use(library: Elsewhere) -> None:
    """Have all calls of this process made elsewhere; before the first."""
    native._library = lambda: library  # type: ignore[assignment]
    # Builtins of this process copy the rows of bodies that are made again: here each is made anew.
    changes.pattern_of = lambda spec: None
