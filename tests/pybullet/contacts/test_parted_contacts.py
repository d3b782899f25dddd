"""Contacts that calls between steps drop, and all others; the expected values are PyBullet 3.2.7's."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from tests.pybullet.contacts.touching import add_pair

import pybullet as p

FLOOR, BALLS, PAIR = 0, (1, 2, 3), 4
# The second body and its link, of contacts with the floor.
EVERY = [(1, -1), (2, -1), (3, -1), (4, -1), (4, 0)]
BUT_FIRST = EVERY[1:]
BUT_PAIR_AND_FIRST = [(2, -1), (3, -1)]

CALLS: dict[str, tuple[Callable[[], object], list[tuple[int, int]]]] = {
    "fixed base": (lambda: p.changeDynamics(BALLS[0], -1, mass=0), BUT_FIRST),
    "fixed base of two links": (
        lambda: p.changeDynamics(PAIR, -1, mass=0),
        [(1, -1), (2, -1), (3, -1), (4, 0)],
    ),
    "free base": (lambda: p.changeDynamics(FLOOR, -1, mass=1), []),
    "other mass": (lambda: p.changeDynamics(BALLS[0], -1, mass=5), EVERY),
    "mass of a link": (lambda: p.changeDynamics(PAIR, 0, mass=0), EVERY),
    "same mask": (lambda: p.setCollisionFilterGroupMask(BALLS[0], -1, 1, -1), BUT_FIRST),
    "mask of a link": (lambda: p.setCollisionFilterGroupMask(PAIR, 0, 1, -1), EVERY[:4]),
    "mask of the floor": (lambda: p.setCollisionFilterGroupMask(FLOOR, -1, 2, -3), []),
    "mask of no link": (lambda: p.setCollisionFilterGroupMask(PAIR, 7, 0, 0), EVERY),
    "pair": (lambda: p.setCollisionFilterPair(1, 2, -1, -1, 1), [(3, -1), (4, -1), (4, 0)]),
    "one body": (lambda: p.setCollisionFilterPair(1, 1, -1, -1, 1), BUT_FIRST),
    "pair of links": (lambda: p.setCollisionFilterPair(1, PAIR, -1, -1, 0), BUT_PAIR_AND_FIRST),
    "pair with no body": (lambda: p.setCollisionFilterPair(1, 99, -1, -1, 0), BUT_FIRST),
    "pair with no link": (lambda: p.setCollisionFilterPair(1, PAIR, -1, 7, 0), BUT_PAIR_AND_FIRST),
    "scaling": (lambda: p.unsupportedChangeScaling(BALLS[0], [1, 1, 1]), BUT_FIRST),
    "scaling of two links": (
        lambda: p.unsupportedChangeScaling(PAIR, [1, 1, 1]),
        [(1, -1), (2, -1), (3, -1), (4, 0)],
    ),
    "velocity": (lambda: p.resetBaseVelocity(BALLS[0], [0, 0, 3]), EVERY),
    "friction": (lambda: p.changeDynamics(BALLS[0], -1, lateralFriction=0.3), EVERY),
}


@pytest.fixture
def scene(client: int) -> None:
    """Three balls and two joined ones that rest on a floor."""
    p.setGravity(0, 0, -9.81)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 0.5]))
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    for i in range(3):
        p.createMultiBody(1 + i, ball, basePosition=[0.5 * i, 0, 0.6])
    add_pair(1, ball, (2, 0, 0.6))
    for _ in range(30):
        p.stepSimulation()


def touching() -> dict[tuple[int, int], float]:
    """Normal forces [N] by the body that touches the floor and its link."""
    found: dict[tuple[int, int], float] = {}
    for point in p.getContactPoints():
        a, b = (point[1], point[3]), (point[2], point[4])
        found[b if a[0] == FLOOR else a] = point[9]
    return found


FORCES = {(1, -1): 9.81, (2, -1): 19.62, (3, -1): 29.43, (4, -1): 9.81, (4, 0): 9.81}


@pytest.mark.usefixtures("scene")
@pytest.mark.parametrize("name", CALLS)
def test_only_what_may_collide_with_others_loses_its_contacts(name: str) -> None:
    call, left = CALLS[name]
    call()
    assert touching() == pytest.approx({place: FORCES[place] for place in left}, rel=1e-4)


@pytest.mark.usefixtures("scene")
@pytest.mark.parametrize("name", ["same mask", "mask of the floor", "pair", "scaling", "pair of links"])
def test_the_next_step_finds_them_again(name: str) -> None:
    CALLS[name][0]()
    p.stepSimulation()
    assert touching() == pytest.approx(FORCES, rel=2e-3)


@pytest.mark.usefixtures("scene")
def test_they_come_after_all_others() -> None:
    """The order in which the contacts are solved; PyBullet lists them so."""
    p.setCollisionFilterGroupMask(BALLS[2], -1, 1, -1)
    p.setCollisionFilterGroupMask(BALLS[0], -1, 1, -1)
    p.stepSimulation()
    assert list(touching()) == [(4, -1), (2, -1), (4, 0), (3, -1), (1, -1)]
