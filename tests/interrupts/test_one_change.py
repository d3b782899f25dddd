"""Functions of PyBullet that make one change: what comes in the middle of them is before it or after it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import pytest
from tests.interrupts.test_prepared_changes import at_lines
from tests.rings import few

import pybullet as p
from pybullet._calls.conduct import COMMITS

_FRAMES = [0, 0, 0], [0, 0, 0], [0, 0, 1]


@pytest.fixture
def client() -> Iterator[int]:
    number = p.connect(p.DIRECT)
    for x in (0, 1):
        p.createMultiBody(1.0, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), basePosition=[x, 0, 1])
    yield number
    p.disconnect(number)


def _constrain() -> int:
    return p.createConstraint(0, -1, -1, -1, p.JOINT_POINT2POINT, *_FRAMES)


def _let_go(number: int) -> None:
    # An unknown number is no error.
    p.removeConstraint(number)


def _replace(number: int) -> None:
    _let_go(number)
    _constrain()


def _numbers() -> list[int]:
    return [p.getConstraintUniqueId(place) for place in range(p.getNumConstraints())]


# Each with what comes in the middle; the scene is to be as after both of them in turn, whichever is first.
CALLS: dict[str, tuple[Callable[[], Any], Callable[[], Any]]] = {
    "setGravity": (lambda: p.setGravity(0, 0, -2), lambda: p.setGravity(0, 0, -3)),
    "createConstraint": (_constrain, _constrain),
    "createConstraint for a body that goes": (
        lambda: p.createConstraint(0, -1, 1, -1, p.JOINT_FIXED, *_FRAMES),
        lambda: p.removeBody(1),
    ),
    "createConstraint in the place of another": (lambda: _replace(1), p.performCollisionDetection),
    "createConstraint in the place of one that goes": (lambda: _replace(1), lambda: _let_go(2)),
    "createConstraint with other parameters": (
        lambda: _replace(1),
        lambda: p.setPhysicsEngineParameter(numSolverIterations=1, erp=0.7),
    ),
    "changeConstraint": (lambda: p.changeConstraint(1, [0, 0, 2]), lambda: _let_go(1)),
    "changeConstraint of another force": (
        lambda: p.changeConstraint(1, maxForce=2),
        lambda: p.changeConstraint(1, [0, 0, 3], maxForce=3),
    ),
    "removeConstraint": (lambda: _let_go(1), lambda: _let_go(1)),
    "removeConstraint of many": (lambda: _let_go(1), _constrain),
}


def _made() -> None:
    p.resetSimulation()
    for x in (0, 1):
        p.createMultiBody(1.0, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), basePosition=[x, 0, 1])
    _constrain()
    p.stepSimulation()


@cache
def _compile_methods() -> None:
    """Let data classes have their methods compiled, as with the 200th object: calls then have fewer lines."""
    for _ in range(250):
        _made()


def _attempt(call: Callable[[], Any]) -> None:
    try:
        call()
    except p.error as problem:
        assert "body" in str(problem)


def _scene() -> Any:
    """All there is, once a step has shown that it fits together."""
    numbers = _numbers()
    info = [p.getConstraintInfo(number) for number in numbers]
    p.stepSimulation()
    bodies = [p.getBasePositionAndOrientation(body) for body in range(p.getNumBodies())]
    return numbers, info, bodies, p.getPhysicsEngineParameters()["gravityAccelerationZ"]


def test_all_functions_of_one_change_are_tried() -> None:
    assert {name.partition(" ")[0] for name in CALLS} == COMMITS


@pytest.mark.usefixtures("client")
@pytest.mark.parametrize("name", few(CALLS, 4))
def test_what_comes_at_any_line_of_a_call_is_before_or_after_it(name: str) -> None:
    call, other = CALLS[name]
    orders = []
    for first, second in ((call, other), (other, call)):
        _made()
        _attempt(first)
        _attempt(second)
        orders.append(_scene())
    _compile_methods()
    _made()
    lines = 0

    def count() -> None:
        nonlocal lines
        lines += 1

    at_lines(lambda: _attempt(call), count)
    for place in range(1, lines + 1):
        _made()
        left = place

        def come() -> None:
            nonlocal left
            left -= 1
            if left == 0:
                _attempt(other)

        at_lines(lambda: _attempt(call), come)
        assert _scene() in orders, place
