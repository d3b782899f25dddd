"""Checks of numbers from users, which are converted to arrays."""

from __future__ import annotations

from math import isfinite
from operator import index
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
else:
    # `numpy.typing` would be imported for nothing else.
    Array = np.ndarray


class OnDevice:
    """Base class of arrays on a device other than the CPU; checks do not read their numbers back."""


def finite(value: ArrayLike, name: str) -> Array:
    """A copy of `value` as an array of finite doubles.

    Raises:
        ValueError: A number is NaN or infinite; the message refers to the value as `name`.
    """
    if isinstance(value, OnDevice):
        return value  # type: ignore[return-value]
    array = _numbers(value, name)
    # NumPy takes its time with single numbers.
    if not (np.isfinite(array).all() if array.ndim else isfinite(array)):
        raise ValueError(f"{name} must be finite, not {value!r}")
    return array


def vector(value: ArrayLike, length: int, name: str) -> Array:
    """A copy of `value` as `length` finite doubles.

    Raises:
        ValueError: The shape is wrong, or a number is NaN or infinite.
    """
    array = finite(value, name)
    if array.shape != (length,):
        raise ValueError(f"{name} must have shape ({length},), not {array.shape}: it is {value!r}")
    return array


def pair(value: Any, name: str, what: str) -> tuple[Any, Any]:
    """Both parts of a value that has two.

    Raises:
        ValueError: It has not; the message says of `what` it consists.
    """
    try:
        first, second = value
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be {what}, not {value!r}") from None
    return first, second


def one_or_each(value: ArrayLike, count: int, name: str) -> Array:
    """`value` as `count` doubles; a single number is repeated. Infinity is allowed.

    Raises:
        ValueError: It is neither one number nor `count` of them.
    """
    array = _numbers(value, name)
    if array.shape not in ((), (1,), (count,)):
        raise ValueError(f"{name} must be one number or {count} of them, not shape {array.shape}: {value!r}")
    if array.shape == (count,):
        return array
    each = np.empty(count)
    each[:] = array
    return each


def positive(value: ArrayLike, name: str) -> Array:
    """A copy of `value` as an array of finite doubles greater than 0.

    Raises:
        ValueError: A number is not positive or not finite.
    """
    array = _numbers(value, name)
    if not (np.isfinite(array).all() and (array > 0.0).all()):
        raise ValueError(f"{name} must be finite and > 0, not {value!r}")
    return array


def positive_count(value: Any, name: str) -> int:
    """A whole number of at least 1.

    Raises:
        TypeError: It is no whole number.
        ValueError: It is less than 1.
    """
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        raise TypeError(f"{name} must be a whole number of at least 1, not {value!r}")
    count = index(value)
    if count < 1:
        raise ValueError(f"{name} must be at least 1, not {count}")
    return count


def not_negative(value: ArrayLike, name: str) -> Array:
    """A copy of `value` as an array of doubles >= 0; infinity is allowed.

    Raises:
        ValueError: A number is negative or NaN.
    """
    if isinstance(value, OnDevice):
        return value  # type: ignore[return-value]
    array = _numbers(value, name)
    if not ((array >= 0.0).all() if array.ndim else float(array) >= 0.0):
        raise ValueError(f"{name} must be >= 0, not {value!r}")
    return array


def _numbers(value: ArrayLike, name: str) -> Array:
    try:
        # Copied separately, because PyTorch's tensors warn when NumPy requests a copy from them.
        return np.asarray(value, dtype=np.float64).copy()
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be a number or an array of numbers, not {value!r}") from None
