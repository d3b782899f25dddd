"""The names, signatures and kinds of what the module offers, against what real PyBullet offers."""

import inspect
import json
import pickle
from functools import partial
from pathlib import Path

import pytest
from tests.each import each

import pybullet as p

HERE = Path(__file__).parent
SURFACE = json.loads((HERE / "surface.json").read_text())
SIGNATURES = {
    name: entry["parameters"]
    for name, entry in json.loads((HERE.parent / "surface" / "table.json").read_text()).items()
    if entry["parameters"] is not None and name not in ("submitProfileTiming", "syncUserData")
}
FUNCTIONS = SURFACE["functions"]


def test_there_are_all_functions_and_constants() -> None:
    assert len(FUNCTIONS) == 144
    assert len(SURFACE["constants"]) == 167


def test_nothing_else_is_public() -> None:
    public = {name for name in vars(p) if not name.startswith("_")}
    assert public == {*FUNCTIONS, *SURFACE["constants"], "error"}


@each("name", FUNCTIONS)
def test_every_function_is_a_builtin(name: str) -> None:
    function = getattr(p, name)
    assert inspect.isbuiltin(function)
    assert function.__name__ == name
    assert function.__module__ == "pybullet"
    assert inspect.getdoc(function)


@each("name", SURFACE["constants"])
def test_every_constant_is_the_plain_integer(name: str) -> None:
    value = getattr(p, name)
    assert type(value) is int
    assert value == SURFACE["constants"][name]


@each("name", SIGNATURES)
def test_signatures_are_those_of_pybullet(name: str) -> None:
    shown = inspect.signature(getattr(p, name)).parameters.values()
    expected = [
        (parameter[0], *(_frozen(value) for value in parameter[1:])) for parameter in SIGNATURES[name]
    ]
    assert [_described(parameter) for parameter in shown] == expected


def test_every_function_takes_a_client_except_one_that_takes_positions_only() -> None:
    without = [n for n in FUNCTIONS if "physicsClientId" not in inspect.signature(getattr(p, n)).parameters]
    # connect makes the client; the other is not available.
    assert without == ["connect", "renderImage"]


def test_error_is_an_exception_of_its_own() -> None:
    assert p.error.__mro__ == (p.error, Exception, BaseException, object)
    assert str(p.error) == "<class 'pybullet.error'>"
    assert pickle.loads(pickle.dumps(p.error("text"))).args == ("text",)


def test_wrong_keywords_and_missing_arguments_are_type_errors(client: int) -> None:
    with pytest.raises(TypeError, match="foo"):
        p.getNumBodies(foo=1)  # pyright: ignore[reportCallIssue]
    with pytest.raises(TypeError, match="gravZ"):
        p.setGravity(0, 0)  # pyright: ignore[reportCallIssue]
    with pytest.raises(TypeError, match="controlMode"):
        p.setJointMotorControl2(0, 0)  # pyright: ignore[reportCallIssue]


def test_builtins_work_with_partial_and_by_keyword(client: int) -> None:
    other = p.connect(p.DIRECT)
    partial(p.setGravity, physicsClientId=other)(gravX=1, gravY=2, gravZ=3)
    assert p.getPhysicsEngineParameters(other)["gravityAccelerationZ"] == 3.0
    assert p.getPhysicsEngineParameters(client)["gravityAccelerationZ"] == 0.0


def _described(parameter: inspect.Parameter) -> tuple[object, ...]:
    if parameter.default is inspect.Parameter.empty:
        return (parameter.name,)
    return (parameter.name, parameter.default)


def _frozen(value: object) -> object:
    return tuple(value) if isinstance(value, list) else value
