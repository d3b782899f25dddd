"""Rotations and rigid transforms, with the same bits on every machine: `native/source/turns.cpp`."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from functools import cache
from typing import Any


def worked_out(kernel: str, numbers: Sequence[float], count: int) -> tuple[float, ...] | None:
    """The results of a kernel of `turns.cpp`.

    Args:
        kernel: Its name, without the prefix `carom_`.
        numbers: Its arguments, as many as it takes.
        count: Number of results.

    Returns:
        The results; None if the kernel has none for these numbers.
    """
    results = (ctypes.c_double * count)()
    well = _function(kernel)((ctypes.c_double * len(numbers))(*numbers), results, None)
    return tuple(results) if well else None


@cache
def _function(kernel: str) -> Any:
    # Imported at the first call, so that `import pybullet` does not load the library.
    from carom.native.library import library

    return library().turn(kernel)
