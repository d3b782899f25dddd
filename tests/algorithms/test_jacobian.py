"""Jacobians against finite differences of link poses and against the work of forces."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.aba_reference import rotation
from tests.physics.robots import coordinates, joint_coordinates, let_go, put_in_motion, random_tree

from carom import Body, World
from carom.algorithms import inverse_dynamics, jacobian
from carom.description import JointType
from carom.model.body_spec import BASE

# Joints whose rates are the derivatives of their coordinates.
SCALAR_TYPES = (JointType.REVOLUTE, JointType.PRISMATIC, JointType.FIXED)
ORIGIN = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def body_at_origin(seed: int, link_count: int, *, fixed_base: bool, joint_types=SCALAR_TYPES) -> Body:
    spec = random_tree(seed, link_count, fixed_base=fixed_base, joint_types=joint_types)
    body = World().load(spec)
    put_in_motion(body, np.random.default_rng(seed))
    body.set_inertial_pose(*ORIGIN)
    return body


def inertial_pose(body: Body, link: int) -> tuple[np.ndarray, np.ndarray]:
    """Position and axes of a link's inertial frame."""
    pose = body.world.link_pose[body.first_link + 1 + link]
    return pose[:3].copy(), rotation(pose[3:])


def from_com(body: Body, link: int, local: np.ndarray) -> np.ndarray:
    """A point given from the link frame's origin, as an offset from the centre of mass."""
    frame = body.link_inertial_frame(link)
    return local - rotation(np.array(frame.orientation)).T @ np.array(frame.position)


@pytest.mark.parametrize("link", [2, 5, 9])
def test_columns_are_derivatives_of_a_point_and_of_the_axes(link):
    body = body_at_origin(1, 10, fixed_base=True)
    joints = joint_coordinates(body)[0]
    local = np.array([0.3, -0.2, 0.1])
    linear, angular = jacobian(body, link, local, joints)
    arm = from_com(body, link, local)
    start, step = joints.copy(), 1e-6
    for column in range(len(joints)):
        sides = []
        for sign in (-1.0, 1.0):
            joints[:] = start
            joints[column] += sign * step
            body.update_link_poses()
            centre, axes = inertial_pose(body, link)
            sides.append((centre + axes @ arm, axes))
        joints[:] = start
        body.update_link_poses()
        point_rate = (sides[1][0] - sides[0][0]) / (2.0 * step)
        spin = (sides[1][1] - sides[0][1]) / (2.0 * step) @ inertial_pose(body, link)[1].T
        assert_allclose(linear[:, column], point_rate, rtol=0, atol=1e-8)
        assert_allclose(angular[:, column], [spin[2, 1], spin[0, 2], spin[1, 0]], rtol=0, atol=1e-8)


@pytest.mark.parametrize("fixed_base", [True, False], ids=["fixed", "free"])
def test_it_maps_rates_to_link_velocities(fixed_base):
    types = (JointType.REVOLUTE, JointType.SPHERICAL, JointType.PLANAR, JointType.PRISMATIC)
    body = body_at_origin(2, 12, fixed_base=fixed_base, joint_types=types)
    rates = coordinates(body)[1] if not fixed_base else joint_coordinates(body)[1]
    body.update_link_velocities()
    for link in range(body.joint_count):
        com = -from_com(body, link, np.zeros(3))
        if body.spec.links[link].joint_type == JointType.PLANAR:
            com = np.zeros(3)
        linear, angular = jacobian(body, link, com, joint_coordinates(body)[0])
        found = body.world.link_velocity[body.first_link + 1 + link]
        assert_allclose(linear @ rates, found[:3], rtol=0, atol=1e-12)
        assert_allclose(angular @ rates, found[3:], rtol=0, atol=1e-12)


def test_it_is_told_in_the_axes_of_the_base():
    body = body_at_origin(3, 6, fixed_base=True)
    joints = joint_coordinates(body)[0].copy()
    before = jacobian(body, 5, (0.1, 0.2, 0.3), joints)
    put_in_motion(body, np.random.default_rng(4))
    for matrix, unchanged in zip(jacobian(body, 5, (0.1, 0.2, 0.3), joints), before, strict=True):
        np.testing.assert_array_equal(matrix, unchanged)


def test_columns_of_joints_that_do_not_carry_the_link_are_zero():
    body = body_at_origin(5, 15, fixed_base=True)
    carriers, link = set(), 14
    while link != BASE:
        carriers.add(link)
        link = body.spec.links[link].parent
    linear, angular = jacobian(body, 14, (0.1, 0.2, 0.3), joint_coordinates(body)[0])
    for joint, row in enumerate(body.velocity_index):
        if row >= 0:
            column = row - body.first_velocity - 6
            moves = bool(linear[:, column].any() or angular[:, column].any())
            assert moves == (joint in carriers)


def test_the_base_moves_with_its_own_coordinates_only():
    body = body_at_origin(6, 4, fixed_base=False)
    local = (0.1, -0.3, 0.2)
    linear, angular = jacobian(body, BASE, local, joint_coordinates(body)[0])
    x, y, z = local
    assert_allclose(angular[:, :6], np.hstack([np.eye(3), np.zeros((3, 3))]), atol=1e-15)
    expected = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
    assert_allclose(linear[:, :6], np.hstack([expected, np.eye(3)]), atol=1e-15)
    assert not linear[:, 6:].any()
    assert not angular[:, 6:].any()


@pytest.mark.parametrize("fixed_base", [True, False], ids=["fixed", "free"])
def test_its_transpose_maps_a_force_to_generalized_forces(fixed_base):
    """A wrench on a link moves a body exactly as the joint torques Jᵀ F do."""
    rng = np.random.default_rng(7)
    wrench = rng.normal(size=6)
    changes = []
    for applies_wrench in (True, False):
        spec = random_tree(7, 9, fixed_base=fixed_base, joint_types=(*SCALAR_TYPES, JointType.SPHERICAL))
        world = World(time_step=1.0)
        body = world.load(spec)
        let_go(body)
        put_in_motion(body, np.random.default_rng(7))
        body.set_inertial_pose(*ORIGIN)
        link = 8
        if applies_wrench:
            world.link_force[body.first_link + 1 + link] = wrench
        else:
            com = -from_com(body, link, np.zeros(3))
            linear, angular = jacobian(body, link, com, joint_coordinates(body)[0])
            generalized = linear.T @ wrench[:3] + angular.T @ wrench[3:]
            first = body.first_velocity + (6 if fixed_base else 0)
            world.joint_torque[first : first + len(generalized)] = generalized
        before = coordinates(body)[1].copy()
        world.step()
        changes.append(coordinates(body)[1] - before)
    assert_allclose(changes[0], changes[1], rtol=0, atol=1e-11)


def test_virtual_work_balances_inverse_dynamics():
    """What inverse dynamics finds for a motion that a force causes is Jᵀ times that force."""
    world = World(time_step=1.0)
    body = world.load(random_tree(8, 7, fixed_base=True, joint_types=SCALAR_TYPES))
    let_go(body)
    put_in_motion(body, np.random.default_rng(8))
    joints, rates = (values.copy() for values in joint_coordinates(body))
    force = np.array([0.7, -0.4, 1.1])
    body.set_inertial_pose(*ORIGIN)
    world.link_force[body.first_link + 1 + 6, :3] = force
    com = -from_com(body, 6, np.zeros(3))
    linear, _ = jacobian(body, 6, com, joints)
    world.step()
    acceleration = joint_coordinates(body)[1] - rates
    assert_allclose(inverse_dynamics(body, joints, rates, acceleration), linear.T @ force, rtol=0, atol=1e-11)
