"""What the axis of a joint means, also one that is not of unit length."""

import math
from typing import Any

import pytest
from numpy.testing import assert_allclose
from tests.physics.one_joint import DT, INERTIA, hanging_rod, joint_state, place
from tests.physics.robots import let_go

from carom import Body
from carom.description import JointType


def weightless(**joint: Any) -> Body:
    body = hanging_rod(**joint)
    body.world.gravity = (0.0, 0.0, 0.0)
    let_go(body)
    return body


def test_a_revolute_joint_turns_right_handed_about_its_axis():
    body = weightless()
    place(body, math.pi / 2, 0.0)
    assert_allclose(body.world.link_pose[1, :3], [-0.5, 0.0, 0.0], atol=1e-15)


def test_a_long_revolute_axis_scales_the_rate_not_the_angle():
    """As in Bullet: the child turns by q, but moves and weighs as if at |axis| times the rate."""
    body = weightless(joint_axis_length=2.0)
    body.world.joint_torque[6] = 3.0
    body.world.step()
    assert joint_state(body)[1] == pytest.approx(3.0 * DT / (4.0 * INERTIA), rel=1e-12)
    place(body, math.pi / 2, 1.0)
    assert_allclose(body.world.link_pose[1, :3], [-0.5, 0.0, 0.0], atol=1e-15)
    body.update_link_velocities()
    assert_allclose(body.world.link_velocity[1], [0.0, 0.0, 1.0, 0.0, 2.0, 0.0], atol=1e-15)


def test_a_long_prismatic_axis_scales_the_way_too():
    body = weightless(joint_type=JointType.PRISMATIC, joint_axis=(1.0, 0.0, 0.0), joint_axis_length=2.0)
    place(body, 0.25, 1.0)
    assert_allclose(body.world.link_pose[1, :3], [0.5, 0.0, -0.5], atol=1e-15)
    body.update_link_velocities()
    assert_allclose(body.world.link_velocity[1, :3], [2.0, 0.0, 0.0], atol=1e-15)
    place(body, 0.0, 0.0)
    body.world.joint_torque[6] = 3.0
    body.world.step()
    assert joint_state(body)[1] == pytest.approx(3.0 * DT / (4.0 * 2.0), rel=1e-12)


def test_a_fixed_joint_is_rigid():
    body = hanging_rod(joint_type=JointType.FIXED)
    before = body.world.link_pose[:2].copy()
    body.world.link_force[1] = [10.0, 20.0, 30.0, 1.0, 2.0, 3.0]
    body.world.step(5)
    assert_allclose(body.world.link_pose[:2], before, rtol=0, atol=0)
