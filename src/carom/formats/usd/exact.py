"""Numbers that the physics schema keeps in single precision, and their doubles beside them.

`physics:mass` and its like are floats. Files that Carom writes have the number itself as well where it is no
float: `carom:physics:mass`, which other programs ignore. It counts as long as it rounds to what the schema's
attribute says, so not after another program has changed that.
"""

from __future__ import annotations

from typing import Any

import numpy as np

PREFIX = "carom:"


def numbers(value: Any) -> list[float]:
    """The numbers of a value of USD: x, y, z, w of a quaternion, components of a vector, or itself."""
    if hasattr(value, "imaginary"):
        return [*map(float, value.imaginary), float(value.real)]
    if hasattr(value, "__len__"):
        return [float(component) for component in value]
    return [float(value)]


def is_rounded(exact: Any, rounded: Any) -> bool:
    """Whether a value in double precision is that of an attribute in single precision before rounding."""
    a, b = numbers(exact), numbers(rounded)
    return len(a) == len(b) and bool(np.array_equal(np.array(a, np.float32), np.array(b, np.float32)))


def is_exact(value: Any) -> bool:
    """Whether numbers are the same in single precision."""
    given = np.array(value, np.float64)
    with np.errstate(over="ignore"):
        return bool(np.array_equal(given.astype(np.float32).astype(np.float64), given))
