"""Some of many worlds, the values that a setter gets for them, and joints and links by name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import Array, OnDevice

Mask = NDArray[np.bool_]
Where = ArrayLike | slice
"""Which worlds: a mask (count,), their indices, or a slice of them."""


class Chosen:
    """The worlds that a setter changes; it checks that the values it gets are for these.

    Attributes:
        numbers: Their indices, (n,).
        rows: The same as an index of arrays: a slice, which gives views, if all worlds are meant.

    Args:
        where: Which worlds: a mask (count,), their indices or a slice; None for all.
        count: Number of all worlds.

    Raises:
        ValueError: A mask has the wrong length, or the indices are not integers.
        IndexError: There is no such world.
    """

    def __init__(self, where: Where | None, count: int) -> None:
        self.numbers: NDArray[np.int64] = world_numbers(where, count)
        self.rows: slice | NDArray[np.int64] = slice(None) if where is None else self.numbers
        self._which = "worlds" if where is None else "worlds chosen"

    def __len__(self) -> int:
        return len(self.numbers)

    def fitting(self, value: ArrayLike, inner: tuple[int, ...], name: str) -> Array:
        """Check the shape of a user's value: one for all of these worlds, or one for each.

        Args:
            value: An array with the worlds in front, exactly as many as are chosen; or one without that axis,
                for all of them. Its other axes broadcast to `inner`. Numbers on a device stay there.
            inner: Shape of the value of one world.
            name: What messages call it.

        Returns:
            The value as doubles, which broadcasts to (n, *inner); its numbers are not checked.

        Raises:
            ValueError: The shape is another.
        """
        array: Any = value if isinstance(value, OnDevice) else _doubles(value, name)
        own = array.shape
        if len(own) == len(inner) + 1 and own[0] == len(self) and _spreads(own[1:], inner):
            return array
        if len(own) <= len(inner) and _spreads(own, inner):
            return array
        alternative = f"{inner} or one that broadcasts to it" if inner else "() (one number)"
        raise ValueError(
            f"{name} has shape {own}; it must have shape {(len(self), *inner)}, with one entry for each of "
            f"the {len(self)} {self._which}, or for all of them alike {alternative}"
        )

    def values(self, value: ArrayLike, inner: tuple[int, ...], name: str, *, finite: bool = True) -> Array:
        """A user's value for each of these worlds, (n, *inner); see `fitting`.

        `finite` refuses infinities; NaN always is refused. Numbers on a device are not checked.

        Raises:
            ValueError: The shape is another, or a number is not finite.
        """
        array, shape = self.fitting(value, inner, name), (len(self), *inner)
        if isinstance(array, OnDevice):
            return array if array.shape == shape else np.broadcast_to(array, shape)
        good = np.isfinite(array).all() if finite else not np.isnan(array).any()
        if not good:
            kind = "finite" if finite else "numbers"
            raise ValueError(f"{name} must be {kind}, but some entries are not")
        if array.shape == shape:
            return array
        # NumPy takes several microseconds to make a view of that shape.
        each = np.empty(shape)
        each[...] = array
        return each


def world_numbers(where: Where | None, count: int) -> NDArray[np.int64]:
    """Indices of the chosen worlds: those of a mask (count,) or a slice, the given ones, or with None all.

    Raises:
        ValueError: A mask has the wrong length, or the indices are not integers.
        IndexError: There is no such world.
    """
    if where is None or isinstance(where, slice):
        return np.arange(count)[slice(None) if where is None else where]
    chosen = np.atleast_1d(np.asarray(where))
    if chosen.dtype == np.bool_:
        if chosen.shape != (count,):
            raise ValueError(f"where has shape {chosen.shape}; as a mask it must have shape ({count},)")
        return np.flatnonzero(chosen)
    if chosen.size == 0:
        return np.zeros(0, dtype=np.int64)
    if not np.issubdtype(chosen.dtype, np.integer):
        raise ValueError(f"where must be a mask, numbers of worlds or a slice, not {where!r}")
    if chosen.ndim != 1 or chosen.min() < 0 or chosen.max() >= count:
        raise IndexError(f"where names worlds that do not exist: there are worlds 0 to {count - 1}")
    return chosen.astype(np.int64)


def _doubles(value: ArrayLike, name: str) -> Array:
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be a number or an array of numbers, not {value!r}") from None


def _spreads(given: Sequence[int], wanted: Sequence[int]) -> bool:
    """Whether a shape, without more axes, broadcasts to another."""
    return given == wanted or all(
        own in (1, length) for own, length in zip(given[::-1], wanted[::-1], strict=False)
    )


def choose(what: str, names: Sequence[str], key: int | str) -> int:
    """The index of the joint or link with an index (or `IndexError`) or a name (or `KeyError`)."""
    if isinstance(key, str):
        if key not in names:
            raise KeyError(f"no {what} is called {key!r}; there are {', '.join(names)}")
        return names.index(key)
    if not 0 <= key < len(names):
        raise IndexError(f"{what} {key} is out of range: indices are 0 to {len(names) - 1}")
    return key
