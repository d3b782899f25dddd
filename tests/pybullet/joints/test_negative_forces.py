"""Motors whose greatest force is negative, as PyBullet 3.2.7 takes them."""

from __future__ import annotations

from typing import Any

import pytest

import pybullet as p
import pybullet_data


@pytest.fixture(autouse=True)
def world():
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.8)
    yield
    p.disconnect()


@pytest.mark.parametrize(
    ("mode", "target", "force", "velocity", "torque"),
    [
        (p.VELOCITY_CONTROL, {"targetVelocity": 1}, -1e31, 100.0, 1e31),
        (p.VELOCITY_CONTROL, {"targetVelocity": 1}, -5, -0.0062329723106, -5.0),
        (p.VELOCITY_CONTROL, {"targetVelocity": 1}, -100000, 100.0, 100000.0),
        (p.VELOCITY_CONTROL, {"targetVelocity": 0}, -5, 0.0061995886799, 5.0),
        (p.VELOCITY_CONTROL, {"targetVelocity": -1}, -10, 0.0124142302, 10.0),
        (p.POSITION_CONTROL, {"targetPosition": 1}, -10, -0.01244760955, -10.0),
        (p.POSITION_CONTROL, {"targetPosition": -1}, -5, 0.0061995886799, 5.0),
    ],
)
def test_negative_forces(mode: int, target: dict[str, Any], force: float, velocity: float, torque: float):
    arm = p.loadURDF("kuka_iiwa/model.urdf", useFixedBase=True)
    p.setJointMotorControl2(arm, 1, mode, force=force, **target)
    p.stepSimulation()
    state = p.getJointState(arm, 1)
    assert state[1] == pytest.approx(velocity, rel=1e-7)
    assert state[3] == pytest.approx(torque, rel=1e-12)
