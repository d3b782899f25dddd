"""Nearest points of shapes without bodies; the numbers are those of PyBullet 3.2.7."""

from collections.abc import Iterator
from math import inf
from typing import Any

import pytest

import pybullet as p


@pytest.fixture
def shapes() -> Iterator[tuple[int, int, int]]:
    """A box of 1 m around (2, 0, 0), and the ids of a ball and of a smaller box aside of its origin."""
    p.connect(p.DIRECT)
    cube = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5, 0.5, 0.5])
    body = p.createMultiBody(0, cube, -1, [2, 0, 0])
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.25)
    aside = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3], collisionFramePosition=[0, 0, 1])
    yield body, ball, aside
    p.disconnect()


@pytest.mark.parametrize(
    ("on_body", "on_ball", "distance", "place"),
    [((1.5, 0, 0), (0.25, 0, 0), 1.25, None), ((2, 0, 0.5), (2, 0, 2.75), 2.25, (2, 0, 3))],
)
def test_a_shape_and_a_body(shapes, on_body, on_ball, distance, place) -> None:
    body, ball, _ = shapes
    (point,) = p.getClosestPoints(body, -1, 10, collisionShapeB=ball, collisionShapePositionB=place)
    assert point[1:5] == (body, -1, -1, -2)
    assert point[5] == pytest.approx(on_body)
    assert point[6] == pytest.approx(on_ball)
    assert point[8] == pytest.approx(distance)
    (point,) = p.getClosestPoints(-1, body, 10, collisionShapeA=ball, collisionShapePositionA=place)
    assert point[1:5] == (-1, body, -2, -1)
    assert point[5] == pytest.approx(on_ball)
    assert point[6] == pytest.approx(on_body)


def test_a_turned_shape_with_a_frame_of_its_own(shapes) -> None:
    body, ball, aside = shapes
    turn = p.getQuaternionFromEuler([1.5707963, 0, 0])
    (point,) = p.getClosestPoints(
        body,
        -1,
        10,
        collisionShapeB=aside,
        collisionShapePositionB=[2, 0, 3],
        collisionShapeOrientationB=turn,
    )
    assert point[7] == pytest.approx((0, 0.0874138852298817, -0.996172079848164), abs=1e-9)
    assert point[8] == pytest.approx(2.308845751804339, abs=1e-9)
    (point,) = p.getClosestPoints(
        -1, -1, 10, collisionShapeA=ball, collisionShapeB=aside, collisionShapePositionA=[5, 0, 0]
    )
    assert point[1:5] == (-1, -1, -2, -2)
    assert point[5] == pytest.approx((4.752518689749738, 0, 0.035397755251057594))
    assert point[8] == pytest.approx(4.699878911870093)


def test_the_shape_comes_before_the_body_on_its_side(shapes) -> None:
    body, ball, _ = shapes
    points = p.getClosestPoints(body, body, 10, collisionShapeB=ball)
    assert [point[1:5] for point in points] == [(body, body, -1, -2), (body, body, -1, -1)]


def test_the_world_is_left_alone(shapes) -> None:
    body, ball, _ = shapes
    p.getClosestPoints(body, -1, 10, collisionShapeB=ball)
    assert p.getNumBodies() == 1
    p.resetBasePositionAndOrientation(body, [4, 0, 0], [0, 0, 0, 1])
    assert p.getClosestPoints(body, -1, 10, collisionShapeB=ball)[0][8] == pytest.approx(3.25)


@pytest.mark.parametrize(
    "keywords",
    [
        {"collisionShapeB": 99},
        {"bodyB": 77, "collisionShapeA": 1, "bodyA": -1},
        {"collisionShapeB": 1, "distance": 0.1},
        {"collisionShapeB": 1, "linkIndexA": 5},
    ],
)
def test_nothing_is_found(shapes, keywords: dict[str, Any]) -> None:
    given: dict[str, Any] = {"bodyA": shapes[0], "bodyB": -1, "distance": 10, **keywords}
    assert p.getClosestPoints(**given) == ()


def test_places_that_are_none(shapes) -> None:
    for name, value in (("Position", "xyz"), ("Position", [0, 0, inf]), ("Orientation", [0, 0, 0, 0])):
        with pytest.raises(p.error, match=r"^getClosestPoints failed\."):
            given: dict[str, Any] = {f"collisionShape{name}B": value}
            p.getClosestPoints(shapes[0], -1, 10, collisionShapeB=shapes[1], **given)
