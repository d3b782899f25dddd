"""Writes the overloads of functions of the drop-in from their signatures: `python tools/overloads.py`.

A parameter of such a function is stated once, in the function itself. Here is what its overloads have
differently: `exported_requiring` says that a function's body may be called `bodyIndex`, and `VARIANTS` which
arguments decide what another returns.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

DROP_IN = Path(__file__).parents[1] / "src" / "pybullet"


class Variant(NamedTuple):
    """An overload.

    Attributes:
        parameters: What it states in place of the declaration of a parameter, by its name.
        result: What it returns.
    """

    parameters: dict[str, str]
    result: str


def _by_velocity(plain: str, moving: str, either: str) -> tuple[Variant, ...]:
    """Overloads by whether velocities are asked for."""
    return (
        Variant({"computeLinkVelocity": "Literal[0, False] = 0"}, plain),
        Variant({"computeLinkVelocity": "Literal[1, True]"}, moving),
        Variant({"computeLinkVelocity": "int"}, either),
    )


VARIANTS: dict[str, tuple[Variant, ...]] = {
    "createMultiBody": (
        Variant({"batchPositions": "None = None"}, "int"),
        Variant({"batchPositions": "Vectors"}, "tuple[int, ...]"),
    ),
    "getLinkState": _by_velocity(
        *("LinkState", "LinkStateWithVelocity", "LinkState | LinkStateWithVelocity")
    ),
    "getLinkStates": _by_velocity(
        *("tuple[LinkState, ...]", "tuple[LinkStateWithVelocity, ...]"),
        "tuple[LinkState | LinkStateWithVelocity, ...]",
    ),
}


def written(text: str) -> str:
    """The text of a module with the overloads that follow from its functions."""
    body = ast.parse(text).body
    functions = {node.name: node for node in body if isinstance(node, ast.FunctionDef)}
    lines: list[str | None] = [*text.splitlines()]
    for name, function in functions.items():
        overloads = [*_overloads(function)]
        if not overloads:
            continue
        for node in body:
            if isinstance(node, ast.FunctionDef) and node.name == name and node is not function:
                lines[_first(node) : node.end_lineno] = [None] * ((node.end_lineno or 0) - _first(node))
        lines[_first(function)] = "\n".join([*overloads, lines[_first(function)] or ""])
    return "\n".join(line for line in lines if line is not None) + "\n"


def _first(node: ast.FunctionDef) -> int:
    """The line of a function's first decorator, from 0."""
    return min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)]) - 1


def _overloads(function: ast.FunctionDef) -> Iterator[str]:
    """The overloads of a function as text, none for most."""
    result = ast.unparse(function.returns) if function.returns is not None else "None"
    for variant in VARIANTS.get(function.name, ()):
        yield _overload(function.name, _declared(function, variant.parameters), variant.result)
    required = _required(function)
    if required:
        # What tells that an argument lacks is the function itself: its defaults are no values.
        asked = {name: _annotation(function, name) for name in [*_declared(function, {})][:required]}
        yield _overload(function.name, _declared(function, asked), result)
        first, *others = _declared(function, asked).items()
        renamed = {"*": "*", "bodyIndex": first[1].replace(first[0], "bodyIndex"), **dict(others)}
        yield _overload(function.name, renamed, result)


def _required(function: ast.FunctionDef) -> int:
    """How many arguments a function requires whose body has two names; 0 for other functions."""
    for mark in function.decorator_list:
        if isinstance(mark, ast.Call) and ast.unparse(mark.func) == "exported_requiring":
            return ast.literal_eval(mark.args[0])
    return 0


def _annotation(function: ast.FunctionDef, name: str) -> str:
    (found,) = (it.annotation for it in function.args.args if it.arg == name)
    assert found is not None, f"{function.name} does not say what {name} is"
    return ast.unparse(found)


def _declared(function: ast.FunctionDef, instead: dict[str, str]) -> dict[str, str]:
    """The positional parameters with some stated differently, by name; `*` before one that would need it."""
    arguments = function.args.args
    defaults = [None] * (len(arguments) - len(function.args.defaults)) + [*function.args.defaults]
    found: dict[str, str] = {}
    has_default = False
    for argument, default in zip(arguments, defaults, strict=True):
        name = argument.arg
        declared = instead.get(name)
        if declared is None:
            value = "" if default is None else f" = {ast.unparse(default)}"
            declared = f"{_annotation(function, name)}{value}"
        if has_default and " = " not in declared and "*" not in found:
            found["*"] = "*"
        has_default |= " = " in declared
        found[name] = f"{name}: {declared}"
    return found


def _overload(name: str, parameters: dict[str, str], result: str) -> str:
    listed = "".join(f"    {parameter},\n" for parameter in parameters.values())
    return f"@overload\ndef {name}(\n{listed}) -> {result}: ..."


def modules() -> Iterator[Path]:
    """The modules of the drop-in with such functions."""
    for path in sorted(DROP_IN.rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        if any(f"\ndef {name}(" in text for name in VARIANTS) or "@exported_requiring(" in text:
            yield path


if __name__ == "__main__":
    for module in modules():
        module.write_text(written(module.read_text(encoding="utf-8")), encoding="utf-8")
