"""Kernels of quick calls for Python: they take and return numbers, with the same bits on every machine.

Quick calls read their arguments in the native library; where it leaves that to Python, Python calls the same
kernels.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from functools import cache
from struct import Struct
from typing import Any

from carom.layouts.quick.calls import MAX_RESULTS

# Room for the results of any kernel.
_Results = ctypes.c_double * MAX_RESULTS


def worked_out(
    kernel: str, numbers: Sequence[float], count: int, call: int | None = None
) -> tuple[float, ...] | None:
    """The `count` results of a kernel, named without `carom_`; None if there are none.

    `call` is the address of a `carom.layouts.quick.calls.Call`, for kernels that read or change a world.
    """
    results = _Results()
    well = _function(kernel)(_numbers(len(numbers)).pack(*numbers), results, call)
    return _numbers(count).unpack_from(results) if well else None


@cache
def _numbers(count: int) -> Struct:
    return Struct(f"{count}d")


@cache
def _function(kernel: str) -> Callable[[bytes, Any, int | None], int]:
    # Imported at the first call, so that `import pybullet` does not load the library.
    from carom.native.library import library

    return library().number_kernel(kernel)
