"""Serialisation of values: MessagePack, with the contents of arrays outside, so that they are never copied.

Unpacking gives plain values only, whatever the bytes are: None, booleans, numbers, strings, bytes, tuples or
lists, dictionaries, and NumPy arrays of numbers. An argument of any other type is converted to one of these,
as a function that takes numbers would convert it. An argument that cannot be converted becomes an `Opaque`
value, with which the function on the other side raises the same error as it would with the argument itself.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
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
# Maximum length of an integer [bytes]: float() raises OverflowError for longer ones.
_MAX_INTEGER = 256
_MAX_NAME, _MAX_TEXT = 100, 1000
_KINDS = "? i1 u1 <i2 <u2 <i4 <u4 <i8 <u8 <f2 <f4 <f8 <c8 <c16"
_DTYPES = tuple(map(np.dtype, _KINDS.split(" ")))


class Opaque:
    """Stands for a value that cannot be sent; it has only the name of the value's type and its `repr`."""

    def __init__(self, text: str) -> None:
        self._text = text

    def __repr__(self) -> str:
        return self._text


def padded(size: int) -> int:
    """The least multiple of `ALIGNMENT` that is at least `size`."""
    return -(-size // ALIGNMENT) * ALIGNMENT


def pack(value: Any) -> tuple[bytes, list[memoryview]]:
    """A value as bytes, and the contents of the arrays in it, in order."""
    arrays: list[memoryview] = []
    # np.float64 is a subclass of float, and is packed as one. File names may contain invalid UTF-8.
    packer = msgpack.Packer(default=_Substitute(arrays), unicode_errors="surrogatepass")
    return packer.pack(value), arrays


def unpack(message: bytes | memoryview, contents: memoryview, *, lists: bool) -> Any:
    """The value that `pack` has serialised, with `lists` or tuples; its arrays share memory with `contents`.

    Raises:
        Malformed: The bytes are not a serialised value.
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
    # For invalid data msgpack and NumPy raise various exceptions, not all of them documented.
    except Exception as problem:
        raise Malformed(f"A message cannot be read: {problem!r}.") from problem


class _Substitute:
    """Converts values that MessagePack has no type for."""

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
                # Foreign types may raise any exception; it only means that this conversion does not apply.
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
    """Restores values that MessagePack has no type for."""

    def __init__(self, contents: memoryview) -> None:
        self._contents = contents

    def __call__(self, code: int, data: bytes) -> Any:
        if code == _ARRAY:
            return self._array(data)
        if code == _INTEGER and len(data) <= _MAX_INTEGER:
            return int.from_bytes(data, "little", signed=True)
        if code == _OPAQUE and len(data) <= 4 * (_MAX_NAME + _MAX_TEXT):
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
    if size > _MAX_INTEGER:
        value, size = (-1 if value < 0 else 1) << (8 * _MAX_INTEGER - 2), _MAX_INTEGER
    return msgpack.ExtType(_INTEGER, value.to_bytes(size, "little", signed=True))


def _opaque(value: Any) -> Any:
    try:
        text = repr(value)
    except Exception:
        text = object.__repr__(value)
    name = type(value).__name__[:_MAX_NAME].replace("\0", "")
    content = f"{name}\0{text[:_MAX_TEXT]}"
    return msgpack.ExtType(_OPAQUE, content.encode("utf-8", "replace"))


def _numpy_array(value: Any) -> NDArray[Any]:
    if isinstance(value, np.generic) or not hasattr(value, "__array__"):
        raise TypeError
    return np.asarray(value)


def _number(value: SupportsFloat) -> float:
    if not isinstance(value, SupportsFloat):
        raise TypeError
    return float(value)


# In this order, because arrays of one item can be converted to numbers, too, but must remain arrays.
_CONVERSIONS: tuple[Callable[[Any], Any], ...] = (index, _numpy_array, _number, list)
