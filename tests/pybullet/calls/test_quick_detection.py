"""`performCollisionDetection` in the native library finds what Python finds, bit for bit."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from random import Random
from typing import Any

import pytest

import pybullet as p
import pybullet_data
from pybullet._calls.builtin import exports
from pybullet._clients.clients import clients

Detect = Callable[..., None]
IN_PYTHON: Detect = exports["performCollisionDetection"].function


@pytest.fixture
def client() -> Iterator[int]:
    connection = p.connect(p.DIRECT)
    yield connection
    p.disconnect(connection)


@pytest.fixture
def two() -> Iterator[tuple[int, int]]:
    pair = p.connect(p.DIRECT), p.connect(p.DIRECT)
    yield pair
    for connection in pair:
        p.disconnect(connection)


def _boxes(client: int, count: int) -> list[int]:
    p.loadURDF(f"{pybullet_data.getDataPath()}/plane.urdf", physicsClientId=client)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=client)
    return [
        p.createMultiBody(1.0, shape, -1, [0.5 * place, 0, 0.0999], physicsClientId=client)
        for place in range(count)
    ]


def _is_quick(client: int) -> bool:
    return bool(clients[client].world.quick.record.detection.run)


def _found(client: int) -> Any:
    return p.getContactPoints(physicsClientId=client), clients[client].world.link_pose_memory.tobytes()


@pytest.mark.parametrize("fast", [False, True], ids=["", "with continuous detection"])
def test_the_same_is_found_after_any_moves(fast: bool, two: tuple[int, int]):
    random = Random(4)
    boxes, _ = (_boxes(client, 12) for client in two)
    for box in boxes[:3] if fast else ():
        for client in two:
            p.changeDynamics(box, -1, ccdSweptSphereRadius=0.02, physicsClientId=client)
    for _ in range(40):
        pose = [random.uniform(0, 0.4), random.uniform(0, 0.4), random.uniform(0.05, 0.3)]
        turn = p.getQuaternionFromEuler([random.uniform(-3, 3) for _ in range(3)])
        box, steps = random.choice(boxes), random.randrange(2)
        for client, detect in zip(two, (p.performCollisionDetection, IN_PYTHON), strict=True):
            p.resetBasePositionAndOrientation(box, pose, turn, physicsClientId=client)
            for _ in range(steps):
                p.stepSimulation(client)
            detect(physicsClientId=client)
            detect(physicsClientId=client)
        assert _found(two[0]) == _found(two[1])
    assert _is_quick(two[0])
    assert len(p.getContactPoints(physicsClientId=two[0])) > 20


def test_python_takes_over_where_arrays_are_too_short(two: tuple[int, int]):
    for client, detect in zip(two, (p.performCollisionDetection, IN_PYTHON), strict=True):
        boxes = _boxes(client, 12)
        detect(client)
        detect(client)
        assert _is_quick(client)
        room = clients[client].world.contact_arrays.contacts.capacity["contact"]
        for place, box in enumerate(boxes):
            pose = [0.05 * place, 0.02 * place, 0.08]
            p.resetBasePositionAndOrientation(box, pose, [0, 0, 0.1 * place, 1], physicsClientId=client)
        detect(client)
        assert len(p.getContactPoints(physicsClientId=client)) > room
    assert _found(two[0]) == _found(two[1])


def test_settings_that_wait_for_the_next_step_count(client: int):
    box, _ = _boxes(client, 2)
    p.setCollisionFilterGroupMask(box, -1, 1, 0, physicsClientId=client)
    for _ in range(2):
        p.performCollisionDetection(client)
    assert _is_quick(client)
    assert p.getContactPoints(box, physicsClientId=client)
    p.createConstraint(
        box, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0, 0, 0.0999], physicsClientId=client
    )
    # Each group has to be in the other's mask from now on.
    p.setPhysicsEngineParameter(collisionFilterMode=0, physicsClientId=client)
    p.performCollisionDetection(client)
    assert not p.getContactPoints(box, physicsClientId=client)


@pytest.mark.parametrize("count", [60, 70])
def test_large_scenes_let_other_threads_run(count: int, client: int):
    _boxes(client, count)
    for _ in range(2):
        p.performCollisionDetection(client)
    assert _is_quick(client) == (count < 64)
    assert len(p.getContactPoints(physicsClientId=client)) == 4 * count
