"""Values as bytes: MessagePack, with the contents of arrays outside, so that they are never copied.

Only plain values come out again, whatever the bytes say: None, booleans, numbers, strings, bytes, tuples or
lists, dictionaries, and NumPy arrays of numbers. An argument of any other type becomes the nearest of
these, as a function that wants numbers would take it; what has nothing of a number becomes an `Opaque` value,
so that the function on the other side can say of it what it would have said here.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable
from operator import index
from typing import Any, SupportsFloat

import msgpack
import numpy as np
from numpy.typing import NDArray

from carom.remote.errors import Malformed

ALIGNMENT = 16
"""Contents of arrays start at multiples of this [bytes]."""

_ARRAY, _INTEGER, _OPAQUE = 1, 2, 3
_PLACE = struct.Struct("<B8q")
_MAX_DIMENSIONS = _PLACE.size // 8 - 1
# No number that means anything is longer [bytes]; float() refuses those that are.
_GREATEST_INTEGER = 256
_GREATEST_NAME, _GREATEST_TEXT = 100, 1000
_KINDS = "? i1 u1 <i2 <u2 <i4 <u4 <i8 <u8 <f2 <f4 <f8 <c8 <c16"
_DTYPES = tuple(map(np.dtype, _KINDS.split(" ")))


class Opaque:
    """Stands for a value that cannot be sent: it has the name of its type and its text, and nothing else."""

    def __init__(self, text: str) -> None:
        self._text = text

    def __repr__(self) -> str:
        return self._text


def padded(size: int) -> int:
    """The least multiple of `ALIGNMENT` that is not less."""
    return -(-size // ALIGNMENT) * ALIGNMENT


def pack(value: Any) -> tuple[bytes, list[memoryview]]:
    """A value as bytes.

    Returns:
        The bytes, and the contents of the arrays in it, in order.
    """
    arrays: list[memoryview] = []
    # Numbers of NumPy that are Python floats as well go as those; names of files may hold any bytes.
    packer = msgpack.Packer(default=_Substitute(arrays), unicode_errors="surrogatepass")
    return packer.pack(value), arrays


def unpack(message: bytes | memoryview, contents: memoryview, *, lists: bool) -> Any:
    """The value of some bytes; arrays in it share memory with their contents.

    Args:
        message: The bytes.
        contents: Of the arrays, each padded to a multiple of `ALIGNMENT`.
        lists: Sequences become lists, otherwise tuples.

    Raises:
        Malformed: The bytes are no such value.
    """
    try:
        return msgpack.unpackb(
            message,
            ext_hook=_Restore(contents),
            use_list=lists,
            strict_map_key=False,
            unicode_errors="surrogatepass",
        )
    except Malformed:
        raise
    # Any exception of the library or NumPy for invalid data: not all are documented.
    except Exception as problem:
        raise Malformed(f"A message cannot be read: {problem!r}.") from problem


class _Substitute:
    """Puts something that can be packed in the place of what cannot."""

    def __init__(self, arrays: list[memoryview]) -> None:
        self._arrays = arrays
        self._size = 0

    def __call__(self, value: Any) -> Any:
        if isinstance(value, np.ndarray):
            return self._array(value)
        if isinstance(value, int):
            return _integer(value)
        for convert in _CONVERSIONS:
            try:
                plain = convert(value)
            except Exception:
                # Types of others refuse in ways of their own; that is only the answer to a question here.
                continue
            return self._array(plain) if isinstance(plain, np.ndarray) else plain
        return _opaque(value)

    def _array(self, array: NDArray[Any]) -> Any:
        dtype = array.dtype.newbyteorder("<") if array.dtype.byteorder == ">" else array.dtype
        if dtype not in _DTYPES or array.ndim > _MAX_DIMENSIONS:
            return array.tolist()
        array = np.asarray(array, dtype, order="C")
        place = _PLACE.pack(
            _DTYPES.index(dtype), self._size, *array.shape, *(-1,) * (_MAX_DIMENSIONS - array.ndim)
        )
        contents = array.reshape(-1).view(np.uint8).data
        self._arrays.append(contents)
        self._size += padded(len(contents))
        return msgpack.ExtType(_ARRAY, place)


class _Restore:
    """Makes values of what MessagePack has no types for."""

    def __init__(self, contents: memoryview) -> None:
        self._contents = contents

    def __call__(self, code: int, data: bytes) -> Any:
        if code == _ARRAY:
            return self._array(data)
        if code == _INTEGER and len(data) <= _GREATEST_INTEGER:
            return int.from_bytes(data, "little", signed=True)
        if code == _OPAQUE and len(data) <= 4 * (_GREATEST_NAME + _GREATEST_TEXT):
            name, _, text = data.decode("utf-8", "replace").partition("\0")
            return type(name, (Opaque,), {})(text)
        raise Malformed(f"A message holds something of the unknown kind {code}.")

    def _array(self, data: bytes) -> NDArray[Any]:
        kind, start, *lengths = _PLACE.unpack(data)
        shape = lengths[: lengths.index(-1)] if -1 in lengths else lengths
        dtype = _DTYPES[kind]
        size = dtype.itemsize
        for length in shape:
            if length < 0:
                raise Malformed("A message holds an array of negative length.")
            size *= length
        if start < 0 or start + size > len(self._contents):
            raise Malformed("A message holds an array whose content it lacks.")
        return np.frombuffer(self._contents[start : start + size], dtype).reshape(shape)


def _integer(value: int) -> Any:
    size = value.bit_length() // 8 + 1
    if size > _GREATEST_INTEGER:
        value, size = (-1 if value < 0 else 1) << (8 * _GREATEST_INTEGER - 2), _GREATEST_INTEGER
    return msgpack.ExtType(_INTEGER, value.to_bytes(size, "little", signed=True))


def _opaque(value: Any) -> Any:
    try:
        text = repr(value)
    except Exception:
        text = object.__repr__(value)
    name = type(value).__name__[:_GREATEST_NAME].replace("\0", "")
    content = f"{name}\0{text[:_GREATEST_TEXT]}"
    return msgpack.ExtType(_OPAQUE, content.encode("utf-8", "replace"))


def _numpy_array(value: Any) -> NDArray[Any]:
    if isinstance(value, np.generic) or not hasattr(value, "__array__"):
        raise TypeError
    return np.asarray(value)


def _number(value: SupportsFloat) -> float:
    if not isinstance(value, SupportsFloat):
        raise TypeError
    return float(value)


def _items(value: Iterable[Any]) -> list[Any]:
    return list(value)


# In this order: arrays of one item are numbers, too, but not the other way round.
_CONVERSIONS: tuple[Callable[[Any], Any], ...] = (index, _numpy_array, _number, _items)
