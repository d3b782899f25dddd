"""Motors of many joints at once are what they would be one by one."""

import math
from itertools import combinations, product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.rings import few

import pybullet as p
from pybullet._clients.clients import clients

DATA = Path(__file__).parents[3] / "src" / "pybullet_data"
LISTS = {
    "targetPositions": ("targetPosition", (0.3, -9.0, 0.1)),
    "targetVelocities": ("targetVelocity", (-0.5, 2.0, 0.0)),
    "forces": ("force", (10.0, 0.0, 3.5)),
    "positionGains": ("positionGain", (0.4, 0.2, 0.0)),
    "velocityGains": ("velocityGain", (0.9, 0.0, 0.3)),
}
GIVEN = [names for size in range(6) for names in combinations(LISTS, size)]
MODES = [p.POSITION_CONTROL, p.VELOCITY_CONTROL, p.TORQUE_CONTROL]


@pytest.fixture
def arm(client):
    return p.loadURDF(str(DATA / "kuka_iiwa" / "model.urdf"), useFixedBase=True)


def settings() -> tuple[np.ndarray, np.ndarray]:
    world = clients[0].world
    return world.motor.copy(), world.joint_torque.copy()


@pytest.mark.parametrize("joints", [(1, 2, 3), (5, 0, 2), (4, 4, 4)], ids=str)
@pytest.mark.parametrize(("mode", "given"), few(product(MODES, GIVEN), 12))
def test_lists_set_what_numbers_set(arm, joints, mode, given):
    p.enableJointForceTorqueSensor(arm, 1)
    before = settings()
    keywords: dict[str, Any] = {name: LISTS[name][1] for name in given}
    p.setJointMotorControlArray(arm, joints, mode, **keywords)
    together = settings()
    for array, values in zip((clients[0].world.motor, clients[0].world.joint_torque), before, strict=True):
        array[:] = values
    for place, joint in enumerate(joints):
        numbers: dict[str, Any] = {LISTS[name][0]: LISTS[name][1][place] for name in given}
        p.setJointMotorControl2(arm, joint, mode, **numbers)
    assert all(map(np.array_equal, together, settings()))


@pytest.mark.parametrize("make", [list, tuple, np.array, lambda values: np.array(values, dtype=np.float32)])
def test_any_sequence_of_numbers_will_do(arm, make):
    p.setJointMotorControlArray(
        arm, range(3), p.POSITION_CONTROL, make([0.5, 0.25, 0.125]), forces=make([1, 2, 3])
    )
    assert clients[0].world.motor[:, 0].tolist().count(0.25) == 1


BAD: list[Any] = [[0.1, math.nan, 0.2], [0.1, 0.2], [0.1, None, 0.2], 3]
INFINITE = [0.1, math.inf, 0.2]


@pytest.mark.parametrize(
    ("name", "bad"), [*product(LISTS, BAD), *((name, INFINITE) for name in LISTS if name != "forces")]
)
def test_nothing_is_set_when_something_is_wrong(arm, name, bad):
    keywords: dict[str, Any] = {"targetPositions": [0.5, 0.5, 0.5], "forces": [7.0, 7.0, 7.0], name: bad}
    before = settings()
    with pytest.raises((p.error, TypeError)):
        p.setJointMotorControlArray(arm, [0, 1, 2], p.POSITION_CONTROL, **keywords)
    assert all(map(np.array_equal, before, settings()))


def test_a_motor_may_be_as_strong_as_it_likes(arm):
    p.setJointMotorControlArray(arm, [0, 1], p.VELOCITY_CONTROL, forces=[math.inf, 5.0])
    assert np.isinf(clients[0].world.motor[:, 4]).sum() == 1


def test_groups_follow_bodies_that_come_and_go(client):
    first, second = (p.loadURDF(str(DATA / "kuka_iiwa" / "model.urdf"), useFixedBase=True) for _ in range(2))
    p.setJointMotorControlArray(second, [0, 1], p.VELOCITY_CONTROL, targetVelocities=[1.0, 2.0])
    p.removeBody(first)
    for _ in range(3):
        p.loadURDF(str(DATA / "r2d2.urdf"))
    p.setJointMotorControlArray(second, [0, 1], p.VELOCITY_CONTROL, targetVelocities=[3.0, 4.0])
    u = clients[0].world.bodies[second].first_velocity + 6
    assert clients[0].world.motor[u : u + 2, 1].tolist() == [3.0, 4.0]
