"""Trigonometric functions with the same bits on every machine: the ones that kernels use.

The functions of `math` are those of the platform's C library, and differ in the last bit. Square roots and
`math.hypot` need no replacement: they consist of correctly rounded operations. Where `math` raises, as for
the arcsine of 2, the result here is NaN.
"""

from __future__ import annotations

import ctypes
from functools import cache
from typing import Any

_Two = ctypes.c_double * 2


def sin(angle: float) -> float:
    """Sine of an angle [rad]."""
    return _applied("sin", angle)


def cos(angle: float) -> float:
    """Cosine of an angle [rad]."""
    return _applied("cos", angle)


def tan(angle: float) -> float:
    """Tangent of an angle [rad]."""
    return _applied("tan", angle)


def asin(sine: float) -> float:
    """The angle of a sine, from -π/2 to π/2 [rad]."""
    return _applied("asin", sine)


def acos(cosine: float) -> float:
    """The angle of a cosine, from 0 to π [rad]."""
    return _applied("acos", cosine)


def atan2(y: float, x: float) -> float:
    """The angle from the x axis to the point (x, y), from -π to π [rad]."""
    numbers = _Two(y, x)
    _function("atan2")(ctypes.byref(numbers))
    return numbers[0]


def _applied(name: str, value: float) -> float:
    number = ctypes.c_double(value)
    _function(name)(ctypes.byref(number))
    return number.value


@cache
def _function(name: str) -> Any:
    # Imported at the first call, so that `import pybullet` does not load the library.
    from carom.native.library import library

    return library().maths(name)
