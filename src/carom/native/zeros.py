"""Arrays of zeros, allocated lazily."""

from __future__ import annotations

import mmap
from math import prod
from typing import Any

import numpy as np

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
    """
    size = prod(shape) * dtype.itemsize
    if size < _MIN_MAPPED:
        return np.zeros(shape, dtype=dtype)
    return np.frombuffer(mmap.mmap(-1, size, **_PRIVATE), dtype=dtype).reshape(shape)
