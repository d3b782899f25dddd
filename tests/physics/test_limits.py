"""Joint limits of a single joint, against what their rows say in closed form."""

import math

import numpy as np
import pytest
from tests.physics.one_joint import DT, INERTIA, OFF, Motor, free_rate, hanging_rod, joint_state, place
from tests.physics.robots import pendulum

from carom import Body, World
from carom.description import JointType
from carom.model.body_spec import BASE

RETURN = 0.2  # share of a violation taken back per step
LIMIT_IMPULSE = 100.0
LOWER, UPPER = -0.5, 1.0


def limited_rod(lower: float = LOWER, upper: float = UPPER, *, weightless: bool = True) -> Body:
    body = hanging_rod(limited=True, lower=lower, upper=upper)
    OFF.set_on(body)
    if weightless:
        body.world.gravity = (0.0, 0.0, 0.0)
        body.change_dynamics(BASE, linear_damping=0.0, angular_damping=0.0)
    return body


def rate_after_step(body: Body, q: float, v: float) -> float:
    place(body, q, v)
    body.world.step()
    return joint_state(body)[1]


# What counts as deep is a single precision 0.04 in Bullet, and so it is here.
@pytest.mark.parametrize("violation", [0.0, 0.01, 0.03, 0.03999999905])
@pytest.mark.parametrize(("limit", "outward"), [(UPPER, 1.0), (LOWER, -1.0)], ids=["upper", "lower"])
def test_a_small_violation_is_taken_back_by_a_fifth_per_step(limit, outward, violation):
    body = limited_rod()
    q = limit + outward * violation
    for v in (outward * 3.0, 0.0):
        depth = outward * (q - limit)
        assert rate_after_step(body, q, v) == pytest.approx(
            -outward * RETURN * depth / DT, rel=1e-12, abs=1e-14
        )


@pytest.mark.parametrize("violation", [0.03999999911, 0.0401, 0.5])
@pytest.mark.parametrize(("limit", "outward"), [(UPPER, 1.0), (LOWER, -1.0)], ids=["upper", "lower"])
def test_a_deep_violation_only_stops_growing(limit, outward, violation):
    body = limited_rod(lower=-1.0, upper=1.0)
    q = math.copysign(1.0, limit) + outward * violation
    assert rate_after_step(body, q, outward * 3.0) == pytest.approx(0.0, abs=1e-14)
    assert rate_after_step(body, q, -outward * 2.0) == pytest.approx(-outward * 2.0)


def test_deep_violations_are_taken_back_without_split_impulse():
    body = limited_rod()
    body.world.parameters.split_impulse = False
    body.world.apply_parameters()
    assert rate_after_step(body, UPPER + 0.1, 0.0) == pytest.approx(-RETURN * 0.1 / DT)


def test_the_share_is_the_error_reduction_parameter():
    body = limited_rod()
    body.world.parameters.erp = 0.5
    body.world.apply_parameters()
    assert rate_after_step(body, UPPER + 0.02, 0.0) == pytest.approx(-0.5 * 0.02 / DT)


def test_a_joint_that_returns_faster_is_left_alone():
    body = limited_rod()
    assert rate_after_step(body, UPPER + 0.01, -5.0) == pytest.approx(-5.0)


@pytest.mark.parametrize("q", [UPPER - 1e-9, 0.0, LOWER + 1e-9])
def test_limits_do_not_look_ahead(q):
    body = limited_rod()
    for v in (50.0, -50.0):
        assert rate_after_step(body, q, v) == pytest.approx(v)


def test_reaching_a_limit_exactly_counts():
    body = limited_rod()
    assert rate_after_step(body, UPPER, 3.0) == pytest.approx(0.0, abs=1e-14)
    assert rate_after_step(body, LOWER, -3.0) == pytest.approx(0.0, abs=1e-14)


def test_the_impulse_of_a_limit_is_bounded():
    body = limited_rod()
    v, inertia = 99.0, 10.0
    body.change_dynamics(0, mass=0.0, inertia=(inertia, inertia, inertia))
    assert rate_after_step(body, UPPER, v) == pytest.approx(v - LIMIT_IMPULSE / inertia)
    assert rate_after_step(body, LOWER, -v) == pytest.approx(-v + LIMIT_IMPULSE / inertia)
    body.change_dynamics(0, joint_limit_force=30.0 / DT)
    assert rate_after_step(body, UPPER, v) == pytest.approx(v - 30.0 / inertia)
    assert body.dynamics(0).joint_limit_impulse == pytest.approx(30.0)


def test_the_bound_is_the_force_times_the_substep_of_the_moment_it_is_set():
    body = limited_rod()
    body.world.parameters.substeps = 4
    body.world.apply_parameters()
    body.change_dynamics(0, joint_limit_force=60.0)
    assert body.dynamics(0).joint_limit_impulse == pytest.approx(60.0 * DT / 4)
    body.world.parameters.substeps = 0
    body.world.apply_parameters()
    place(body, UPPER, 1.0)
    body.world.step()
    assert joint_state(body)[1] == pytest.approx(1.0 - 60.0 * DT / 4 / INERTIA)


def test_the_rod_rests_on_its_limit():
    body = limited_rod(0.3, 2.0, weightless=False)
    place(body, 0.3, 0.0)
    body.world.step(100)
    assert joint_state(body) == (pytest.approx(0.3, abs=1e-12), pytest.approx(0.0, abs=1e-12))


def test_a_limit_stops_the_free_motion_not_the_motion_before():
    body = limited_rod(0.3, 2.0, weightless=False)
    v = -0.01
    free = free_rate(0.3 - 0.02, v)
    assert free < 0.0
    assert rate_after_step(body, 0.3 - 0.02, v) == pytest.approx(RETURN * 0.02 / DT, rel=1e-12)


def test_a_strong_motor_meets_a_limit():
    body = limited_rod()
    Motor(velocity=10.0, max_impulse=1.0).set_on(body)
    assert rate_after_step(body, UPPER, 0.0) == pytest.approx(0.0, abs=1e-9)
    # A motor stronger than the limit's greatest impulse pushes through.
    Motor(velocity=10.0, max_impulse=1e6).set_on(body)
    assert rate_after_step(body, UPPER, 0.0) > 1.0


def test_equal_limits_hold_the_joint():
    body = limited_rod(0.0, 0.0, weightless=False)
    body.world.joint_torque[6] = 5.0
    body.world.step()
    assert joint_state(body)[1] == pytest.approx(0.0, abs=1e-12)
    assert rate_after_step(body, 0.02, 1.0) == pytest.approx(-RETURN * 0.02 / DT, rel=1e-9)


def test_limits_the_engine_is_not_told_to_enforce_are_only_kept():
    body = hanging_rod(limited=False, lower=-0.1, upper=0.1)
    OFF.set_on(body)
    place(body, 0.5, 0.3)
    body.world.step()
    assert joint_state(body)[1] == pytest.approx(free_rate(0.5, 0.3))
    assert (body.dynamics(0).joint_lower_limit, body.dynamics(0).joint_upper_limit) == (-0.1, 0.1)


def test_limits_can_be_set_moved_and_removed_while_running():
    body = hanging_rod()
    body.world.gravity = (0.0, 0.0, 0.0)
    body.change_dynamics(BASE, linear_damping=0.0, angular_damping=0.0)
    OFF.set_on(body)
    assert rate_after_step(body, 0.6, 1.0) == pytest.approx(1.0)
    body.change_dynamics(0, joint_lower_limit=-0.5, joint_upper_limit=0.6)
    assert rate_after_step(body, 0.6, 1.0) == pytest.approx(0.0, abs=1e-14)
    body.change_dynamics(0, joint_upper_limit=0.7)
    assert rate_after_step(body, 0.6, 1.0) == pytest.approx(1.0)
    assert rate_after_step(body, -0.5, -1.0) == pytest.approx(0.0, abs=1e-14)
    body.change_dynamics(0, joint_lower_limit=1.0, joint_upper_limit=-1.0)
    assert rate_after_step(body, 5.0, 1.0) == pytest.approx(1.0)


def test_a_prismatic_joint_has_limits_too():
    body = World(contact="bullet").load(
        pendulum(
            joint_type=JointType.PRISMATIC, limited=True, lower=-0.2, upper=0.2, joint_axis=(1.0, 0.0, 0.0)
        )
    )
    OFF.set_on(body)
    assert rate_after_step(body, 0.23, 1.0) == pytest.approx(-RETURN * 0.03 / DT)


def test_limits_of_a_chain_hold_under_gravity():
    world = World(contact="bullet")
    world.gravity = (0.0, 0.0, -9.81)
    body = world.load(pendulum(3, limited=True, lower=-0.2, upper=0.4))
    for joint in range(3):
        OFF.set_on(body, joint)
        body.set_joint_state(joint, [0.4], [2.0])
    deepest = 0.0
    for _ in range(240):
        world.step()
        angles = world.position[7:10]
        deepest = max(deepest, float(np.maximum(angles - 0.4, -0.2 - angles).max()))
    assert deepest < 0.05
