"""Contacts that remain when bodies are removed between steps; the expected values are PyBullet 3.2.7's."""

from __future__ import annotations

import pytest
from tests.pybullet.contacts.touching import add_pair

import pybullet as p


def floor() -> int:
    p.setGravity(0, 0, -9.81)
    return p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 0.5]))


def balls(count: int = 4) -> list[int]:
    """Balls in a row on a floor, with masses 1, 2, 3..."""
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    return [p.createMultiBody(1 + i, shape, basePosition=[0.5 * i, 0, 0.6]) for i in range(count)]


def forces() -> dict[tuple[int, int], float]:
    """Normal forces [N] by pairs of bodies, of which each has one contact."""
    return {(point[1], point[2]): point[9] for point in p.getContactPoints()}


def settle() -> None:
    for _ in range(30):
        p.stepSimulation()


@pytest.mark.usefixtures("client")
def test_other_bodies_keep_their_contacts_with_forces() -> None:
    floor()
    rolling = balls()
    settle()
    p.removeBody(rolling[1])
    expected = {(0, 1): 9.81, (0, 3): 29.43, (0, 4): 39.24}
    assert forces() == pytest.approx(expected, rel=1e-5)
    p.stepSimulation()
    assert forces() == pytest.approx(expected, rel=1e-5)
    p.removeBody(rolling[3])
    p.removeBody(rolling[0])
    assert forces() == pytest.approx({(0, 3): 29.43}, rel=1e-5)


@pytest.mark.usefixtures("client")
def test_the_floor_takes_its_contacts_along() -> None:
    ground = floor()
    lower, upper = (
        p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), basePosition=[0, 0, z])
        for z in (0.6, 0.8)
    )
    settle()
    p.removeBody(ground)
    assert forces() == pytest.approx({(lower, upper): 9.80433306}, rel=1e-6)
    p.stepSimulation()
    # Both fall; what pushes is the penetration of a hundredth of a millimetre.
    assert forces() == pytest.approx({(lower, upper): 0.00698012}, rel=1e-6)


@pytest.mark.usefixtures("client")
def test_links_of_later_bodies_are_still_those_that_touch() -> None:
    floor()
    early = balls(1)[0]
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    pair = add_pair(1, shape, (2, 0, 0.6))
    settle()
    p.removeBody(early)
    assert sorted(point[1:5] for point in p.getContactPoints()) == [(0, pair, -1, -1), (0, pair, -1, 0)]
    assert [point[5][0] for point in p.getContactPoints(pair, linkIndexA=0)] == pytest.approx([2.5], abs=1e-6)
