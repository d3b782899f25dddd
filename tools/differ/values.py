"""Where two values of JSON differ."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple


class Place(NamedTuple):
    """Where two values differ: in which part, what both have there, and by how much."""

    field: str
    theirs: Any
    ours: Any
    error: float = 0.0


_VECTORS, _TURN = (3, 4, 6), 4
# Which of two quaternions of a turn by 180 degrees comes out is left to rounding.
_NO_TURN_BUT_HALF, _LENGTH_1 = 1e-6, 1e-3
_SHORT = 12


def first_difference(
    theirs: Any, ours: Any, bound: float, field: str = "", size: float = 0.0
) -> Place | None:
    """The first place where values differ by more than a bound.

    Numbers differ by so much of 1 and the largest of a vector's components that the bound is compared with.

    Args:
        theirs: What PyBullet has.
        ours: What Carom has.
        bound: The greatest difference of numbers that agree.
        field: Which part of a result it is.
        size: The largest number beside it.
    """
    if isinstance(theirs, dict) and isinstance(ours, dict):
        for key in sorted({*theirs, *ours}):
            place = first_difference(theirs.get(key), ours.get(key), bound, f"{field}.{key}")
            if place:
                return place
        return None
    if isinstance(theirs, list) and isinstance(ours, list):
        return _of_lists(theirs, ours, bound, field, size)
    if isinstance(theirs, (int, float)) and isinstance(ours, (int, float)):
        return _of_numbers(theirs, ours, bound, field, size)
    return None if theirs == ours else Place(field, theirs, ours)


def _of_lists(theirs: list[Any], ours: list[Any], bound: float, field: str, size: float) -> Place | None:
    if len(theirs) != len(ours):
        return Place(f"{field}.len", theirs, ours)
    flat = bool(theirs) and all(isinstance(value, (int, float)) for value in theirs)
    if flat and len(theirs) == _TURN and _opposite(theirs, ours):
        ours = [-value for value in ours]
    if flat and len(theirs) in _VECTORS:
        size = max(map(_size, (*theirs, *ours)))
    # Vectors are one field; of other lists the place counts.
    one = flat and len(theirs) <= max(_VECTORS)
    for number, (a, b) in enumerate(zip(theirs, ours, strict=True)):
        place = first_difference(a, b, bound, field if one else f"{field}.{number}", size)
        if place:
            return Place(place.field, theirs, ours, place.error) if flat and len(theirs) < _SHORT else place
    return None


def _of_numbers(theirs: float, ours: float, bound: float, field: str, size: float) -> Place | None:
    if theirs == ours or (math.isnan(theirs) and math.isnan(ours)):
        return None
    if math.isnan(theirs) or math.isnan(ours):
        return Place(f"{field}.nan", theirs, ours)
    error = abs(theirs - ours) / (1 + max(abs(theirs), abs(ours), size))
    return None if error <= bound else Place(field, theirs, ours, error)


def _opposite(theirs: list[Any], ours: list[Any]) -> bool:
    """Whether two quaternions of half a turn have opposite signs."""
    half = abs(theirs[3]) < _NO_TURN_BUT_HALF and abs(math.hypot(*theirs) - 1) < _LENGTH_1
    return half and sum(a * b for a, b in zip(theirs, ours, strict=True)) < 0


def _size(value: Any) -> float:
    return abs(value) if math.isfinite(value) else 0.0


def numbers(value: Any) -> Iterator[float]:
    """All numbers in a value."""
    if isinstance(value, list):
        for part in value:
            yield from numbers(part)
    elif isinstance(value, float):
        yield value


def lost(value: Any) -> bool:
    """Whether there is a number in a value that is none."""
    return any(math.isnan(number) for number in numbers(value))
