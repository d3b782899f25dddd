"""Kinds of values in the header of a message: each checks a value of JSON, and has a type in TypeScript."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

Bounds = tuple[float, float]
"""Least and greatest value of a number, both included."""


@dataclass(frozen=True, eq=False, slots=True)
class Kind:
    """A kind of value.

    Attributes:
        typescript: Its type on the page.
        holds: Whether a value is of the kind.
        bounds: Of all numbers in it; None if it has none, or they may be any.
    """

    typescript: str
    holds: Callable[[Any], bool]
    bounds: Bounds | None = None

    def __str__(self) -> str:
        if self.bounds is None:
            return self.typescript
        lower, upper = self.bounds
        return f"{self.typescript} from {lower:g} to {upper:g}"


def number(lower: float, upper: float) -> Kind:
    """Finite numbers within bounds."""
    return Kind("number", lambda value: _is_number(value) and lower <= value <= upper, (lower, upper))


def whole(lower: int, upper: int) -> Kind:
    """Whole numbers within bounds."""
    return Kind("number", lambda value: _is_whole(value) and lower <= value <= upper, (lower, upper))


def listed(kind: Kind) -> Kind:
    """Lists of any length."""
    return Kind(
        f"{_grouped(kind)}[]", lambda value: _is_list(value) and all(map(kind.holds, value)), kind.bounds
    )


def several(*kinds: Kind) -> Kind:
    """Lists with one value of each kind, in this order."""

    def holds(value: Any) -> bool:
        return (
            _is_list(value)
            and len(value) == len(kinds)
            and all(kind.holds(each) for kind, each in zip(kinds, value, strict=True))
        )

    return Kind(f"[{', '.join(kind.typescript for kind in kinds)}]", holds, _common_bounds(kinds))


def one_of(*texts: str) -> Kind:
    """One of some texts."""
    return Kind(" | ".join(f'"{text}"' for text in texts), lambda value: value in texts)


def either(*kinds: Kind) -> Kind:
    """A value of one of several kinds."""
    return Kind(
        " | ".join(kind.typescript for kind in kinds),
        lambda value: any(kind.holds(value) for kind in kinds),
        _common_bounds(kinds),
    )


def by_name(kind: Kind) -> Kind:
    """An object with any names and values of one kind."""
    return Kind(
        f"Record<string, {kind.typescript}>",
        lambda value: isinstance(value, Mapping) and all(map(kind.holds, value.values())),
        kind.bounds,
    )


def record(fields: Mapping[str, Kind], extra: Mapping[str, Kind] | None = None) -> Kind:
    """An object with these fields; it may have the extra ones as well, and no others."""
    extra = extra or {}
    known = {**fields, **extra}
    parts = [f"{name}: {kind.typescript}" for name, kind in fields.items()]
    parts += [f"{name}?: {kind.typescript}" for name, kind in extra.items()]

    def holds(value: Any) -> bool:
        return (
            isinstance(value, Mapping)
            and fields.keys() <= value.keys() <= known.keys()
            and all(known[name].holds(each) for name, each in value.items())
        )

    return Kind(f"{{ {', '.join(parts)} }}", holds, _common_bounds(known.values()))


def maybe(kind: Kind) -> Kind:
    """A value, or null."""
    return Kind(f"{kind.typescript} | null", lambda value: value is None or kind.holds(value), kind.bounds)


def _common_bounds(kinds: Iterable[Kind]) -> Bounds | None:
    """The bounds of what consists of several kinds: a page knows one pair of them for each field."""
    bounds = {kind.bounds for kind in kinds if "number" in kind.typescript}
    if len(bounds) > 1:
        raise ValueError(f"numbers of one field have to have the same bounds, not {sorted(map(str, bounds))}")
    return bounds.pop() if bounds else None


def _grouped(kind: Kind) -> str:
    return (
        kind.typescript
        if kind.typescript[0] in "[{" or " | " not in kind.typescript
        else f"({kind.typescript})"
    )


def _is_list(value: Any) -> bool:
    return isinstance(value, (list, tuple))


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _is_whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


NUMBER = Kind("number", _is_number)
WHOLE = Kind("number", _is_whole)
STRING = Kind("string", lambda value: isinstance(value, str))
FLAG = Kind("boolean", lambda value: isinstance(value, bool))
PAIR = several(NUMBER, NUMBER)
VECTOR = several(NUMBER, NUMBER, NUMBER)
QUATERNION = several(NUMBER, NUMBER, NUMBER, NUMBER)
MATRIX = Kind("number[]", lambda value: _is_list(value) and len(value) == 16 and all(map(_is_number, value)))
