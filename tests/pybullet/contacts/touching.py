"""A floor with a ball and a pair of balls on it, as real PyBullet was asked about them."""

from collections.abc import Sequence

import pytest

import pybullet as p

FLOOR, BALL, PAIR = 0, 1, 2
RADIUS = 0.1
WEIGHT = 9.81


def add_pair(mass: float, shape: int, place: Sequence[float] = (1, 0, RADIUS)) -> int:
    """Two balls fixed to each other, half a metre apart; the base is fixed if it has no mass."""
    return p.createMultiBody(
        mass,
        shape,
        basePosition=place,
        linkMasses=[1],
        linkCollisionShapeIndices=[shape],
        linkVisualShapeIndices=[-1],
        linkPositions=[[0.5, 0, 0]],
        linkOrientations=[[0, 0, 0, 1]],
        linkInertialFramePositions=[[0, 0, 0]],
        linkInertialFrameOrientations=[[0, 0, 0, 1]],
        linkParentIndices=[0],
        linkJointTypes=[p.JOINT_FIXED],
        linkJointAxis=[[0, 0, 1]],
    )


@pytest.fixture
def balls(client: int) -> None:
    """Body 0 is the floor, 1 a ball, 2 two balls fixed to each other: its base and its link 0."""
    p.setGravity(0, 0, -WEIGHT)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 1]), basePosition=[0, 0, -1])
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=RADIUS)
    p.createMultiBody(1, shape, basePosition=[0, 0, RADIUS])
    add_pair(1.0, shape)
