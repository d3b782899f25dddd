"""Rotations and rigid transforms by numbers, the same bits on every machine: `native/source/turns.cpp`."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from functools import cache
from typing import Any


def worked_out(kernel: str, numbers: Sequence[float], count: int) -> tuple[float, ...] | None:
    """The results of a kernel for some numbers.

    Args:
        kernel: Its name, without the prefix.
        numbers: As many as it takes.
        count: Number of results.

    Returns:
        These; None if there is no result for such numbers.
    """
    results = (ctypes.c_double * count)()
    well = _function(kernel)((ctypes.c_double * len(numbers))(*numbers), results, None)
    return tuple(results) if well else None


@cache
def _function(kernel: str) -> Any:
    # Imported with the first of them: `import pybullet` works nothing out.
    from carom.native.library import library

    return library().turn(kernel)
