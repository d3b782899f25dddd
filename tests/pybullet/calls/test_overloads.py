"""Overloads follow from the signatures of functions, and arguments of `changeDynamics` from the table."""

from __future__ import annotations

import ast
import inspect
import runpy
from pathlib import Path

import pytest

import pybullet as p
from carom.layouts.dynamics_parameters import PARAMETERS

TOOL = runpy.run_path(str(Path(__file__).parents[3] / "tools" / "overloads.py"))
STATED = '''
@exported_requiring(2)
def f(bodyUniqueId: int = NOT_GIVEN, place: Vector = NOT_GIVEN, force: float = 1.0) -> None:
    """..."""
'''


def overloads(text: str) -> list[str]:
    """The parameters of all overloads in a module."""
    functions = [node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)]
    marked = [node for node in functions if [*map(ast.unparse, node.decorator_list)] == ["overload"]]
    return [ast.unparse(node.args) for node in marked]


def test_overloads_are_those_that_signatures_give() -> None:
    modules = [*TOOL["modules"]()]
    assert len(modules) == 5
    for path in modules:
        text = path.read_text(encoding="utf-8")
        assert text == TOOL["written"](text), f"{path}: run python tools/overloads.py"


def test_a_new_parameter_is_in_both_overloads() -> None:
    first = TOOL["written"](STATED)
    assert overloads(first) == [
        "bodyUniqueId: int, place: Vector, force: float=1.0",
        "*, bodyIndex: int, place: Vector, force: float=1.0",
    ]
    changed = TOOL["written"](
        first.replace("force: float = 1.0) ->", "force: float = 1.0, flags: int = 0) ->")
    )
    assert [text.endswith("flags: int=0") for text in overloads(changed)] == [True, True]
    assert TOOL["written"](changed) == changed


def test_an_argument_that_decides_on_the_result_is_by_name_if_it_has_to_be() -> None:
    text = (
        "@exported\ndef createMultiBody(mass: float = 0, batchPositions: Vectors | None = None) -> int: ...\n"
    )
    assert overloads(TOOL["written"](text)) == [
        "mass: float=0, batchPositions: None=None",
        "mass: float=0, *, batchPositions: Vectors",
    ]


def test_change_dynamics_takes_each_number_of_the_table_once() -> None:
    from pybullet._bodies import dynamics

    numbers = {row.argument for row in PARAMETERS.values() if row.argument and row.kind in "ri"}
    limits = {"jointLimitForce", "sleepThreshold", "jointLowerLimit", "jointUpperLimit"}
    assert {*dynamics._IN_ORDER} == numbers - limits
    assert len(dynamics._IN_ORDER) == len({*dynamics._IN_ORDER})


@pytest.mark.parametrize("name", ["setJointMotorControl2", "calculateInverseDynamics"])
def test_what_is_required_is_shown_without_a_default(name: str) -> None:
    first = next(iter(inspect.signature(getattr(p, name)).parameters.values()))
    assert first.name == "bodyUniqueId"
    assert first.default is inspect.Parameter.empty
