"""The memory that a call of the native library uses, as one image that can be sent to another process.

What kernels may reach follows from the layouts in the library's manifest: their bounds, their arguments, and
the arrays whose views are among these.
"""

from __future__ import annotations

import ctypes
import re
import struct
from bisect import bisect_right
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

# Segments keep their places in cache lines, for vectors are loaded by addresses that are multiples.
_ALIGNMENT = 64
_POINTER = struct.Struct("<Q")
# The address, and behind that of the gradient the shape, the strides and the number of axes.
_ARRAY = struct.Struct("<Q8x4i4iH")
_ARRAY_TYPE = re.compile(r"array\((.*),(\d)\)")
_NUMBERS_TYPE = re.compile(r"(?:vector|matrix|quaternion|transform)\((?:(\d+),)?(?:(\d+),)?([a-z]+\d+)\)")
_OWN_LENGTHS = {"quaternion": 4, "transform": 7}
_BITS = re.compile(r"[a-z]+(\d+)")


class Layouts:
    """Where the arrays are among the arguments of kernels.

    Args:
        manifest: The library's manifest.
    """

    def __init__(self, manifest: Mapping[str, Any]) -> None:
        self._kernels: Mapping[str, Any] = manifest["kernels"]
        self._structs: Mapping[str, Any] = manifest["structs"]
        self.arrays = cache(self._arrays)

    def names(self) -> list[str]:
        """All kernels."""
        return list(self._kernels)

    def arguments(self, kernel: str) -> tuple[tuple[str, str], ...]:
        """Name and type of each argument of a kernel."""
        return tuple((name, kind) for name, kind, _ in self._kernels[kernel]["arguments"])

    def symbol(self, kernel: str) -> str:
        """The name of its function."""
        return self._kernels[kernel]["symbol"]

    def argument_bytes(self, kernel: str) -> int:
        """Size of its arguments."""
        return self._kernels[kernel]["size"]

    def bounds_bytes(self, kernel: str) -> int:
        """Size of its bounds."""
        return self._structs[f"bounds({self._kernels[kernel]['dimensions']})"]["size"]

    def _arrays(self, kernel: str) -> list[tuple[int, int]]:
        """Offset among the arguments, and bytes of an entry, of each array."""
        return [
            found
            for _, kind, offset in self._kernels[kernel]["arguments"]
            for found in self._in(kind, offset)
        ]

    def _in(self, kind: str, offset: int) -> Iterator[tuple[int, int]]:
        array = _ARRAY_TYPE.fullmatch(kind)
        if array:
            if any(self._in(array[1], 0)):
                raise NotImplementedError(f"arrays in entries of {kind}")
            yield offset, self._bytes(array[1])
        elif kind in self._structs:
            for _, field, place in self._structs[kind]["fields"]:
                yield from self._in(field, offset + place)

    def _bytes(self, kind: str) -> int:
        if kind in self._structs:
            return self._structs[kind]["size"]
        numbers = _NUMBERS_TYPE.fullmatch(kind)
        if numbers:
            rows, columns, scalar = int(numbers[1] or 1), int(numbers[2] or 1), numbers[3]
            return _OWN_LENGTHS.get(kind.partition("(")[0], rows * columns) * self._bytes(scalar)
        bits = _BITS.fullmatch(kind)
        if bits is None:
            raise NotImplementedError(f"entries of {kind}")
        return int(bits[1]) // 8


class Memory:
    """What a call uses: runs of bytes of this process, and where in them addresses stand.

    Args:
        layouts: Where the arrays are among the arguments of kernels.
    """

    def __init__(self, layouts: Layouts) -> None:
        self._layouts = layouts
        self._runs: set[tuple[int, int]] = set()
        self._pointers: dict[int, int] = {}
        self._functions: dict[int, str] = {}
        self._starts: list[int] = []
        self._segments: list[tuple[int, int, int]] = []

    def add(self, address: int, size: int) -> None:
        """Add bytes."""
        if size:
            self._runs.add((address, size))

    def add_pointer(self, place: int, size: int) -> int:
        """Add bytes that an address stands for.

        Args:
            place: Where the address is; null is left as it is.
            size: How many bytes there are.

        Returns:
            The address.
        """
        address = _POINTER.unpack(ctypes.string_at(place, 8))[0]
        if address and size:
            self.add(address, size)
            self._pointers[place] = address
        return address

    def add_function(self, place: int, name: str) -> None:
        """Say that the address of a function stands at a place."""
        self._functions[place] = name

    def add_launch(self, kernel: str, bounds: int, arguments: int) -> None:
        """Add what a kernel uses.

        Args:
            kernel: Its name.
            bounds: Address of its bounds.
            arguments: Address of its arguments.
        """
        size = self._layouts.argument_bytes(kernel)
        self.add(bounds, self._layouts.bounds_bytes(kernel))
        self.add(arguments, size)
        block = ctypes.string_at(arguments, size)
        for offset, entry in self._layouts.arrays(kernel):
            address, *numbers, axes = _ARRAY.unpack_from(block, offset)
            shape, strides = numbers[:axes], numbers[4 : 4 + axes]
            if address and all(shape):
                self.add(address, entry + sum((n - 1) * step for n, step in zip(shape, strides, strict=True)))
                self._pointers[arguments + offset] = address

    def image(self) -> tuple[bytearray, list[int], list[tuple[int, str]]]:
        """The packed recording.

        Returns:
            The bytes, in which addresses have become offsets; the offsets of those; and the offsets where
            addresses of functions belong, with their names.
        """
        image = bytearray()
        for start, end in _merged(self._runs):
            image.extend(bytes((start - len(image)) % _ALIGNMENT))
            self._segments.append((start, end, len(image)))
            self._starts.append(start)
            image += ctypes.string_at(start, end - start)
        places = []
        for place, target in self._pointers.items():
            places.append(self.offset(place))
            _POINTER.pack_into(image, places[-1], self.offset(target))
        return image, places, [(self.offset(place), name) for place, name in self._functions.items()]

    def offset(self, address: int) -> int:
        """Where an address is in the image."""
        start, end, offset = self._segments[bisect_right(self._starts, address) - 1]
        if not start <= address < end:
            raise ValueError(f"{address:#x} is in none of the runs")
        return offset + address - start

    def put_back(self, image: bytearray) -> None:
        """Write an image back to where it came from, but for the addresses in it."""
        for place in (*self._pointers, *self._functions):
            offset = self.offset(place)
            image[offset : offset + 8] = ctypes.string_at(place, 8)
        buffer = (ctypes.c_char * len(image)).from_buffer(image)
        for start, end, offset in self._segments:
            ctypes.memmove(start, ctypes.addressof(buffer) + offset, end - start)


def _merged(runs: set[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Starts and ends of runs, with those that overlap or touch made one."""
    start = end = 0
    for address, size in sorted(runs):
        if address > end:
            if end > start:
                yield start, end
            start, end = address, address
        end = max(end, address + size)
    if end > start:
        yield start, end
