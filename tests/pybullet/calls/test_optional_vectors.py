"""Vectors of the wrong length where a call can do without; the results are those of PyBullet 3.2.7."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np
import pytest

from pybullet._calls import errors

# Checked at run time: what is tested here is calls that are wrong, too.
p: Any = import_module("pybullet")

WRONG: list[Any] = [[], [0.5], [0.5, 0.5], [0.5] * 5, 0.5, np.full((1, 4), 0.5), np.array(0.5)]
NO_PLACE, UPRIGHT = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)


@pytest.fixture
def ball(client: int) -> int:
    return p.createMultiBody(1.0, p.createCollisionShape(p.GEOM_SPHERE), basePosition=[0, 0, 3])


@pytest.mark.parametrize("wrong", [*WRONG, [0.5] * 4])
def test_sizes_and_positions_of_collision_shapes(client: int, wrong: Any) -> None:
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=wrong, collisionFramePosition=wrong)
    plane = p.createCollisionShape(p.GEOM_PLANE, planeNormal=wrong)
    bodies = [p.createMultiBody(0, box), p.createMultiBody(0, plane)]
    assert p.getCollisionShapeData(bodies[0], -1)[0][2:6] == (p.GEOM_BOX, (2.0, 2.0, 2.0), b"", NO_PLACE)
    assert p.getCollisionShapeData(bodies[1], -1)[0][3] == (0.0, 0.0, 1.0)


@pytest.mark.parametrize("wrong", [*WRONG, [0.5] * 3])
def test_looks(client: int, wrong: Any) -> None:
    look = p.createVisualShape(p.GEOM_SPHERE, rgbaColor=wrong, visualFrameOrientation=wrong)
    several = p.createVisualShapeArray([p.GEOM_SPHERE] * 2, radii=[1, 1], rgbaColors=[wrong, [1, 0, 0, 1]])
    plain, mixed = p.createMultiBody(0, -1, look), p.createMultiBody(0, -1, several)
    assert p.getVisualShapeData(plain)[0][6:8] == (UPRIGHT, (1.0, 1.0, 1.0, 1.0))
    assert [data[7] for data in p.getVisualShapeData(mixed)] == [(1.0, 1.0, 1.0, 1.0), (1.0, 0.0, 0.0, 1.0)]

    p.changeVisualShape(mixed, -1, rgbaColor=wrong)
    assert p.getVisualShapeData(mixed)[1][7] == (1.0, 1.0, 1.0, 1.0)


@pytest.mark.parametrize("wrong", [*WRONG, [0.5] * 3])
def test_where_bodies_are_made(client: int, wrong: Any) -> None:
    turned = p.createMultiBody(1.0, baseOrientation=wrong, baseInertialFrameOrientation=wrong)
    assert p.getBasePositionAndOrientation(turned) == (NO_PLACE, UPRIGHT)
    if len(np.shape(wrong)) != 1 or len(wrong) != 3:
        placed = p.createMultiBody(1.0, basePosition=wrong, baseInertialFramePosition=wrong)
        assert p.getBasePositionAndOrientation(placed) == (NO_PLACE, UPRIGHT)


@pytest.mark.parametrize("wrong", [*WRONG, [0.5] * 4])
def test_a_velocity_of_another_length_is_none(ball: int, wrong: Any) -> None:
    p.resetBaseVelocity(ball, [1, 2, 3], [4, 5, 6])
    p.resetBaseVelocity(ball, linearVelocity=wrong)
    assert p.getBaseVelocity(ball) == (NO_PLACE, (4.0, 5.0, 6.0))
    p.resetBaseVelocity(ball, [1, 2, 3], wrong)
    assert p.getBaseVelocity(ball) == ((1.0, 2.0, 3.0), NO_PLACE)


@pytest.mark.parametrize("wrong", [None, *WRONG])
def test_constraints(ball: int, wrong: Any) -> None:
    tie = p.createConstraint(ball, -1, -1, -1, p.JOINT_FIXED, wrong, wrong, wrong, wrong, wrong)
    assert p.getConstraintInfo(tie)[5:10] == (NO_PLACE, NO_PLACE, NO_PLACE, UPRIGHT, UPRIGHT)
    p.changeConstraint(tie, [1, 2, 3], maxForce=9)
    p.changeConstraint(tie, wrong, wrong)
    assert p.getConstraintInfo(tie)[7:11] == ((1.0, 2.0, 3.0), UPRIGHT, UPRIGHT, 9.0)


@pytest.mark.parametrize("wrong", [*WRONG, [0.5] * 15, np.eye(4)])
def test_images_are_seen_from_the_first_camera_then(ball: int, wrong: Any) -> None:
    view = p.computeViewMatrix([3, 3, 3], [0, 0, 3], [0, 0, 1])
    projection = p.computeProjectionMatrixFOV(60, 1, 0.1, 10)
    first = p.getCameraImage(16, 16)[3]
    for matrices in ((wrong, projection), (view, wrong)):
        assert np.array_equal(p.getCameraImage(16, 16, *matrices, wrong, wrong)[3], first)
    assert not np.array_equal(p.getCameraImage(16, 16, view, projection)[3], first)


@pytest.mark.parametrize("wrong", [*WRONG, [1, 0, 0, 1]])
def test_what_is_drawn_in_a_window(ball: int, wrong: Any) -> None:
    assert p.addUserDebugLine([0, 0, 0], [1, 1, 1], wrong) == -1
    p.setDebugObjectColor(ball, -1, wrong)
    p.configureDebugVisualizer(lightPosition=wrong, rgbBackground=wrong)
    p.resetDebugVisualizerCamera(1, 0, 0, wrong)
    p.setVRCameraState(wrong, wrong if np.shape(wrong) != (4,) else None)


def test_the_first_such_call_warns(ball: int, caplog: pytest.LogCaptureFixture) -> None:
    errors.warn_once.cache_clear()
    for _ in range(3):
        p.changeVisualShape(ball, -1, rgbaColor=[1, 0, 0])
    assert [record.message for record in caplog.records] == [
        "rgbaColor is not a sequence of 4 numbers, so its default is used"
    ]


@pytest.mark.parametrize("bad", [[0.0, 0.0, float("nan")], [0.0, 0.0, "x"], [0.0, 0.0, None], "xyz"])
def test_vectors_of_the_right_length_hold_numbers(ball: int, bad: Any) -> None:
    for call in (
        lambda: p.createCollisionShape(p.GEOM_BOX, halfExtents=bad),
        lambda: p.createMultiBody(1.0, basePosition=bad),
        lambda: p.resetBaseVelocity(ball, bad),
        lambda: p.addUserDebugLine([0, 0, 0], [1, 1, 1], bad),
    ):
        with pytest.raises(p.error):
            call()
