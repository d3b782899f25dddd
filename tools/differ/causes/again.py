"""Performing a program again, as it is or with calls of our own in it (`perform.OWN`)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from tools.differ.pair import Outcome
from tools.differ.programs import Call


class Performer(Protocol):
    """Performs programs, as `pair.Server` does."""

    def order(self, calls: Sequence[Call]) -> None:
        """Let a program be performed."""
        ...

    def answer(self) -> Outcome:
        """What came of it."""
        ...


def performed(engine: Performer, calls: Sequence[Call]) -> Outcome:
    """What came of a program."""
    engine.order(calls)
    return engine.answer()


def own_call(function: str, *arguments: Any) -> Call:
    """A call of `perform.OWN` that other calls do not refer to."""
    return {"f": function, "a": list(arguments), "k": {}, "id": -1}


def with_contacts_of(
    calls: Sequence[Call], theirs: Outcome, answer: Outcome, places: Sequence[int]
) -> Outcome:
    """Another answer to a program, with the contacts there were at first.

    Args:
        calls: The program.
        theirs: The first answer.
        answer: What came of the program with further calls.
        places: Where its own calls are among these.
    """
    results = list[Any]()
    for call, before, place in zip(calls, theirs["results"], places, strict=False):
        if place >= len(answer["results"]):
            break
        result = answer["results"][place]
        if result[0] == before[0] == "ok" and call["f"] == "@probe":
            result = ["ok", [result[1][0], *before[1][1:]]]
        results.append(result)
    return {"results": results, "died": answer["died"]}
