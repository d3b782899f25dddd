"""Planar joints slide along axes that turn with the link and act at its centre of mass."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.robots import joint_coordinates, let_go, random_rotation

from carom import Body, World
from carom.description import JointType, Pose
from carom.description.pose import IDENTITY
from carom.model.body_spec import BodySpec, LinkSpec

DT = 1.0 / 240


def slider(axis=(0.0, 0.0, 1.0), inertial_frame=IDENTITY, joint_frame=IDENTITY) -> Body:
    link = LinkSpec(
        "plate",
        mass=2.0,
        inertia=(0.1, 0.2, 0.3),
        inertial_frame=inertial_frame,
        joint_type=JointType.PLANAR,
        joint_axis=axis,
        joint_frame=joint_frame,
    )
    body = World().load(BodySpec("slider", LinkSpec("base"), [link], fixed_base=True))
    let_go(body)
    return body


def plate_position(body: Body) -> np.ndarray:
    body.update_link_poses()
    return body.world.link_pose[1, :3].copy()


def test_it_has_an_angle_and_two_translations():
    body = slider()
    assert (body.position_count, body.velocity_count) == ((3,), (3,))


@pytest.mark.parametrize(
    ("axis", "first", "second"),
    [
        # The first direction is the normal cross x, or cross y for a normal along x.
        ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)),
        ((0.0, 1.0, 0.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)),
        ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    ],
    ids=["z", "y", "x"],
)
def test_directions_of_the_translations(axis, first, second):
    body = slider(axis)
    for coordinate, direction in ((1, first), (2, second)):
        position = joint_coordinates(body)[0]
        position[:] = 0.0
        position[coordinate] = 0.7
        assert_allclose(plate_position(body), 0.7 * np.array(direction), rtol=0, atol=1e-15)


def test_positions_are_counted_along_axes_that_do_not_turn():
    body = slider()
    joint_coordinates(body)[0][:] = [math.pi / 2, 0.3, 0.4]
    assert_allclose(plate_position(body), [0.4, 0.3, 0.0], atol=1e-15)
    assert_allclose(body.world.link_pose[1, 3:], [0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)])


def test_rates_are_along_axes_that_turn_with_the_plate():
    body = slider()
    body.set_joint_state(0, [math.pi / 2, 0.0, 0.0], [0.0, 1.0, 0.0])
    body.world.step()
    # The first direction, y at first, points along -x after a quarter turn.
    assert_allclose(plate_position(body), [-DT, 0.0, 0.0], atol=1e-15)
    assert_allclose(joint_coordinates(body)[0], [math.pi / 2, 0.0, -DT], atol=1e-15)


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.48, 0.6, 0.64)])
def test_it_moves_as_its_link_velocity_says(axis):
    rng = np.random.default_rng(1)
    body = slider(
        axis,
        Pose((0.0, 0.0, 0.0), random_rotation(rng)),
        Pose((0.1, 0.2, 0.3), random_rotation(rng)),
    )
    body.set_joint_state(0, [0.4, -0.3, 0.2], [2.0, 0.5, -0.7])
    for _ in range(5):
        before = plate_position(body)
        body.world.step()
        moved = plate_position(body) - before
        body.update_link_velocities()
        assert_allclose(moved / DT, body.world.link_velocity[1, :3], rtol=0, atol=1e-11)


def test_without_forces_the_plate_flies_straight_on_while_it_spins():
    body = slider()
    body.set_joint_state(0, [0.0, 0.0, 0.0], [3.0, 1.0, 0.0])
    steps = 240
    body.world.step(steps)
    # Exactly straight as the time step goes to zero.
    assert_allclose(plate_position(body), [0.0, 1.0, 0.0], atol=0.02)
    assert joint_coordinates(body)[0][0] == pytest.approx(3.0)


def test_the_centre_of_mass_is_where_the_joint_is():
    """As in Bullet the offset of the centre of mass counts for nothing."""
    body = slider(inertial_frame=Pose((0.5, 0.6, 0.7)), joint_frame=Pose((1.0, 2.0, 3.0)))
    assert_allclose(plate_position(body), [1.0, 2.0, 3.0])
    body.world.joint_torque[6:9] = [0.6, 0.0, 0.0]
    body.world.step()
    assert_allclose(joint_coordinates(body)[1], [0.6 / 0.3 * DT, 0.0, 0.0], atol=1e-15)


def test_gravity_pulls_it_along_its_plane_only():
    body = slider()
    body.world.gravity = (0.3, 0.5, -9.81)
    body.world.step(10)
    assert_allclose(joint_coordinates(body)[1], [0.0, 10 * DT * 0.5, 10 * DT * 0.3], atol=1e-14)
