"""`changeDynamics` with a link that does not exist changes what belongs to the body, as in PyBullet 3.2.7."""

from __future__ import annotations

from typing import Any

import pytest

import pybullet as p

# Velocity along x [m/s] and spin about z [rad/s] after 600 steps without gravity.
USUAL, AT_REST = (2.111329425, 1.520176484), (0.0, 0.0)


@pytest.mark.parametrize("link", [5, -3])
@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({}, USUAL),
        ({"linearDamping": 0.9}, (0.084986161, 1.520176484)),
        ({"angularDamping": 0.9}, (2.111329425, 0.074921323)),
        ({"activationState": 9, "sleepThreshold": 50}, AT_REST),
        ({"mass": 3.0, "lateralFriction": 0.1, "jointDamping": 5.0}, USUAL),
    ],
)
def test_what_belongs_to_the_body_is_changed(
    link: int, changes: dict[str, Any], expected: tuple[float, float]
):
    p.connect(p.DIRECT)
    body = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), -1, [0, 0, 1])
    p.resetBaseVelocity(body, [3, 0, 0], [0, 0, 2])
    # The last one belongs to the link, so that the call names it.
    p.changeDynamics(body, link, contactProcessingThreshold=1.0, **changes)
    assert p.getDynamicsInfo(body, -1)[:2] == (1.0, 0.5)
    for _ in range(600):
        p.stepSimulation()
    velocity, spin = p.getBaseVelocity(body)
    assert (velocity[0], spin[2]) == pytest.approx(expected, abs=1e-8)
