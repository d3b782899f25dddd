"""The order in which contacts are listed; the expected values are what PyBullet 3.2.7 answers."""

from __future__ import annotations

import pytest

import pybullet as p
from pybullet._contacts.contacts import getContactPoints

LISTERS = {"native": p.getContactPoints, "python": getContactPoints}


def row_of_balls(count: int) -> None:
    """A floor, body 0, and balls on it."""
    p.setGravity(0, 0, -9.81)
    floor = p.createCollisionShape(p.GEOM_BOX, halfExtents=[40, 40, 0.5])
    p.createMultiBody(0, floor, basePosition=[0, 0, -0.5])
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    for i in range(count):
        p.createMultiBody(1, ball, basePosition=[0.5 * i, 0, 0.1])
    p.stepSimulation()


def put(body: int, height: float) -> None:
    (x, y, _), turn = p.getBasePositionAndOrientation(body)
    p.resetBasePositionAndOrientation(body, [x, y, height], turn)
    p.stepSimulation()


@pytest.mark.usefixtures("client")
@pytest.mark.parametrize("lister", LISTERS)
@pytest.mark.parametrize("count", [4, 70])
def test_contacts_are_listed_as_their_bodies_met(lister: str, count: int) -> None:
    def listed(*asked: int) -> list[int]:
        return [point[2] for point in LISTERS[lister](*asked)]

    row_of_balls(count)
    assert listed() == [*range(1, count + 1)]
    put(1, 0.15)
    assert listed() == [count, *range(2, count)]
    put(1, 0.1)
    expected = [count, *range(2, count), 1]
    assert listed() == listed(0) == expected
    assert listed(2) == [0]
    p.restoreState(p.saveState())
    assert listed() == expected
    p.performCollisionDetection()
    assert listed() == expected
    p.removeBody(2)
    assert listed() == [count, 1, *range(3, count)]
