"""Memory full of zeros."""

from __future__ import annotations

import mmap
from math import prod
from typing import Any

import numpy as np

# Smaller arrays do not get a memory mapping of their own [bytes].
_LEAST_MAPPED = 1 << 20
# Where a process can fork, the memory must not be shared with its children; elsewhere there are no flags.
_PRIVATE: dict[str, int] = (
    {"flags": mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS} if hasattr(mmap, "MAP_ANONYMOUS") else {}
)


def zeros(shape: tuple[int, ...], dtype: np.dtype[Any]) -> np.ndarray:
    """An array of zeros, which takes memory only where something has been written.

    Large ones come straight from the system and go back there: what comes from the heap of the process may
    have been used before, and has to be cleared, and so touched, as a whole.
    """
    size = prod(shape) * dtype.itemsize
    if size < _LEAST_MAPPED:
        return np.zeros(shape, dtype=dtype)
    return np.frombuffer(mmap.mmap(-1, size, **_PRIVATE), dtype=dtype).reshape(shape)
