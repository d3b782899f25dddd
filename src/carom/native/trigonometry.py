"""Sine, cosine and tangent that are the same bits on every machine: those of the kernels.

Those of `math` are those of the platform's C library, and differ in the last bit. Roots and `math.hypot` need
nothing of that kind: they consist of operations that are rounded correctly.
"""

from __future__ import annotations

import ctypes
from functools import cache
from typing import Any


def sin(angle: float) -> float:
    """Sine of an angle [rad]."""
    return _applied("sin", angle)


def cos(angle: float) -> float:
    """Cosine of an angle [rad]."""
    return _applied("cos", angle)


def tan(angle: float) -> float:
    """Tangent of an angle [rad]."""
    return _applied("tan", angle)


def _applied(name: str, angle: float) -> float:
    number = ctypes.c_double(angle)
    _function(name)(ctypes.byref(number))
    return number.value


@cache
def _function(name: str) -> Any:
    # Imported when a first angle comes: `import pybullet` has none.
    from carom.native.library import library

    return library().maths(name)
