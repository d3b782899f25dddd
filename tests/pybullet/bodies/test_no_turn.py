"""Inverse dynamics of a floating base whose quaternion a script has left at zeros."""

from __future__ import annotations

import pytest

import pybullet as p

# Recorded from PyBullet 3.2.7.
FORCES = (
    -2.1740068344737367, -5.665561044085183, 29.98821397816251, 3.753092513727812, -0.795337030233168,
    0.10862201698536675, -0.18700940613103087,
)  # fmt: skip


def test_four_zeros_are_no_turn():
    client = p.connect(p.DIRECT)
    p.setGravity(1, 2, -9.8)
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3])
    body = p.createMultiBody(
        1,
        box,
        -1,
        [0, 0, 1],
        linkMasses=[2],
        linkCollisionShapeIndices=[box],
        linkVisualShapeIndices=[-1],
        linkPositions=[[0, 0.1, 0.5]],
        linkOrientations=[[0, 0, 0, 1]],
        linkInertialFramePositions=[[0, 0, 0.1]],
        linkInertialFrameOrientations=[[0, 0, 0, 1]],
        linkParentIndices=[0],
        linkJointTypes=[p.JOINT_REVOLUTE],
        linkJointAxis=[[1, 0, 0]],
    )
    for turn in ([0, 0, 0, 1], [0, 0, 0, 0], [0, 0, 0, 0]):
        forces = p.calculateInverseDynamics(body, [0, 0, 1, *turn, 0.3], [0.1] * 7, [0.2] * 7)
        assert forces == pytest.approx(FORCES, rel=1e-12)
    p.disconnect(client)
