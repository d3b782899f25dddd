"""How a function is to be called: the table from which the calls of the surface test are made."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

TABLE: dict[str, dict[str, Any]] = json.loads(Path(__file__).with_name("table.json").read_text())
"""Of each function: its parameters, with defaults where they have some, and its own error texts."""

CLIENT = "physicsClientId"
NOBODY = 77
"""A client that does not exist."""


@dataclass(frozen=True)
class Call:
    """One call.

    Attributes:
        title: What is tried.
        arguments: By position.
        keywords: By name.
    """

    title: str
    arguments: Sequence[Any] = ()
    keywords: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Calls:
    """Arguments for the calls of one function in the scene.

    Attributes:
        needed: Arguments it cannot do without.
        other: Of every other argument, a value that is not its default.
        along: What else has to be given along with one of those for it to count, by its name.
        forms: Further ways of calling it.
        bad: Calls that are wrong: what to change of the needed arguments, or a whole call.
        first: Calls of other functions that come before: their name and arguments.
    """

    needed: Mapping[str, Any] = field(default_factory=dict)
    other: Mapping[str, Any] = field(default_factory=dict)
    along: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    forms: Sequence[Call] = ()
    bad: Sequence[Mapping[str, Any] | Call] = ()
    first: Sequence[tuple[Any, ...]] = ()

    def each(self, function: str) -> Iterator[Call]:
        """The calls, as the table says that the function has to be called."""
        parameters = TABLE[function]["parameters"]
        if parameters is not None:
            yield Call("needed", (), self.needed)
            yield Call("by position", *self._by_position(parameters))
            for name, *_ in parameters:
                if name in self.other:
                    along = self.along.get(name, {})
                    yield Call(f"keyword {name}", (), {**self.needed, **along, name: self.other[name]})
            if self.needed:
                last = list(self.needed)[-1]
                yield Call(f"without {last}", (), {k: v for k, v in self.needed.items() if k != last})
            yield Call("unknown keyword", (), {**self.needed, "foo": 1})
            if any(name == CLIENT for name, *_ in parameters):
                yield Call("not connected", (), {**self.needed, CLIENT: NOBODY})
        yield from self.forms
        for number, bad in enumerate(self.bad):
            if isinstance(bad, Call):
                yield bad
            else:
                said = ", ".join(f"{name}={_short(value)}" for name, value in bad.items())
                yield Call(f"bad {number}: {said}", (), {**self.needed, **bad})

    def _by_position(self, parameters: Sequence[Sequence[Any]]) -> tuple[list[Any], dict[str, Any]]:
        """All arguments in order, those that are not needed with their documented defaults."""
        # PyBullet takes None for a list that is not given, but not everywhere.
        given = [self.needed.get(name, *default) for name, *default in parameters if name != CLIENT]
        while given and given[-1] is None:
            given.pop()
        if None in given:
            names = [name for name, *_ in parameters]
            first = given.index(None)
            return given[:first], {
                n: v for n, v in zip(names[first:], given[first:], strict=False) if v is not None
            }
        return given, {}


def _short(value: Any) -> str:
    said = repr(value)
    return said if len(said) <= 30 else f"{said[:27]}..."
