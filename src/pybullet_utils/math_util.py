"""Small mathematical functions for learning scripts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

RAD_TO_DEG = 57.2957795
DEG_TO_RAD = 1.0 / RAD_TO_DEG
INVALID_IDX = -1


def lerp(x: Any, y: Any, t: Any) -> Any:
    """Linear interpolation from x (t = 0) to y (t = 1)."""
    return (1 - t) * x + t * y


def log_lerp(x: Any, y: Any, t: Any) -> np.ndarray:
    """Logarithmic interpolation from x (t = 0) to y (t = 1), both > 0: linear in the logarithm."""
    return np.exp(lerp(np.log(x), np.log(y), t))


def flatten(arr_list: Sequence[Any]) -> np.ndarray:
    """All numbers of several arrays, one after the other."""
    return np.concatenate([np.reshape(array, [-1]) for array in arr_list], axis=0)


def flip_coin(p: float) -> bool:
    """True with probability p."""
    return bool(np.random.binomial(1, p, 1)[0] == 1)
