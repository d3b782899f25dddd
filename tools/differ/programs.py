"""Programs: lists of calls of `pybullet`, which refer to what earlier ones returned.

An argument `{"$": 3}` is the id that call number 3 returned, `{"$": 3, "i": 1}` the second of the ids it
returned, and `{"whole": 3}` all that it returned. Functions whose names begin with @ are `perform.py`'s own.
"""

from __future__ import annotations

from typing import Any, TypedDict


class Call(TypedDict):
    """One call: function, arguments, keyword arguments, and its number, by which later ones refer to it."""

    f: str
    a: list[Any]
    k: dict[str, Any]
    id: int


def references(argument: Any) -> set[int]:
    """Numbers of the calls whose results an argument takes."""
    if isinstance(argument, dict):
        own = {argument[key] for key in ("$", "whole") if key in argument}
        return own or set[int]().union(*map(references, argument.values()))
    if isinstance(argument, list):
        return set[int]().union(*map(references, argument))
    return set()


def all_references(call: Call) -> set[int]:
    """Numbers of the calls whose results a call takes."""
    return references(call["a"]) | references(call["k"])


def closed(calls: list[Call]) -> list[Call]:
    """The calls without those that refer to others that are not there."""
    there: set[int] = set()
    kept: list[Call] = []
    for call in calls:
        if all_references(call) <= there:
            there.add(call["id"])
            kept.append(call)
    return kept


_PROBE = (
    "print([(p.getBasePositionAndOrientation(b), p.getBaseVelocity(b), "
    "[p.getJointStateMultiDof(b, j) for j in range(p.getNumJoints(b))]) for b in range(p.getNumBodies())])"
)


def script(calls: list[Call]) -> str:
    """A program as a script of Python, which prints what its last call returns."""
    used = set[int]().union(*map(all_references, calls))
    lines = ["import sys", "", "import pybullet as p", "", "p.connect(p.DIRECT)"]
    lines.append("p.setAdditionalSearchPath(sys.argv[1])  # where PyBullet's own files are")
    for call in calls:
        last = call is calls[-1]
        if call["f"].startswith("@"):
            if last:
                lines.append(_PROBE if call["f"] == "@probe" else f"# {call['f']} {_text(call['a'])}")
            continue
        arguments = [*map(_text, call["a"]), *(f"{name}={_text(value)}" for name, value in call["k"].items())]
        made = f"p.{call['f']}({', '.join(arguments)})"
        if last:
            made = f"print({made})"
        elif call["id"] in used:
            made = f"r{call['id']} = {made}"
        lines.append(made)
    return "\n".join(lines) + "\n"


def _text(argument: Any) -> str:
    if isinstance(argument, dict):
        if "whole" in argument:
            return f"r{argument['whole']}"
        return f"r{argument['$']}" + (f"[{argument['i']}]" if "i" in argument else "")
    if isinstance(argument, list):
        return f"[{', '.join(map(_text, argument))}]"
    return repr(argument)
