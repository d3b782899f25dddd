"""The simulations of `pybullet_robots` do what they are there for."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, sin

import pytest

import pybullet as p
import pybullet_data
from pybullet_robots.panda.panda_sim import PandaSim
from pybullet_robots.panda.panda_sim_grasp import PandaSim as GraspingPanda
from pybullet_robots.panda.panda_sim_grasp import PandaSimAuto
from pybullet_robots.xarm.xarm_sim import XArm6Sim


@pytest.fixture(autouse=True)
def _world() -> Iterator[None]:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    yield
    p.disconnect()


def hand_of(arm: int, link: int) -> tuple[float, ...]:
    state = p.getLinkState(arm, link)
    assert state is not None
    return state[0]


def test_the_panda_lifts_a_brick() -> None:
    p.setGravity(0, -9.8, 0)
    arm = PandaSimAuto(p, [0, 0, 0])
    heights = []
    for _ in range(8 * 240):
        arm.step()
        p.stepSimulation()
        heights.append(p.getBasePositionAndOrientation(arm.legos[0])[0][1])
    assert heights[5 * 240] < 0.04
    # PyBullet's is at 0.116 m then.
    assert heights[-1] == pytest.approx(0.116, abs=2e-3)


def test_the_hand_of_the_panda_follows_its_ellipse() -> None:
    p.setGravity(0, -9.8, 0)
    arm = PandaSim(p, [1.0, 2.0, 3.0])
    arm.takes_pictures = False
    for _ in range(120):
        arm.step()
        p.stepSimulation()
    # PyBullet's is there; five steps of its search are not enough to keep up.
    assert hand_of(arm.panda, 11) == pytest.approx((1.08300, 2.05240, 2.34348), abs=1e-4)


def test_the_hand_of_the_xarm_follows_its_circle() -> None:
    p.setGravity(0, 0, -9.8)
    p.setTimeStep(1 / 60)
    arm = XArm6Sim(p, [0, 0, 0])
    for _ in range(120):
        arm.step()
        p.stepSimulation()
    # PyBullet's is at (0.488, -0.182, 0.129).
    assert hand_of(arm.xarm, 6) == pytest.approx((0.488, -0.182, 0.129), abs=5e-3)


def test_the_grasping_panda_waits_circles_and_goes_to_the_middle() -> None:
    offset = (0.3, 0.1, -0.2)
    arm = GraspingPanda(p, offset)
    assert (arm.state, arm.finger_target, arm.gripper_height) == (0, 0.0, 0.2)
    # The brick that it takes is red; a gear keeps both fingers alike.
    assert p.getVisualShapeData(arm.legos[0])[0][7] == (1, 0, 0, 1)
    gear = p.getConstraintInfo(p.getConstraintUniqueId(0))
    assert gear[4:8] == (p.JOINT_GEAR, (1, 0, 0), (0, 0, 0), (0, 0, 0))
    motors = [p.getJointState(arm.panda, joint)[0] for joint in range(7)]
    arm.step()
    # While it waits, time stands still and nothing is asked of the arm.
    assert arm.t == 0.0
    assert [p.getJointState(arm.panda, joint)[0] for joint in range(7)] == motors
    for state, height in ((1, 0.03), (2, 0.12)):
        arm.state = state
        start = arm.t
        places = [arm._next_place() for _ in range(800)]
        xs, ys, zs = zip(*places, strict=True)
        # Around the middle of the tray, 0.6 m in front of the arm, and either low or higher.
        angles = [1.5 * (start + step / 240) for step in range(800)]
        assert xs == pytest.approx([offset[0] + 0.2 * sin(angle) for angle in angles])
        assert zs == pytest.approx([offset[2] - 0.6 + 0.1 * cos(angle) for angle in angles])
        assert ys[-1] - offset[1] == pytest.approx(height, abs=1e-3)
    arm.prev_pos = [1.0, 0.5, 1.0]
    arm.state = 7
    places = [arm._next_place() for _ in range(200)]
    assert places[-1] == pytest.approx((offset[0], 0.5, offset[2] - 0.6))
