"""Links of one robot that touch each other in several points: what pushes one moves the other, too."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from numpy.testing import assert_allclose

import pybullet as p

UPRIGHT, LEANING = [0.0, 0.0, 0.0, 1.0], [-0.08, -0.24, -0.94, 0.2]
# Of each scene the base's turn, where the link is on it, the type of the joint and its axis; then velocities
# of the base and of the joint after three steps, as real PyBullet has them.
SCENES = {
    "turning": (
        (UPRIGHT, [0.08, 0.0, 0.102], p.JOINT_REVOLUTE, [0.0, 1.0, 0.0]),
        [-0.00631217653, 0.0, 0.00495672277, 0.0, 0.123825288, 0.0, -0.168800836],
    ),
    "leaning": (
        (LEANING, [0.08, 0.0, 0.102], p.JOINT_REVOLUTE, [0.0, 1.0, 0.0]),
        [0.00494239536, 0.00644015031, 0.00170904823, 0.0962081447, -0.0834324989, 0.0361716784, -0.17033306],
    ),
    "sliding": (
        (UPRIGHT, [0.1, 0.03, 0.101], p.JOINT_PRISMATIC, [0.0, 0.0, 1.0]),
        [
            -0.00273996355,
            -0.0022518094,
            -0.0290741273,
            -0.046982067,
            0.0527339527,
            -0.00303302047,
            0.0648365241,
        ],
    ),
    "oblique": (
        (UPRIGHT, [0.2, 0.05, 0.102], p.JOINT_REVOLUTE, [0.6, 0.8, 0.0]),
        [-0.0045672984, 0.0135114301, 0.00235025209, 0.387594499, 0.120146392, 0.0625082529, -0.0730117161],
    ),
}


@pytest.fixture(autouse=True)
def _connection() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


@pytest.mark.parametrize("scene", SCENES)
def test_links_of_a_robot_push_each_other_as_recorded(scene: str) -> None:
    (turn, place, kind, axis), recorded = SCENES[scene]
    body = p.createMultiBody(
        1,
        p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.34, 0.1, 0.055]),
        -1,
        [0, 0, 1],
        turn,
        flags=p.URDF_USE_SELF_COLLISION | p.URDF_USE_SELF_COLLISION_INCLUDE_PARENT,
        linkMasses=[1],
        linkCollisionShapeIndices=[p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.07, 0.05])],
        linkVisualShapeIndices=[-1],
        linkPositions=[place],
        linkOrientations=[UPRIGHT],
        linkInertialFramePositions=[[0, 0, 0]],
        linkInertialFrameOrientations=[UPRIGHT],
        linkParentIndices=[0],
        linkJointTypes=[kind],
        linkJointAxis=[axis],
    )
    for _ in range(3):
        p.stepSimulation()
    assert len(p.getContactPoints()) == 4
    linear, angular = p.getBaseVelocity(body)
    assert_allclose([*linear, *angular, p.getJointState(body, 0)[1]], recorded, atol=1e-8)
