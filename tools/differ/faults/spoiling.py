"""How a module is spoiled: other results, other arguments, or another step."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Any, cast

Function = Callable[..., Any]
Changes = dict[str, Function]


@dataclass(frozen=True)
class Fault:
    """One thing that is spoiled.

    Attributes:
        name: Of the fault.
        section: The part of the API it belongs to.
        changes: Of a module, the functions that are put in place of its own. It is called for each program.
        functions: The names of those functions: programs that call none of them are as they were.
        blind: Why the fuzzer cannot find it; empty if it has to.
    """

    name: str
    section: str
    changes: Callable[[Any], Changes]
    functions: frozenset[str]
    blind: str = ""


class Spoiled:
    """A module some of whose functions are others.

    Args:
        module: The module.
        changes: The functions in place of its own.
    """

    def __init__(self, module: Any, changes: Mapping[str, Function]) -> None:
        self._module = module
        self.__dict__.update(changes)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._module, name)


def result(name: str, section: str, functions: str, change: Function, blind: str = "") -> Fault:
    """A fault in what functions return, where it is not None.

    Args:
        name: Of the fault.
        section: The part of the API.
        functions: Names, apart by spaces.
        change: What is returned in place of a result: it is given the result, then the arguments.
        blind: Why the fuzzer cannot find it.
    """

    def changes(module: Any) -> Changes:
        def spoiled(function: Function) -> Function:
            def call(*arguments: Any, **keywords: Any) -> Any:
                value = function(*arguments, **keywords)
                return None if value is None else change(value, *arguments, **keywords)

            return call

        return {function: spoiled(getattr(module, function)) for function in functions.split()}

    return Fault(name, section, changes, frozenset(functions.split()), blind)


def arguments(name: str, section: str, functions: str, change: Function, blind: str = "") -> Fault:
    """A fault in what functions are given.

    Args:
        name: Of the fault.
        section: The part of the API.
        functions: Names, apart by spaces.
        change: Given a list of arguments and a dictionary of keywords, it changes these.
        blind: Why the fuzzer cannot find it.
    """

    def changes(module: Any) -> Changes:
        def spoiled(function: Function) -> Function:
            def call(*given: Any, **keywords: Any) -> Any:
                listed = list(given)
                change(listed, keywords)
                return function(*listed, **keywords)

            return call

        return {function: spoiled(getattr(module, function)) for function in functions.split()}

    return Fault(name, section, changes, frozenset(functions.split()), blind)


def step(name: str, section: str, change: Callable[[Any], None], blind: str = "") -> Fault:
    """A fault in each step: what is done right after it, to the module."""

    def changes(module: Any) -> Changes:
        def call(*given: Any, **keywords: Any) -> Any:
            value = module.stepSimulation(*given, **keywords)
            change(module)
            return value

        return {"stepSimulation": call}

    return Fault(name, section, changes, frozenset({"stepSimulation"}), blind)


def scaled(*keywords: str, by: float, place: int | None = None) -> Function:
    """A change of arguments: those keywords, or the argument at a place, so many times what they are."""

    def change(given: list[Any], named: dict[str, Any]) -> None:
        for keyword in keywords:
            if keyword in named:
                named[keyword] = times(named[keyword], by)
        if place is not None and len(given) > place:
            given[place] = times(given[place], by)

    return change


def without(*keywords: str) -> Function:
    """A change of arguments: those keywords are left out."""

    def change(_: list[Any], named: dict[str, Any]) -> None:
        for keyword in keywords:
            named.pop(keyword, None)

    return change


def times(value: Any, by: float) -> Any:
    """Numbers, in whatever lists, so many times what they are."""
    return each(value, lambda number: number * by)


def plus(value: Any, more: float) -> Any:
    """Numbers, in whatever lists, greater by so much."""
    return each(value, lambda number: number + more)


def each(value: Any, change: Callable[[float], float]) -> Any:
    """Numbers, in whatever lists and tuples, changed; those of NumPy as well."""
    if isinstance(value, (list, tuple)):
        return type(value)([each(part, change) for part in value])
    # Single precision of NumPy is no `float`.
    return change(cast("float", value)) if isinstance(value, Real) else value


def put(value: Sequence[Any], place: int, part: Any) -> tuple[Any, ...]:
    """A tuple with another part at a place."""
    return (*value[:place], part, *value[place + 1 :])


def of_each(place: int, change: Function) -> Function:
    """A change of results that are lists of tuples: the part at a place of each."""
    return lambda value, *_, **__: tuple(put(one, place, change(one[place])) for one in value)


def of_one(place: int, change: Function) -> Function:
    """A change of a result that is a tuple: the part at a place."""
    return lambda value, *_, **__: put(value, place, change(value[place]))


def moving(module: Any) -> Iterator[int]:
    """The ids of the bodies whose bases have a mass."""
    for place in range(module.getNumBodies()):
        body = module.getBodyUniqueId(place)
        if module.getDynamicsInfo(body, -1)[0] > 0.0:
            yield body
