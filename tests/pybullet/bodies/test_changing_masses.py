"""Masses and inertias that change while a world runs: by the native library, as Python changes them."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import pybullet as p
import pybullet_data
from pybullet._calls.builtin import exports
from pybullet._clients.clients import clients

SHAPES: dict[str, dict[str, Any]] = {
    "box": {"shapeType": p.GEOM_BOX, "halfExtents": [0.1, 0.2, 0.3]},
    "ball": {"shapeType": p.GEOM_SPHERE, "radius": 0.17},
    "capsule": {"shapeType": p.GEOM_CAPSULE, "radius": 0.1, "height": 0.3},
    "cylinder": {"shapeType": p.GEOM_CYLINDER, "radius": 0.13, "height": 0.3},
    "box beside its centre": {
        "shapeType": p.GEOM_BOX, "halfExtents": [0.1, 0.2, 0.3], "collisionFramePosition": [0.01, 0, 0]
    },
}  # fmt: skip
DATA = Path(pybullet_data.getDataPath())
KUKA = str(DATA / "kuka_iiwa" / "model.urdf")


@pytest.fixture
def one() -> Iterator[int]:
    client = p.connect(p.DIRECT)
    yield client
    p.disconnect(client)


def _run_of(client: int, shape: dict[str, Any], mass: float, change: Callable[[int], None]) -> list[Any]:
    p.resetSimulation(physicsClientId=client)
    p.setGravity(0, 0, -10, physicsClientId=client)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client), physicsClientId=client)
    body = p.createMultiBody(
        mass,
        p.createCollisionShape(**shape, physicsClientId=client),
        basePosition=[0, 0, 0.35],
        baseOrientation=p.getQuaternionFromEuler([0.3, 0.2, 0.1]),
        physicsClientId=client,
    )
    change(body)
    for _ in range(60):
        p.stepSimulation(client)
    return [
        p.getDynamicsInfo(body, -1, client)[:3],
        p.getBasePositionAndOrientation(body, client),
        p.getBaseVelocity(body, client),
    ]


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_a_mass_given_later_is_a_mass_given_at_first(one: int, shape: dict[str, Any]) -> None:
    def change(body: int) -> None:
        # The second of these is the native library's.
        for mass in (5.0, 2.7):
            p.changeDynamics(body, -1, mass=mass, physicsClientId=one)

    later = _run_of(one, shape, 1.0, change)
    assert later == _run_of(one, shape, 2.7, lambda _: None)


def _without_python(**changes: Any) -> None:
    function: Any = exports["changeDynamics"].function
    own = function.__code__

    def refuse(*_: Any, **__: Any) -> None:
        raise AssertionError("Python was asked")

    function.__code__ = refuse.__code__  # pyright: ignore[reportFunctionMemberAccess]
    try:
        p.changeDynamics(**changes)
    finally:
        function.__code__ = own


def test_masses_need_no_python_but_once(one: int) -> None:
    robot = p.loadURDF(KUKA, useFixedBase=True, physicsClientId=one)
    link: dict[str, Any] = {"bodyUniqueId": robot, "linkIndex": 3, "physicsClientId": one}
    with pytest.raises(AssertionError):
        _without_python(**link, mass=2)
    p.changeDynamics(**link, mass=1.0)
    _without_python(**link, mass=2)
    _without_python(**link, localInertiaDiagonal=[1, 2, 3])
    _without_python(**link, mass=2.5, localInertiaDiagonal=(1, 2, 3), lateralFriction=0.3)
    info = p.getDynamicsInfo(robot, 3, one)
    assert (info[0], info[1], info[2]) == (2.5, 0.3, (1.0, 2.0, 3.0))
    # What frees a base, or makes something massless, is for Python.
    for changed, mass in ((-1, 1.0), (-1, 0.0), (3, 0.0)):
        p.changeDynamics(robot, changed, mass=mass, physicsClientId=one)
        assert p.getDynamicsInfo(robot, changed, one)[0] == mass


def test_what_follows_from_masses_follows(one: int) -> None:
    robot = p.loadURDF(KUKA, useFixedBase=True, physicsClientId=one)
    p.setGravity(0, 0, -10, physicsClientId=one)

    def torques() -> list[Any]:
        zeros = [0.0] * 7
        return [
            p.calculateInverseDynamics(robot, [0.3] * 7, zeros, [1.0] * 7, physicsClientId=one),
            p.calculateMassMatrix(robot, [0.3] * 7, physicsClientId=one),
        ]

    seen = []
    for mass in (1.0, 2.0, 1.0, 2.0):
        for _ in range(2):
            p.changeDynamics(robot, 5, mass=mass, physicsClientId=one)
        seen.append(torques())
    assert seen[0] == seen[2] != seen[1] == seen[3]


@pytest.fixture
def frozen() -> Iterator[None]:
    """What there is already is no garbage, and would take time to look through."""
    gc.freeze()
    yield
    gc.unfreeze()


@pytest.mark.usefixtures("frozen")
def test_a_body_that_goes_as_its_mass_changes(one: int) -> None:
    """New tuples let Python collect garbage, and what is collected may remove the body."""
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=one)

    class Last:
        def __init__(self, body: int) -> None:
            self.body, self.itself = body, self

        def __del__(self) -> None:
            if p.isConnected(one):
                p.removeBody(self.body, physicsClientId=one)

    threshold = gc.get_threshold()
    for _ in range(20):
        body = p.createMultiBody(1.0, box, physicsClientId=one)
        p.changeDynamics(body, -1, mass=2.0, physicsClientId=one)
        Last(body)
        gc.set_threshold(1)
        try:
            for mass in range(1, 20):
                p.changeDynamics(body, -1, mass=mass, physicsClientId=one)
        finally:
            gc.set_threshold(*threshold)
        gc.collect()
        assert body not in clients[one].world.bodies


def test_a_body_that_was_made_massless_moves_again_with_a_mass(one: int) -> None:
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1, physicsClientId=one)
    body = p.createMultiBody(1.0, ball, basePosition=[0, 0, 5], physicsClientId=one)
    p.setGravity(0, 0, -10, physicsClientId=one)
    # The native library knows how its moments follow from its mass from the first of these on.
    for mass in (2.0, 0.0, 3.0):
        p.changeDynamics(body, -1, mass=mass, physicsClientId=one)
        p.resetBasePositionAndOrientation(body, [0, 0, 5], [0, 0, 0, 1], physicsClientId=one)
        for _ in range(10):
            p.stepSimulation(one)
        assert (p.getBasePositionAndOrientation(body, one)[0][2] < 5.0) == (mass > 0.0)
        assert p.getDynamicsInfo(body, -1, one)[0] == mass
