"""Quaternions whose length is not 1, as targets of spherical joints; expected values are real PyBullet's."""

from __future__ import annotations

from typing import Any

import pytest

import pybullet as p

LONG, SHORT = [0.3, -0.1, 0.0, -0.9], [0.3, -0.1, 0.2, 0.05]
EXPECTED = {
    "long": (LONG, [-3.121091831, 0.955753487, -0.323106604]),
    "short": (SHORT, [-14.253128828, -5.514329109, -3.624501137]),
}


@pytest.fixture
def ball(client: Any) -> int:
    """A body of two boxes with a spherical joint between them."""
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3])
    return p.createMultiBody(
        1,
        box,
        basePosition=[0, 0, 1],
        linkMasses=[1],
        linkCollisionShapeIndices=[box],
        linkVisualShapeIndices=[-1],
        linkPositions=[[1, 0, 0]],
        linkOrientations=[[0, 0, 0, 1]],
        linkInertialFramePositions=[[0, 0, 0]],
        linkInertialFrameOrientations=[[0, 0, 0, 1]],
        linkParentIndices=[0],
        linkJointTypes=[p.JOINT_SPHERICAL],
        linkJointAxis=[[0, 0, 1]],
    )


@pytest.mark.parametrize(("target", "rates"), EXPECTED.values(), ids=EXPECTED)
def test_one_joint_turns_to_a_target_of_any_length(ball: int, target: list[float], rates: list[float]):
    p.setJointMotorControlMultiDof(ball, 0, p.POSITION_CONTROL, targetPosition=target, force=[1000] * 3)
    p.stepSimulation()
    assert p.getJointStateMultiDof(ball, 0)[1] == pytest.approx(rates, abs=1e-8)


@pytest.mark.parametrize(("target", "rates"), EXPECTED.values(), ids=EXPECTED)
def test_joints_of_an_array_turn_to_targets_of_any_length(ball: int, target: list[float], rates: list[float]):
    p.setJointMotorControlMultiDofArray(
        ball, [0], p.POSITION_CONTROL, targetPositions=[target], forces=[[1000] * 3]
    )
    p.stepSimulation()
    assert p.getJointStateMultiDof(ball, 0)[1] == pytest.approx(rates, abs=1e-8)
