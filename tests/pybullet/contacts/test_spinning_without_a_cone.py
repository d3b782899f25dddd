"""Spinning friction has no effect without `enableConeFriction`; the expected values are PyBullet 3.2.7's."""

from __future__ import annotations

from typing import Any

import pytest
from numpy.testing import assert_allclose

import pybullet as p

_TURN = [0.575803419537255, -0.37657491007078464, -0.615511533759072, -0.38443115243686904]
_SPINNING, _ROLLING = {"spinningFriction": 0.1}, {"rollingFriction": 0.05}


@pytest.mark.usefixtures("client")
@pytest.mark.parametrize(
    ("cone", "dynamics", "expected"),
    [
        (0, {}, [0.52713886, -0.01526019, 0.10212456]),
        (0, _SPINNING, [0.52713886, -0.01526019, 0.10212456]),
        (0, _ROLLING, [0.47299329, 0.00008535, 0.08360151]),
        (0, _SPINNING | _ROLLING, [0.47299329, 0.00008535, 0.08360151]),
        (1, _SPINNING, [0.51304576, -0.10444391, -0.00000003]),
        (1, _SPINNING | _ROLLING, [0.4666015, -0.08842648, -0.00001826]),
    ],
)
def test_a_ball_spins_as_recorded(cone: int, dynamics: dict[str, Any], expected: list[float]) -> None:
    p.setGravity(1, -2, -9.8)
    p.setPhysicsEngineParameter(enableConeFriction=cone)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.0613)
    offset = [-0.0719, 0.0721, -0.0813]
    body = p.createMultiBody(
        1, ball, -1, [-0.2, -0.2, 0.062], baseInertialFramePosition=offset, baseOrientation=_TURN
    )
    p.changeDynamics(body, -1, **dynamics)
    for _ in range(3):
        p.stepSimulation()
    assert_allclose(p.getBaseVelocity(body)[1], expected, atol=2e-8)
