"""Kinds of values in the header of a message: each checks a value of JSON, and has a type in TypeScript."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from carom.lazy_dataclasses import dataclass


@dataclass(frozen=True, eq=False, slots=True)
class Kind:
    """A kind of value.

    Attributes:
        typescript: Its type on the page.
        holds: Whether a value is of the kind.
    """

    typescript: str
    holds: Callable[[Any], bool]


def listed(kind: Kind) -> Kind:
    """Lists of any length."""
    return Kind(f"{_grouped(kind)}[]", lambda value: _is_list(value) and all(map(kind.holds, value)))


def several(*kinds: Kind) -> Kind:
    """Lists with one value of each kind, in this order."""

    def holds(value: Any) -> bool:
        return (
            _is_list(value)
            and len(value) == len(kinds)
            and all(kind.holds(each) for kind, each in zip(kinds, value, strict=True))
        )

    return Kind(f"[{', '.join(kind.typescript for kind in kinds)}]", holds)


def one_of(*texts: str) -> Kind:
    """One of some texts."""
    return Kind(" | ".join(f'"{text}"' for text in texts), lambda value: value in texts)


def either(*kinds: Kind) -> Kind:
    """A value of one of several kinds."""
    return Kind(
        " | ".join(kind.typescript for kind in kinds),
        lambda value: any(kind.holds(value) for kind in kinds),
    )


def by_name(kind: Kind) -> Kind:
    """An object with any names and values of one kind."""
    return Kind(
        f"Record<string, {kind.typescript}>",
        lambda value: isinstance(value, Mapping) and all(map(kind.holds, value.values())),
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

    return Kind(f"{{ {', '.join(parts)} }}", holds)


def maybe(kind: Kind) -> Kind:
    """A value, or null."""
    return Kind(f"{kind.typescript} | null", lambda value: value is None or kind.holds(value))


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


NUMBER = Kind("number", _is_number)
WHOLE = Kind("number", lambda value: isinstance(value, int) and not isinstance(value, bool))
STRING = Kind("string", lambda value: isinstance(value, str))
FLAG = Kind("boolean", lambda value: isinstance(value, bool))
PAIR = several(NUMBER, NUMBER)
VECTOR = several(NUMBER, NUMBER, NUMBER)
QUATERNION = several(NUMBER, NUMBER, NUMBER, NUMBER)
MATRIX = Kind("number[]", lambda value: _is_list(value) and len(value) == 16 and all(map(_is_number, value)))
