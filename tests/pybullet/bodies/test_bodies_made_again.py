"""Bodies without links that are made again from the same shapes share what is the same for all of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

import pybullet as p
from pybullet._clients.clients import clients


@pytest.fixture(autouse=True)
def client() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


def spec_of(body: int) -> Any:
    return clients[0].world.bodies[body].spec


def facts(body: int) -> tuple[Any, ...]:
    return (
        p.getDynamicsInfo(body, -1),
        p.getCollisionShapeData(body, -1)[0][2:],
        [shape[2:] for shape in p.getVisualShapeData(body)],
        p.getAABB(body),
    )


def test_the_same_shapes_give_the_same_specification() -> None:
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3])
    red = p.createVisualShape(p.GEOM_SPHERE, radius=0.1, rgbaColor=[1, 0, 0, 1])
    first, second, third = (p.createMultiBody(2.0, box, red) for _ in range(3))
    assert spec_of(first) is spec_of(second) is spec_of(third)
    assert facts(first) == facts(second) == facts(third)
    others = [
        p.createMultiBody(3.0, box, red),
        p.createMultiBody(2.0, box),
        p.createMultiBody(2.0, box, red, baseInertialFramePosition=[0, 0, 0.1]),
        p.createMultiBody(2.0, box, red, flags=p.URDF_USE_SELF_COLLISION),
    ]
    assert all(spec_of(other) is not spec_of(first) for other in others)
    assert p.getDynamicsInfo(others[0], -1)[0] == 3.0
    assert p.getDynamicsInfo(others[2], -1)[3] == (0.0, 0.0, 0.1)


def test_a_change_of_one_body_does_not_change_the_next() -> None:
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3])
    first = p.createMultiBody(2.0, box)
    before = facts(first)
    p.createMultiBody(2.0, box)
    p.changeDynamics(first, -1, mass=5.0, lateralFriction=0.1)
    p.changeVisualShape(first, -1, rgbaColor=[0, 1, 0, 1])
    assert facts(p.createMultiBody(2.0, box)) == before


def test_a_number_that_is_given_again_is_another_shape() -> None:
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.5)
    p.createMultiBody(1.0, ball)
    p.removeCollisionShape(ball)
    spare = p.createCollisionShape(p.GEOM_SPHERE, radius=0.25)
    p.removeCollisionShape(spare)
    again = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    assert again == spare
    assert p.getCollisionShapeData(p.createMultiBody(1.0, again), -1)[0][2] == p.GEOM_BOX


def test_a_replaced_height_field_is_in_the_next_body() -> None:
    grid: dict[str, Any] = {"numHeightfieldRows": 2, "numHeightfieldColumns": 2, "meshScale": [1, 1, 1]}
    field = p.createCollisionShape(p.GEOM_HEIGHTFIELD, heightfieldData=[0.0] * 4, **grid)
    before = [p.createMultiBody(0.0, field, basePosition=[5 * place, 0, 0]) for place in range(3)]
    before += p.createMultiBody(0.0, field, batchPositions=[[5 * place, 9, 0] for place in range(3)])
    p.createCollisionShape(
        p.GEOM_HEIGHTFIELD, heightfieldData=[0.0, 0.0, 0.0, 1.0], replaceHeightfieldIndex=field, **grid
    )
    body = p.createMultiBody(0.0, field)
    hit = p.rayTest([0.4, 0.4, 5.0], [0.4, 0.4, -5.0])[0]
    assert hit[3][2] > 0.2
    assert len({p.getAABB(other)[1][2] for other in (body, *before)}) == 1


def test_what_is_missing_is_said_each_time(caplog: pytest.LogCaptureFixture) -> None:
    for _ in range(2):
        caplog.clear()
        p.createMultiBody(1.0, 77)
        assert "no collision shape 77" in caplog.text
