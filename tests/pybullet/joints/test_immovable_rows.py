"""Planar linkages, whose constraints have rows along which nothing moves; numbers of PyBullet 3.2.7."""

from __future__ import annotations

import pytest

import pybullet as p


@pytest.mark.parametrize(
    ("speed", "max_force", "expected"),
    [
        (
            1,
            None,
            [
                (7, 0.07531519500252637, 1.3219409283254162, -2.794525565000683),
                (21, 0.6869336047765604, 2.264487742519612, -5.912835617855445),
                (50, 1.66592548777469, 1.5851404027533722, -6.610755418328822),
            ],
        ),
        (
            2,
            5,
            [
                (3, 0.8261952898468591, 0.5390145067824499, -2.7436040653076224),
                (3, 1.789139490277823, 0.9741505750667415, -5.651731827726823),
                (3, 1.99998889864976, 2.1858289538991498, -8.700423710081328),
            ],
        ),
    ],
    ids=["strong", "weak"],
)
def test_the_solver_stops_where_pybullets_does(
    speed: float, max_force: float | None, expected: list[tuple[int, float, float, float]]
):
    p.connect(p.DIRECT)
    try:
        p.setGravity(0, 0, -10)
        p.setPhysicsEngineParameter(reportSolverAnalytics=1)
        ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.05)
        arm = p.createMultiBody(
            0,
            ball,
            -1,
            [0, 0, 1],
            linkMasses=[1] * 3,
            linkCollisionShapeIndices=[ball] * 3,
            linkVisualShapeIndices=[-1] * 3,
            linkPositions=[[0.3, 0, 0], [0, 0, 0.3], [0.3, 0, 0]],
            linkOrientations=[[0, 0, 0, 1]] * 3,
            linkInertialFramePositions=[[0, 0, 0]] * 3,
            linkInertialFrameOrientations=[[0, 0, 0, 1]] * 3,
            linkParentIndices=[0, 1, 2],
            linkJointTypes=[p.JOINT_REVOLUTE] * 3,
            linkJointAxis=[[0, 1, 0]] * 3,
        )
        tie = p.createConstraint(arm, 2, -1, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0.3, 0, 0], [0.9, 0, 1.3])
        if max_force is not None:
            p.changeConstraint(tie, maxForce=max_force)
        for joint in range(3):
            p.setJointMotorControl2(arm, joint, p.VELOCITY_CONTROL, force=0)
        p.setJointMotorControl2(arm, 0, p.VELOCITY_CONTROL, targetVelocity=speed, force=5)
        for sweeps, *velocities in expected:
            for _ in range(9):
                p.stepSimulation()
            report = p.stepSimulation()
            assert report[0]["numIterationsUsed"] == sweeps
            assert [p.getJointState(arm, joint)[1] for joint in range(3)] == pytest.approx(
                velocities, abs=1e-10
            )
    finally:
        p.disconnect()
