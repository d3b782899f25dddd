"""To a type checker, calls with valid arguments give what they are documented to give, never None."""

from __future__ import annotations

import ast
from pathlib import Path

import pybullet as p

MAY_BE_NONE = {"getUserData", "getOverlappingObjects"}
"""Those that find nothing for valid arguments: a text that was removed, an empty box."""


def results() -> dict[str, list[str]]:
    """The annotated results of all functions of the module; of overloaded ones, those of the overloads."""
    overloads: dict[str, list[str]] = {}
    found: dict[str, list[str]] = {}
    for file in Path(p.__file__).parent.rglob("*.py"):
        for node in ast.parse(file.read_text("utf-8")).body:
            if isinstance(node, ast.FunctionDef) and node.returns is not None:
                marks = [ast.unparse(mark) for mark in node.decorator_list]
                if "overload" in marks:
                    overloads.setdefault(node.name, []).append(ast.unparse(node.returns))
                elif any(mark.startswith("exported") for mark in marks):
                    found[node.name] = [ast.unparse(node.returns)]
    return found | overloads


def test_only_those_that_may_find_nothing_may_give_none() -> None:
    found = results()
    assert len(found) > 130
    doubtful = {
        name for name, kinds in found.items() if any("None" in kind and kind != "None" for kind in kinds)
    }
    assert doubtful == MAY_BE_NONE


def test_no_indices_give_none_as_in_pybullet() -> None:
    client = p.connect(p.DIRECT)
    body = p.createMultiBody(1)
    assert p.getJointStates(body, []) is None
    assert p.getJointStatesMultiDof(body, []) is None
    p.disconnect(client)
