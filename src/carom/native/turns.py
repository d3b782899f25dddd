"""Rotations and rigid transforms, with the same bits on every machine: `native/source/turns.cpp`."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from functools import cache
from typing import Any


def worked_out(kernel: str, numbers: Sequence[float], count: int) -> tuple[float, ...] | None:
    """The `count` results of a kernel of `turns.cpp`, named without `carom_`; None if there are none."""
    results = (ctypes.c_double * count)()
    well = _function(kernel)((ctypes.c_double * len(numbers))(*numbers), results, None)
    return tuple(results) if well else None


@cache
def _function(kernel: str) -> Any:
    # Imported at the first call, so that `import pybullet` does not load the library.
    from carom.native.library import library

    return library().turn(kernel)
