"""Gears between joints of two bodies; the numbers are those of PyBullet 3.2.7."""

from collections.abc import Iterator

import pytest

import pybullet as p

R, FIXED = p.JOINT_REVOLUTE, p.JOINT_FIXED


@pytest.fixture(autouse=True)
def client() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


def arm(x: float, kinds: list[int], angle: float) -> int:
    """A chain of balls on a fixed one, whose joints hang loose at multiples of an angle."""
    ball, count = p.createCollisionShape(p.GEOM_SPHERE, radius=0.05), len(kinds)
    body = p.createMultiBody(
        0,
        ball,
        -1,
        [x, 0, 0],
        linkMasses=[1] * count,
        linkCollisionShapeIndices=[ball] * count,
        linkVisualShapeIndices=[-1] * count,
        linkPositions=[[0.2, 0, 0]] * count,
        linkOrientations=[[0, 0, 0, 1]] * count,
        linkInertialFramePositions=[[0, 0, 0]] * count,
        linkInertialFrameOrientations=[[0, 0, 0, 1]] * count,
        linkParentIndices=list(range(count)),
        linkJointTypes=kinds,
        linkJointAxis=[[0, 0, 1]] * count,
    )
    for joint in range(count):
        p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0)
        p.resetJointState(body, joint, angle * (joint + 1))
    return body


@pytest.mark.parametrize(
    ("kinds", "angles", "others"),
    [
        (
            [R, R, R],
            [0.10089140309680474, 0.1982562093302997, 0.3008523875728956],
            [-0.3014189780385562, -0.540456557663597],
        ),
        # A joint that is fixed has no angle.
        (
            [R, FIXED, R],
            [0.10038638391429962, 0.0, 0.2996136160857004],
            [-0.30285544923456076, -0.48028847590078017],
        ),
    ],
)
def test_errors_are_taken_from_the_parents_joint(
    kinds: list[int], angles: list[float], others: list[float]
) -> None:
    """PyBullet asks the parent, not the child, for the angle of the joint with the child's number."""
    parent, child = arm(0.0, kinds, 0.1), arm(3.0, [R, R], -0.3)
    gear = p.createConstraint(parent, 0, child, 1, p.JOINT_GEAR, [0, 0, 1], [0, 0, 0], [0, 0, 0])
    p.changeConstraint(gear, gearRatio=1.5, maxForce=1000, erp=0.3, relativePositionTarget=0.7)
    for _ in range(5):
        p.stepSimulation()
    found = [p.getJointState(parent, joint)[0] for joint in range(len(kinds))]
    assert found == pytest.approx(angles, abs=1e-12)
    assert [p.getJointState(child, joint)[0] for joint in range(2)] == pytest.approx(others, abs=1e-12)
