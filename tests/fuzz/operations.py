"""Calls to make: those of the surface test, with some of their arguments spoiled."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from random import Random
from typing import Any

from tests.fuzz.values import spoiled
from tests.surface.call import CLIENT, Calls
from tests.surface.calls import CALLS
from tests.surface.perform import Places

# They end the scene, wait for somebody, run in the background, take long, or ask for libraries.
LEFT_OUT = frozenset(
    {
        "connect",
        "disconnect",
        "resetSimulation",
        "setRealTimeSimulation",
        "vhacd",
        "setTimeOut",
        "renderImage",
    }
)
# Called far more often than the rest: what they leave is what has to be right.
OFTEN = ("stepSimulation", "stepSimulation", "stepSimulation", "loadURDF", "createMultiBody", "removeBody")
_BODIES = frozenset(
    {"bodyUniqueId", "objectUniqueId", "bodyA", "bodyB", "parentBodyUniqueId", "childBodyUniqueId"}
)
_MAX_OTHERS = 3


@dataclass(frozen=True)
class Operation:
    """One call."""

    function: str
    arguments: tuple[Any, ...]
    keywords: dict[str, Any]

    def __str__(self) -> str:
        given = [*map(repr, self.arguments), *(f"{name}={value!r}" for name, value in self.keywords.items())]
        return f"p.{self.function}({', '.join(given)})"


def operations(random: Random, places: Places, body_ids: list[int]) -> Iterator[Operation]:
    """Calls without end.

    Args:
        random: Decides about everything.
        places: Where files are.
        body_ids: The bodies there are; kept up to date by the caller.
    """
    names = [name for name in sorted(CALLS) if name not in LEFT_OUT]
    while True:
        name = random.choice(OFTEN) if random.random() < 0.2 else random.choice(names)
        yield _operation(name, CALLS[name], random, places, body_ids)


def _operation(name: str, calls: Calls, random: Random, places: Places, body_ids: list[int]) -> Operation:
    arguments: tuple[Any, ...] = ()
    if calls.forms and random.random() < 0.2:
        form = random.choice(calls.forms)
        arguments, keywords = tuple(map(places.real, form.arguments)), dict(form.keywords)
    else:
        keywords = dict(calls.needed)
        others = list(calls.other)
        for other in random.sample(others, min(random.randint(0, _MAX_OTHERS), len(others))):
            keywords |= {**calls.along.get(other, {}), other: calls.other[other]}
    keywords = {key: places.real(value) for key, value in keywords.items() if key != CLIENT}
    for key in keywords.keys() & _BODIES:
        if body_ids and random.random() < 0.5:
            keywords[key] = random.choice(body_ids)
    if random.random() < 0.6:
        arguments, keywords = _with_spoiled(arguments, keywords, random)
    return Operation(name, arguments, keywords)


def _with_spoiled(
    arguments: tuple[Any, ...], keywords: dict[str, Any], random: Random
) -> tuple[tuple[Any, ...], dict[str, Any]]:
    """The arguments, one or some of them spoiled."""
    share = random.choice((0.2, 0.5))
    spoiled_arguments = tuple(spoiled(it, random) if random.random() < share else it for it in arguments)
    return spoiled_arguments, {
        key: spoiled(value, random) if random.random() < share else value for key, value in keywords.items()
    }
