"""Checks of the shapes of arrays for many worlds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import Array, OnDevice

Mask = NDArray[np.bool_]


def broadcast(value: ArrayLike, shape: tuple[int, ...], name: str, *, finite: bool = True) -> Array:
    """Broadcast a user's value to an array of doubles; one value can be for all worlds, or for all joints.

    Numbers on another device stay there, and are not checked. `finite` refuses infinities; NaN always is.

    Raises:
        ValueError: `value` does not broadcast to that shape, or a number is not finite.
    """
    array: Any = value
    if not isinstance(value, OnDevice):
        array = np.asarray(value, dtype=np.float64)
        good = np.isfinite(array).all() if finite else not np.isnan(array).any()
        if not good:
            raise ValueError(f"{name} must be {'finite' if finite else 'numbers'}, but some entries are not")
    try:
        return np.broadcast_to(array, shape)
    except ValueError:
        raise ValueError(
            f"{name} has shape {array.shape}; it must have shape {shape}, or one that broadcasts to it"
        ) from None


def world_numbers(where: ArrayLike | None, count: int) -> NDArray[np.int64]:
    """Indices of the chosen worlds: those of a mask (count,), the given ones, or with None all.

    Raises:
        ValueError: A mask has the wrong length, or the indices are not integers.
        IndexError: There is no such world.
    """
    if where is None:
        return np.arange(count)
    chosen = np.atleast_1d(np.asarray(where))
    if chosen.dtype == np.bool_:
        if chosen.shape != (count,):
            raise ValueError(f"where has shape {chosen.shape}; as a mask it must have shape ({count},)")
        return np.flatnonzero(chosen)
    if chosen.size == 0:
        return np.zeros(0, dtype=np.int64)
    if not np.issubdtype(chosen.dtype, np.integer):
        raise ValueError(f"where must be a mask or numbers of worlds, not {chosen.dtype}")
    if chosen.ndim != 1 or chosen.min() < 0 or chosen.max() >= count:
        raise IndexError(f"where names worlds that do not exist: there are worlds 0 to {count - 1}")
    return chosen.astype(np.int64)


def choose(what: str, names: Sequence[str], key: int | str) -> int:
    """The index of the joint or link with an index (or `IndexError`) or a name (or `KeyError`)."""
    if isinstance(key, str):
        if key not in names:
            raise KeyError(f"no {what} is called {key!r}; there are {', '.join(names)}")
        return names.index(key)
    if not 0 <= key < len(names):
        raise IndexError(f"{what} {key} is out of range: indices are 0 to {len(names) - 1}")
    return key
