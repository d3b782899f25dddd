"""Arguments that remove the body they belong to, when they are looked at."""

from collections.abc import Callable
from typing import Any

import pytest

import pybullet as p


class Removing:
    """A number that removes a body first."""

    def __init__(self, body: int) -> None:
        self._body = body

    def __float__(self) -> float:
        p.removeBody(self._body)
        return 0.0


# Numbers that are none, for the type checker.
CALLS: dict[str, Callable[[int, Any], object]] = {
    "position": lambda body, zero: p.resetBasePositionAndOrientation(body, [zero, 0, 0], [0, 0, 0, 1]),
    "orientation": lambda body, zero: p.resetBasePositionAndOrientation(body, [0, 0, 0], [zero, 0, 0, 1]),
    "linear": lambda body, zero: p.resetBaseVelocity(body, linearVelocity=[0, zero, 0]),
    "angular": lambda body, zero: p.resetBaseVelocity(body, angularVelocity=[0, 0, zero]),
}


@pytest.mark.parametrize("name", CALLS)
def test_a_body_that_an_argument_removes_is_missed_as_others_are(client: int, name: str) -> None:
    body = p.createMultiBody(1)
    other = p.createMultiBody(1, basePosition=[1, 2, 3])
    with pytest.raises(p.error, match=rf"^There is no body {body}\.$"):
        CALLS[name](body, Removing(body))
    assert p.getBasePositionAndOrientation(other) == ((1, 2, 3), (0, 0, 0, 1))
