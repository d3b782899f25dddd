"""Implementations, for arrays on a device, of the NumPy functions that `carom.worlds` uses."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from carom.gpu.array import NUMPY_FUNCTIONS, DeviceArray, combine
from carom.kernels.arrays.arithmetic import GREATEST, LEAST


def _any(*values: Any) -> DeviceArray:
    return next(value for value in values if isinstance(value, DeviceArray))


def _clip(value: Any, least: Any, greatest: Any) -> DeviceArray:
    here = _any(value, least, greatest)
    raised = combine(GREATEST, here.real(value), here.real(least))
    return combine(LEAST, raised, here.real(greatest))


def _concatenate(values: Sequence[Any], axis: int = 0) -> DeviceArray:
    arrays = [_any(*values).real(value) for value in values]
    axis %= arrays[0].ndim
    shape = list(arrays[0].shape)
    shape[axis] = sum(array.shape[axis] for array in arrays)
    result, end = DeviceArray.zeros(shape, arrays[0].dtype, arrays[0].device), 0
    for array in arrays:
        key: list[Any] = [slice(None)] * len(shape)
        key[axis] = slice(end, end + array.shape[axis])
        result[tuple(key)] = array
        end += array.shape[axis]
    return result


def _cross(first: Any, second: Any) -> DeviceArray:
    a, b = _any(first, second).real(first), _any(first, second).real(second)
    ways = ((1, 2), (2, 0), (0, 1))
    columns = [a[..., i : i + 1] * b[..., j : j + 1] - a[..., j : j + 1] * b[..., i : i + 1] for i, j in ways]
    return _concatenate(columns, axis=-1)


NUMPY_FUNCTIONS.update(
    {
        np.clip: _clip,
        np.broadcast_to: DeviceArray.spread,
        np.concatenate: _concatenate,
        np.cross: _cross,
    }
)
