"""Sequences of sequences, such as rows of points, of which NumPy then makes arrays.

NumPy itself reads whatever it is given, and would not return from a range of a trillion numbers.
"""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Any

from pybullet._calls.arguments import MAX_ITEMS, sequence
from pybullet._calls.errors import fail

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_NUMBERS = frozenset((int, float, bool))
_ROWS = frozenset((list, tuple))
_DEEPEST = 4


def nested(
    values: Any, problem: str, name: str, most: int = MAX_ITEMS
) -> tuple[Any, ...] | NDArray[np.generic]:
    """The items of sequences of sequences, as tuples or arrays, which hold at most `most` items in all.

    Raises:
        pybullet.error: `values` is not a sequence, or there are too many items or levels.
    """
    return _Reader(problem, name, most).read(values, 1)


class _Reader:
    """Reads one argument. `left` is the number of items that may still be read."""

    def __init__(self, problem: str, name: str, most: int) -> None:
        self._problem = problem
        self._name = name
        # Rows count as well as what they hold.
        self._left = 2 * most

    def read(self, values: Any, depth: int) -> tuple[Any, ...] | NDArray[np.generic]:
        if _is_array(values):
            self._left -= values.size
            if self._left < 0:
                fail(self._problem, f"{self._name} holds more numbers than are accepted.")
            return values
        if depth > _DEEPEST:
            fail(self._problem, f"{self._name} holds sequences in more than {_DEEPEST} levels.")
        items = sequence(values, self._problem, self._name, max(self._left, 0))
        self._left -= len(items)
        if _NUMBERS.issuperset(map(type, items)):
            return items
        if depth < _DEEPEST and _ROWS.issuperset(map(type, items)):
            rows = self._rows(items)
            if rows is not None:
                return rows
        return tuple([self.read(item, depth + 1) if _is_sequence(item) else item for item in items])

    def _rows(self, items: tuple[Any, ...]) -> tuple[Any, ...] | None:
        """Lists and tuples of numbers, of which scripts bring thousands; None if they hold anything else."""
        count = sum(map(len, items))
        if count > self._left:
            return None
        rows = tuple(map(tuple, items))
        if not _NUMBERS.issuperset(map(type, chain.from_iterable(rows))):
            return None
        self._left -= count
        return rows


def _is_array(values: Any) -> bool:
    return hasattr(values, "__array_interface__") and getattr(values, "ndim", 0) > 0


def _is_sequence(value: Any) -> bool:
    if isinstance(value, (str, bytes, bytearray)):
        return False
    try:
        len(value)
    except OverflowError:
        return True
    except (TypeError, ValueError):
        # A generator is refused with the words for a sequence that is none.
        return hasattr(value, "__next__")
    return True
