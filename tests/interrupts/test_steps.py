"""A step that is broken off leaves nothing behind that changes the next one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

import pybullet as p
import pybullet_data
from pybullet._clients.clients import clients


@pytest.fixture
def client() -> Iterator[int]:
    number = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    yield number
    p.disconnect(number)


def _build(substeps: int) -> None:
    p.resetSimulation()
    p.setGravity(0, 0, -10)
    p.setPhysicsEngineParameter(numSubSteps=substeps)
    p.loadURDF("plane.urdf")
    for place in range(40):
        p.loadURDF("cube_small.urdf", [0, 0, 0.03 + 0.05 * place])


def _follow() -> list[Any]:
    p.setPhysicsEngineParameter(numSubSteps=0)
    for _ in range(3):
        p.stepSimulation()
    return [p.getBasePositionAndOrientation(body) for body in range(p.getNumBodies())]


def test_substeps_of_a_step_that_was_broken_off_are_forgotten(
    client: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    _build(0)
    expected = _follow()
    p.disconnect(client)
    # In a new world, whose arrays are too short for so many contacts.
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    _build(50)

    def interrupt(short: Any) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(clients[0].world.engine, "_grow", interrupt)
        with pytest.raises(KeyboardInterrupt):
            p.stepSimulation()
    assert _follow() == expected
