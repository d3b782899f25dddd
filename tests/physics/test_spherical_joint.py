"""Spherical joints: coordinates, motor and limits."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.aba_reference import rotation
from tests.physics.robots import joint_coordinates, let_go, random_rotation

from carom import Body, World
from carom.algorithms import mass_matrix
from carom.description import JointType, Pose
from carom.layouts.codes import MOTOR_DAMPING, MOTOR_KP, MOTOR_MAX_IMPULSE, MOTOR_POSITION, MOTOR_TARGET_W
from carom.model.body_spec import BASE, BodySpec, LinkSpec

DT = 1.0 / 240
ERP = 0.2


def ball(*, inertia=(0.1, 0.2, 0.3), com=(0.0, 0.0, 0.0), **joint) -> Body:
    """A link of 1 kg on a spherical joint at the origin, in a world without gravity."""
    link = LinkSpec(
        "link",
        mass=1.0,
        inertia=inertia,
        inertial_frame=Pose(com),
        joint_type=JointType.SPHERICAL,
        **joint,
    )
    body = World(contact="bullet").load(BodySpec("ball", LinkSpec("base"), [link], fixed_base=True))
    body.change_dynamics(BASE, linear_damping=0.0, angular_damping=0.0)
    return body


def about(axis: int, angle: float) -> np.ndarray:
    """Quaternion of a turn about a coordinate axis."""
    q = np.zeros(4)
    q[axis], q[3] = math.sin(angle / 2), math.cos(angle / 2)
    return q


def aim(body: Body, target: np.ndarray, gain: float, damping: float = 1.0, max_impulse: float = 1e6) -> None:
    rows = body.world.motor[6:9]
    rows[:, MOTOR_POSITION], rows[0, MOTOR_TARGET_W] = target[:3], target[3]
    rows[:, MOTOR_KP], rows[:, MOTOR_DAMPING], rows[:, MOTOR_MAX_IMPULSE] = gain, damping, max_impulse


def angle_between(a: np.ndarray, b: np.ndarray) -> float:
    return 2.0 * math.acos(min(1.0, abs(float(a @ b))))


def test_it_has_a_quaternion_for_a_position_and_starts_unturned():
    body = ball()
    assert (body.position_count, body.velocity_count) == ((4,), (3,))
    assert joint_coordinates(body)[0].tolist() == [0.0, 0.0, 0.0, 1.0]


def test_rates_turn_the_link_about_its_own_axes():
    body = ball(inertia=(0.2, 0.2, 0.2))
    let_go(body)
    start = random_rotation(np.random.default_rng(0))
    rate = np.array([0.4, -0.3, 0.5])
    body.set_joint_state(0, start, rate.tolist())
    body.world.step(20)
    speed, time = float(np.linalg.norm(rate)), 20 * DT
    turned = np.array([*(rate / speed * math.sin(speed * time / 2)), math.cos(speed * time / 2)])
    position = joint_coordinates(body)[0]
    expected = rotation(np.array(start)) @ rotation(turned)
    assert_allclose(rotation(position), expected, rtol=0, atol=1e-12)
    assert_allclose(np.linalg.norm(position), 1.0, rtol=1e-15)


@pytest.mark.parametrize("axis", range(3))
def test_the_motor_takes_away_its_share_of_the_error_in_every_step(axis):
    body = ball()
    aim(body, about(axis, 0.8), gain=0.5)
    body.world.step(12)
    left = angle_between(joint_coordinates(body)[0], about(axis, 0.8))
    assert left == pytest.approx(0.8 * (1.0 - 0.5 * ERP) ** 12, rel=1e-9)


def test_the_motor_reaches_any_orientation_and_carries_a_weight_there():
    body = ball(com=(0.1, -0.2, -0.3))
    body.world.gravity = (0.0, 0.0, -9.81)
    target = np.array(random_rotation(np.random.default_rng(3)))
    aim(body, target, gain=0.5)
    body.world.step(300)
    assert angle_between(joint_coordinates(body)[0], target) < 1e-3
    axes = rotation(joint_coordinates(body)[0])
    lever = axes @ [0.1, -0.2, -0.3]
    held = axes @ body.world.motor_impulse[6:9] / DT
    assert_allclose(held, -np.cross(lever, [0.0, 0.0, -9.81]), rtol=1e-2, atol=1e-3)


def test_the_motor_starts_out_holding_the_joint_unturned():
    body = ball(com=(0.3, 0.0, 0.0))
    row = body.world.motor[6]
    assert (row[MOTOR_KP], row[MOTOR_DAMPING], row[MOTOR_MAX_IMPULSE]) == (0.2, 1.0, 1000.0)
    body.set_joint_state(0, about(1, 0.3).tolist(), None)
    body.world.step(50)
    left = angle_between(joint_coordinates(body)[0], about(1, 0.0))
    assert left == pytest.approx(0.3 * (1.0 - 0.2 * ERP) ** 50, rel=1e-9)


def test_the_impulse_of_the_motor_is_bounded_on_each_axis():
    body = ball()
    aim(body, about(2, 1.0), gain=1.0, max_impulse=0.003)
    body.world.step()
    assert_allclose(joint_coordinates(body)[1], [0.0, 0.0, 0.003 / 0.3], atol=1e-14)


def test_without_impulses_the_motor_is_off():
    body = ball()
    aim(body, about(2, 1.0), gain=1.0, max_impulse=0.0)
    body.set_joint_state(0, None, [0.0, 0.0, 2.0])
    body.world.step(10)
    assert_allclose(joint_coordinates(body)[1], [0.0, 0.0, 2.0], atol=1e-12)


def test_one_sweep_counts_the_responses_of_both_links_as_if_they_were_strangers():
    """As in Bullet; the sweeps converge all the same, only by smaller steps."""
    arm = LinkSpec("arm", mass=1.0, inertia=(0.5, 0.5, 0.5), joint_type=JointType.REVOLUTE)
    link = LinkSpec("ball", parent=0, mass=1.0, inertia=(0.1, 0.2, 0.3), joint_type=JointType.SPHERICAL)
    world = World(contact="bullet")
    world.parameters.solver_iterations = 1
    world.apply_parameters()
    body = world.load(BodySpec("arm", LinkSpec("base"), [arm, link], fixed_base=True))
    let_go(body)
    world.motor[7:10, MOTOR_MAX_IMPULSE], world.motor[7:10, MOTOR_KP] = 1e6, 0.0
    body.set_joint_state(1, None, [1.0, 0.0, 0.0])
    # Rates of the arm about x, then of the ball about its axes; both links turn with the arm.
    response = np.linalg.inv(mass_matrix(body, [0.0, 0.0, 0.0, 0.0, 1.0]))
    turning_arm, turning_ball = np.array([1.0, 0.0, 0.0, 0.0]), np.array([1.0, 1.0, 0.0, 0.0])
    strangers = float(turning_arm @ response @ turning_arm + turning_ball @ response @ turning_ball)
    world.step()
    assert_allclose(world.motor_impulse[7:10], [-1.0 / strangers, 0.0, 0.0], rtol=1e-12, atol=1e-15)
    expected = np.array([0.0, 1.0, 0.0, 0.0]) - response[:, 1] / strangers
    assert_allclose(joint_coordinates(body)[1], expected, rtol=1e-12, atol=1e-15)


def limited_ball() -> Body:
    """Swing of 0.5 rad about x, 0.4 about y, twist of 0.3 about z, held by 1000 N m s at most."""
    body = ball(lower=0.5, upper=0.4, twist=0.3, effort=1000.0)
    aim(body, about(0, 0.0), gain=0.0, max_impulse=0.0)
    return body


@pytest.mark.parametrize(
    ("axis", "bound"), [(0, 0.5), (1, 0.4), (2, 0.3)], ids=["swing x", "swing y", "twist"]
)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_limit_sends_the_joint_back_by_a_share_of_the_excess(axis, bound, side):
    body = limited_ball()
    body.set_joint_state(0, about(axis, side * (bound + 0.1)).tolist(), None)
    body.world.step(10)
    # A limit only pushes: the joint goes on as fast as the greatest excess made it.
    expected = bound + 0.1 * (1.0 - 10 * 0.2 * ERP)
    assert_allclose(joint_coordinates(body)[0], about(axis, side * expected), rtol=0, atol=1e-9)


@pytest.mark.parametrize("axis", range(3))
def test_within_its_limits_the_joint_is_free(axis):
    body = limited_ball()
    rate = np.zeros(3)
    rate[axis] = 2.0
    body.set_joint_state(0, about(axis, 0.1).tolist(), rate.tolist())
    body.world.step(5)
    assert_allclose(joint_coordinates(body)[1], rate, atol=1e-12)


def test_a_limit_stops_a_swing_that_goes_on():
    body = limited_ball()
    body.set_joint_state(0, about(0, 0.45).tolist(), [3.0, 0.0, 0.0])
    body.world.step(60)
    assert_allclose(joint_coordinates(body)[0], about(0, 0.5), rtol=0, atol=0.02)
