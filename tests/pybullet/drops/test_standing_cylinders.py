"""Cylinders that land flat on an infinite plane gather their points one by one, as in PyBullet."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import pybullet as p

# Height of the start, roll, radius, height of the cylinder; x, z and yaw after 60 and 120 steps, points then,
# as PyBullet 3.2.7 has them.
FALLS = [
    (0.05, 0.0, 0.1, 0.04, (0.0003, 0.01991, 0.0), (0.0003, 0.01999, 0.0), 2),
    (0.3, 0.0, 0.1, 0.04, (-0.0003, 0.00925, 0.0), (0.0013, 0.01992, 0.0), 2),
    (0.3, 0.02, 0.1, 0.04, (0.0, 0.01732, 0.001), (0.0002, 0.01997, 0.001), 4),
]


@pytest.fixture(autouse=True)
def _world() -> Iterator[None]:
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -10)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    yield
    p.disconnect()


@pytest.mark.parametrize(("start", "roll", "radius", "height", "early", "late", "points"), FALLS)
def test_falls(
    start: float,
    roll: float,
    radius: float,
    height: float,
    early: tuple[float, ...],
    late: tuple[float, ...],
    points: int,
) -> None:
    shape = p.createCollisionShape(p.GEOM_CYLINDER, radius=radius, height=height)
    turn = p.getQuaternionFromEuler([roll, 0.5 * roll, 0])
    body = p.createMultiBody(1, shape, -1, [0, 0, start], turn)
    for expected in (early, late):
        for _ in range(60):
            p.stepSimulation()
        (x, _, z), turn = p.getBasePositionAndOrientation(body)
        found = (x, z, p.getEulerFromQuaternion(turn)[2])
        assert found == pytest.approx(expected, abs=6e-4)
    assert len(p.getContactPoints()) == points


def test_it_lies_still_in_the_end() -> None:
    shape = p.createCollisionShape(p.GEOM_CYLINDER, radius=0.1, height=0.04)
    body = p.createMultiBody(1, shape, -1, [0, 0, 0.1])
    for _ in range(960):
        p.stepSimulation()
    linear, angular = p.getBaseVelocity(body)
    assert max(map(abs, [*linear, *angular])) < 0.01
    assert p.getBasePositionAndOrientation(body)[0][2] == pytest.approx(0.02, abs=1e-4)
