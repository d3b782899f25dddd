"""Nearest points of bodies of several parts come in the order in which PyBullet 3.2.7 finds them."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import pybullet as p

PLACES = ((0.0, 0.0, 0.0), (0.5, 0.1, 0.0), (-0.4, 0.3, 0.1), (0.1, -0.6, 0.2), (0.7, 0.6, -0.2))
# Distances from five boxes to a floor, from five boxes to three, and from three to five.
TO_FLOOR = [0.71, 0.94, 1.03, 1.12, 0.95]
FIVE_TO_THREE = [
    *(2.081, 1.88, 1.932, 1.772, 1.93, 2.342, 2.117, 2.185),
    *(1.93, 1.86, 1.937, 2.008, 1.811, 1.735, 1.9),
]
THREE_TO_FIVE = [
    *(2.081, 1.88, 2.342, 2.185, 2.117, 1.93, 1.932, 1.772),
    *(1.93, 1.86, 1.811, 1.937, 2.008, 1.735, 1.9),
]


@pytest.fixture
def bodies() -> Iterator[tuple[int, int, int]]:
    client = p.connect(p.DIRECT)
    floor = p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 1])
    yield p.createMultiBody(0, floor, -1, [0, 0, -2]), boxes(5, 0.0), boxes(3, 2.0)
    p.disconnect(client)


def boxes(count: int, height: float) -> int:
    shape = p.createCollisionShapeArray(
        [p.GEOM_BOX] * count,
        halfExtents=[[0.05 + 0.01 * i] * 3 for i in range(count)],
        collisionFramePositions=PLACES[:count],
    )
    return p.createMultiBody(1, shape, -1, [0, 0, height])


def distances(a: int, b: int) -> list[float]:
    return [round(point[8], 3) for point in p.getClosestPoints(a, b, 3)]


def test_parts_come_in_the_order_of_a_search_of_their_trees(bodies: tuple[int, int, int]) -> None:
    floor, five, three = bodies
    # The first call takes the long way, the others a short one.
    for _ in range(2):
        assert distances(five, floor) == TO_FLOOR
        assert distances(floor, five) == TO_FLOOR
        assert distances(five, three) == FIVE_TO_THREE
        assert distances(three, five) == THREE_TO_FIVE
