"""Recursive Newton-Euler against the accelerations of a step, and against closed forms."""

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from tests.physics.aba_reference import rotation
from tests.physics.robots import coordinates, joint_coordinates, let_go, pendulum, put_in_motion, random_tree

from carom import Body, World
from carom.algorithms import inverse_dynamics, mass_matrix
from carom.algorithms.mechanism import forces_of_motion, mechanism_of
from carom.description.transform import quaternion_from_rpy, rpy_from_quaternion
from carom.layouts.codes import MOTOR_MAX_IMPULSE

GRAVITY = (0.4, -0.2, -9.81)
COMPONENTS = st.floats(-1.0, 1.0)
UNIT_QUATERNIONS = (
    st.tuples(COMPONENTS, COMPONENTS, COMPONENTS, COMPONENTS)
    .filter(lambda numbers: math.hypot(*numbers) > 0.1)
    .map(lambda numbers: tuple(number / math.hypot(*numbers) for number in numbers))
)


def moving_body(seed: int, link_count: int, *, fixed_base: bool, is_chain: bool = False) -> Body:
    world = World(time_step=1.0)
    world.gravity = GRAVITY
    body = world.load(random_tree(seed, link_count, fixed_base=fixed_base, is_chain=is_chain))
    let_go(body)
    put_in_motion(body, np.random.default_rng(seed), speed=0.2)
    return body


def forces_of_last_step(body: Body, position: np.ndarray, before: np.ndarray) -> np.ndarray:
    """What inverse dynamics says the step of 1 s that changed the velocity from `before` took."""
    acceleration = coordinates(body)[1] - before
    if body.fixed_base:
        return inverse_dynamics(body, position[7:], before[6:], acceleration[6:])
    to_base = rotation(position[3:7]).T

    def along_base(rates: np.ndarray) -> np.ndarray:
        return np.concatenate([to_base @ rates[:3], to_base @ rates[3:6], rates[6:]])

    return inverse_dynamics(body, position, along_base(before), along_base(acceleration))


@pytest.mark.parametrize("fixed_base", [True, False], ids=["fixed", "free"])
@pytest.mark.parametrize(
    ("link_count", "is_chain"), [(1, True), (8, False), (20, True), (60, False), (200, False)]
)
def test_it_finds_the_forces_that_caused_a_motion(link_count, is_chain, fixed_base):
    body = moving_body(link_count, link_count, fixed_base=fixed_base, is_chain=is_chain)
    position, velocity = (values.copy() for values in coordinates(body))
    torque = np.random.default_rng(0).normal(size=len(velocity) - 6)
    body.world.joint_torque[body.first_velocity + 6 :][: len(torque)] = torque
    body.world.step()
    # Nothing but gravity pushes a free base.
    expected = torque if fixed_base else np.concatenate([np.zeros(6), torque])
    assert_allclose(forces_of_last_step(body, position, velocity), expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("fixed_base", [True, False], ids=["fixed", "free"])
def test_it_inverts_the_dynamics_of_a_chain_of_200_links(fixed_base):
    """Such a chain whips: what is to vanish are differences of forces thousands of times as large."""
    body = moving_body(7, 200, fixed_base=fixed_base, is_chain=True)
    position, velocity = (values.copy() for values in coordinates(body))
    at_rest, matrix = np.zeros(len(velocity) - 6), mass_matrix(body, position[7:])
    body.world.step()
    change = coordinates(body)[1] - velocity
    largest = (np.abs(matrix) @ np.abs(change[-len(matrix) :])).max()
    expected = at_rest if fixed_base else np.concatenate([np.zeros(6), at_rest])
    found = forces_of_last_step(body, position, velocity)
    assert_allclose(found, expected, rtol=0, atol=1e-11 * largest)
    assert_allclose(found, expected, rtol=0, atol=1e-6)


def test_forces_on_a_free_base_are_those_applied_to_it():
    body = moving_body(3, 6, fixed_base=False)
    position, velocity = (values.copy() for values in coordinates(body))
    force, torque = np.array([1.0, -2.0, 3.0]), np.array([0.3, 0.2, -0.1])
    body.world.link_force[body.first_link] = [*force, *torque]
    body.world.step()
    to_base = rotation(position[3:7]).T
    found = forces_of_last_step(body, position, velocity)
    assert_allclose(found[:3], to_base @ force, rtol=0, atol=1e-11)
    assert_allclose(found[3:6], to_base @ torque, rtol=0, atol=1e-11)
    assert_allclose(found[6:], 0.0, atol=1e-11)


def test_a_pendulum_at_rest_weighs_on_its_joint():
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    body = world.load(pendulum())
    for angle in (0.0, 0.4, math.pi / 2):
        held = inverse_dynamics(body, [angle], [0.0], [0.0])
        assert_allclose(held, [2.0 * 9.81 * 0.5 * math.sin(angle)], rtol=1e-14, atol=1e-14)


def test_the_state_of_the_world_is_neither_used_nor_changed():
    body = moving_body(4, 7, fixed_base=True)
    other = body.world.load(random_tree(5, 3, fixed_base=False))
    put_in_motion(other, np.random.default_rng(1))
    rng = np.random.default_rng(2)
    positions, rates = (rng.normal(size=len(values)) for values in joint_coordinates(body))
    accelerations = rng.normal(size=len(rates))
    names = ("position", "velocity", "motor", "joint_torque", "link_pose", "link_force")
    before = {name: getattr(body.world, name).copy() for name in names}
    answer = inverse_dynamics(body, positions, rates, accelerations)
    for name, values in before.items():
        np.testing.assert_array_equal(getattr(body.world, name), values)
    body.set_joint_state(0, [0.5] * body.position_count[0], [1.0] * body.velocity_count[0])
    np.testing.assert_array_equal(inverse_dynamics(body, positions, rates, accelerations), answer)


def test_it_compensates_gravity():
    """An arm whose motors are off stays where it is under the torques for no acceleration."""
    world = World()
    world.gravity = GRAVITY
    body = world.load(random_tree(11, 7, fixed_base=True))
    put_in_motion(body, np.random.default_rng(11), speed=0.0)
    world.motor[:, MOTOR_MAX_IMPULSE] = 0.0
    position, velocity = joint_coordinates(body)
    start = position.copy()
    at_rest = np.zeros_like(velocity)
    for _ in range(24):
        first = body.first_velocity + 6
        world.joint_torque[first : first + len(at_rest)] = inverse_dynamics(body, position, at_rest, at_rest)
        world.step()
    assert_allclose(position, start, rtol=0, atol=1e-11)
    assert_allclose(velocity, 0.0, atol=1e-10)


def test_gravity_changed_later_counts():
    world = World()
    body = world.load(pendulum())
    assert inverse_dynamics(body, [1.0], [0.0], [0.0])[0] == 0.0
    world.gravity = (0.0, 0.0, -1.0)
    assert_allclose(inverse_dynamics(body, [1.0], [0.0], [0.0]), [math.sin(1.0)], rtol=1e-14)


def test_a_fixed_base_can_be_taken_to_be_turned_otherwise():
    turn = [0.0, math.sin(0.4), 0.0, math.cos(0.4)]
    spec = random_tree(3, 5, fixed_base=True)
    turned, level = World(), World()
    turned.gravity = level.gravity = GRAVITY
    one, other = turned.load(spec, orientation=turn), level.load(spec)
    rest = np.zeros(sum(one.velocity_count))
    position = coordinates(one)[0][7:]
    as_if_level = inverse_dynamics(
        one, position, rest, rest, base_orientation=coordinates(other)[0][3:7].tolist()
    )
    assert_allclose(as_if_level, inverse_dynamics(other, position, rest, rest), rtol=0, atol=1e-12)
    assert np.abs(as_if_level - inverse_dynamics(one, position, rest, rest)).max() > 0.01


def test_answers_stay_right_when_bodies_come_and_go():
    world = World()
    world.gravity = GRAVITY
    bodies = [world.load(random_tree(n, 4 + n, fixed_base=True)) for n in range(4)]

    def ask(body: Body) -> np.ndarray:
        count = len(joint_coordinates(body)[1])
        position = 0.3 * np.ones(len(joint_coordinates(body)[0]))
        return inverse_dynamics(body, position, np.linspace(-1.0, 1.0, count), np.linspace(2.0, 1.0, count))

    expected = {body.id: ask(body) for body in bodies}
    world.remove(bodies.pop(0).id)
    for body in bodies:
        np.testing.assert_array_equal(ask(body), expected[body.id])
    newcomer = world.load(random_tree(9, 40, fixed_base=True))
    ask(newcomer)
    for body in bodies:
        np.testing.assert_array_equal(ask(body), expected[body.id])


def gravity_turned_back(quaternion, *, opposite_order: bool) -> np.ndarray:
    """Gravity seen from a base, by the forces that hold a free body up which is turned like this."""
    world = World()
    world.gravity = GRAVITY
    body = world.load(random_tree(1, 1, fixed_base=False))
    forces = forces_of_motion(mechanism_of(body), as_pybullet=opposite_order)
    dofs = sum(body.velocity_count)
    position = [0.1, 0.2, 0.3, *quaternion, *np.zeros(dofs)]
    still = [0.0] * (6 + dofs)
    mass = sum(link.mass for link in body.links)
    return -np.array(forces(world.parameters.gravity, position, still, still))[:3] / mass


@given(turn=UNIT_QUATERNIONS)
def test_gravity_of_a_free_base_is_turned_back(turn):
    expected = rotation(np.array(turn)).T @ GRAVITY
    assert_allclose(gravity_turned_back(turn, opposite_order=False), expected, atol=1e-9)


@given(turn=UNIT_QUATERNIONS)
@example((0.0, math.sqrt(0.5), 0.0, math.sqrt(0.5)))
@example((0.5, -0.5, 0.5, 0.5))
@example((-0.3, math.sqrt(0.41), 0.3, math.sqrt(0.41)))
@example((1.0, 0.0, 0.0, 0.0))
def test_pybullet_puts_roll_pitch_and_yaw_together_the_other_way_round(turn):
    angles = rpy_from_quaternion(turn)
    about_x, about_y, about_z = (
        rotation(np.array(quaternion_from_rpy(*np.where(np.arange(3) == axis, angles, 0.0))))
        for axis in range(3)
    )
    expected = (about_x @ about_y @ about_z).T @ GRAVITY
    assert_allclose(gravity_turned_back(turn, opposite_order=True), expected, atol=1e-9)


@pytest.mark.parametrize("place", range(13))
def test_a_free_base_takes_finite_numbers_only(place):
    body = World().load(random_tree(2, 1, fixed_base=False))
    dofs = sum(body.velocity_count)
    position = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, *np.zeros(dofs)])
    rates = np.zeros(6 + dofs)
    (position if place < 7 else rates)[place if place < 7 else place - 7] = math.nan
    with pytest.raises(ValueError, match="finite"):
        inverse_dynamics(body, position, rates, np.zeros(6 + dofs))


def test_a_quaternion_without_length_is_no_orientation():
    body = World().load(random_tree(2, 1, fixed_base=False))
    still = np.zeros(6 + sum(body.velocity_count))
    with pytest.raises(ValueError, match="finite"):
        inverse_dynamics(body, np.zeros(7 + len(still) - 6), still, still)


@pytest.mark.parametrize("fixed_base", [True, False], ids=["fixed", "free"])
def test_lists_have_to_fit_the_body(fixed_base):
    body = World().load(random_tree(2, 3, fixed_base=fixed_base))
    rates = np.zeros(sum(body.velocity_count) + (0 if fixed_base else 6))
    positions = np.zeros(sum(body.position_count) + (0 if fixed_base else 7))
    for more in ((1, 0, -1), (-1, 1, 0), (0, 1, -1), (0, 0, 1)):
        q, qd, qdd = (
            np.resize(values, len(values) + n)
            for values, n in zip((positions, rates, rates), more, strict=True)
        )
        with pytest.raises(ValueError, match="fit"):
            inverse_dynamics(body, q, qd, qdd)
