"""The order in which bodies are counted; the expected values are what PyBullet 3.2.7 answers."""

from __future__ import annotations

from collections.abc import Callable

import pytest

import pybullet as p
from pybullet._bodies.bodies import getBodyUniqueId

COUNTERS = {"native": p.getBodyUniqueId, "python": getBodyUniqueId}


@pytest.fixture(params=COUNTERS)
def listed(request: pytest.FixtureRequest, client: int) -> Callable[[], list[int]]:
    def ids() -> list[int]:
        return [COUNTERS[request.param](place) for place in range(p.getNumBodies())]

    return ids


def load(count: int) -> None:
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3)
    for place in range(count):
        p.createMultiBody(1, shape, basePosition=[place, 0, 0])


def test_the_last_body_takes_the_place_of_one_that_is_removed(listed: Callable[[], list[int]]) -> None:
    load(5)
    assert listed() == [0, 1, 2, 3, 4]
    for removed, left in ((1, [0, 4, 2, 3]), (2, [0, 4, 3]), (0, [3, 4])):
        p.removeBody(removed)
        assert listed() == left
    load(4)
    assert listed() == [3, 4, 0, 2, 1, 5]
    p.removeBody(4)
    assert listed() == [3, 5, 0, 2, 1]
    p.removeBody(1)
    assert listed() == [3, 5, 0, 2]
    p.resetSimulation()
    load(3)
    assert listed() == [0, 1, 2]


def test_syncing_lists_bodies_by_their_ids(listed: Callable[[], list[int]]) -> None:
    load(5)
    p.removeBody(1)
    p.syncBodyInfo()
    assert listed() == [0, 2, 3, 4]
    load(1)
    assert listed() == [0, 2, 3, 4, 1]
    p.removeBody(0)
    assert listed() == [1, 2, 3, 4]


def test_a_body_that_could_not_be_loaded_is_not_listed(listed: Callable[[], list[int]]) -> None:
    load(3)
    p.removeBody(0)
    with pytest.raises(p.error):
        p.loadURDF("no such file.urdf")
    assert listed() == [2, 1]


def test_what_does_not_count(listed: Callable[[], list[int]]) -> None:
    load(2)
    assert [p.getBodyUniqueId(place) for place in (-1, 2, 99)] == [-1, -1, -1]
