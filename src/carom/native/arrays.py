"""Arrays of zeros, allocated lazily, and of C records, by types that are made once; bounds of points."""

from __future__ import annotations

import mmap
from collections.abc import Iterable
from ctypes import Array
from functools import lru_cache
from math import prod
from typing import Any

import numpy as np

Corner = tuple[float, float, float]
"""Coordinates x, y and z."""

_MOST_TYPES = 1024
# Size from which on an array has a memory mapping of its own [bytes].
_MIN_MAPPED = 1 << 20
# On systems with fork, the memory must not be shared with child processes; on others there are no flags.
_PRIVATE: dict[str, int] = (
    {"flags": mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS} if hasattr(mmap, "MAP_ANONYMOUS") else {}
)


def zeros(shape: tuple[int, ...], dtype: np.dtype[Any]) -> np.ndarray:
    """An array of zeros, which takes physical memory only where something has been written.

    Large arrays are mapped from the operating system directly, and returned to it. Memory from the heap of
    the process may have been used before; then the whole array has to be cleared, which takes all its memory.

    Raises:
        MemoryError: There is no room for it.
    """
    size = prod(shape) * dtype.itemsize
    if size < _MIN_MAPPED:
        return np.zeros(shape, dtype=dtype)
    try:
        mapped = mmap.mmap(-1, size, **_PRIVATE)
    except OSError as problem:
        raise MemoryError(
            f"{size} bytes for an array of {shape} numbers cannot be had: {problem}"
        ) from problem
    return np.frombuffer(mapped, dtype=dtype).reshape(shape)


@lru_cache(_MOST_TYPES)
def _type(kind: Any, count: int) -> type[Array[Any]]:
    # `ctypes` forgets the type of an array with its last object, and a new type is in reference cycles.
    return kind * count


def c_array(kind: type[Any], count: int, items: Iterable[Any] = ()) -> Array[Any]:
    """An array of so many records or numbers of a C type, which begins with `items`; the rest is 0."""
    return _type(kind, count)(*items)


def ends(points: np.ndarray) -> tuple[Corner, Corner]:
    """Lowest and highest corner of points (n, 3)."""
    # By columns: NumPy takes many times as long along the first axis of an array of a few columns.
    x, y, z = points.T
    return (
        (float(x.min()), float(y.min()), float(z.min())),
        (float(x.max()), float(y.max()), float(z.max())),
    )
