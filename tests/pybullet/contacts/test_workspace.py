"""A step reads nothing that earlier steps have left in the workspace."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import pybullet as p
from pybullet._clients.clients import client_of

_HALF = [0.1, 0.1, 0.1]


def box(mass: float, position: list[float], half: list[float] = _HALF, **links: Any) -> int:
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=half)
    return p.createMultiBody(mass, shape, basePosition=position, **links)


def robot() -> None:
    """A robot whose base, a table, is fixed."""
    arm = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.05, 0.05, 0.2])
    joints: dict[str, Any] = {
        "linkMasses": [1, 1],
        "linkCollisionShapeIndices": [arm, arm],
        "linkVisualShapeIndices": [-1, -1],
        "linkPositions": [[0.8, 0, 0.3], [0, 0, 0.4]],
        "linkOrientations": [[0, 0, 0, 1]] * 2,
        "linkInertialFramePositions": [[0, 0, 0]] * 2,
        "linkInertialFrameOrientations": [[0, 0, 0, 1]] * 2,
        "linkParentIndices": [0, 1],
        "linkJointTypes": [p.JOINT_REVOLUTE] * 2,
        "linkJointAxis": [[0, 0, 1], [0, 1, 0]],
    }
    box(0, [0, 0, 0], [1, 1, 0.1], **joints)


def on_a_robots_base() -> None:
    robot()
    box(1, [0, 0, 0.2])
    box(1, [0, 0, 0.4])


def on_the_floor() -> None:
    box(0, [0, 0, 0], [2, 2, 0.1])
    for place in range(6):
        box(1, [0.3 * (place % 3), 0.05 * place, 0.2 + 0.2 * (place // 3)])


def tied() -> None:
    on_the_floor()
    robot()
    p.createConstraint(2, -1, 3, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0.1, 0, 0.1], [-0.2, 0, 0.1])


def spoil_workspace() -> None:
    engine = client_of(0).world.engine
    scratch, _, pair_rows, *_ = engine.workspace.tables
    assert "side_normal_weighted" in pair_rows.numpy
    for table in (scratch, pair_rows):
        for array in table.numpy.values():
            if array.dtype.kind == "f":
                array.fill(np.nan)


@pytest.mark.parametrize("scene", [on_a_robots_base, on_the_floor, tied])
def test_nothing_is_read_before_it_is_written(scene: Callable[[], None]) -> None:
    p.connect(p.DIRECT)
    motions = []
    for spoils in (False, True):
        p.resetSimulation()
        p.setGravity(0, 0, -10)
        scene()
        for _ in range(200):
            p.stepSimulation()
            if spoils:
                spoil_workspace()
        world = client_of(0).world
        motions.append((world.position.copy(), world.velocity.copy()))
    p.disconnect()
    for before, after in zip(*motions, strict=True):
        np.testing.assert_array_equal(before, after)
