"""Forces of one step: joint torques, joint damping, explicit PD, and what substeps make of them."""

import math
from typing import Any

import pytest
from tests.physics.one_joint import DT, INERTIA, OFF, Motor, free_rate, hanging_rod, joint_state, place

from carom import Body
from carom.description import JointType
from carom.layouts.codes import PD_KD, PD_KP, PD_MAX_FORCE, PD_POSITION, PD_VELOCITY
from carom.model.body_spec import BASE


def loose_rod(**joint: Any) -> Body:
    body = hanging_rod(**joint)
    OFF.set_on(body)
    return body


def weightless_rod(substeps: int = 0, time_step: float = DT) -> Body:
    body = loose_rod()
    body.world.parameters.time_step = time_step
    body.world.parameters.substeps = substeps
    body.world.gravity = (0.0, 0.0, 0.0)
    body.change_dynamics(BASE, linear_damping=0.0, angular_damping=0.0)
    return body


def drive(body: Body, position: float, velocity: float, kp: float, kd: float, max_force: float) -> None:
    row = body.world.pd[body.velocity_index[0]]
    row[PD_POSITION], row[PD_VELOCITY], row[PD_KP], row[PD_KD], row[PD_MAX_FORCE] = (
        position,
        velocity,
        kp,
        kd,
        max_force,
    )


def test_a_constant_torque_accelerates_evenly():
    body = weightless_rod()
    n = 60
    for _ in range(n):
        body.world.joint_torque[6] = 0.5
        body.world.step()
    rate = n * DT * 0.5 / INERTIA
    assert joint_state(body) == (pytest.approx(rate * DT * (n + 1) / 2), pytest.approx(rate))


def test_a_torque_lasts_for_one_step():
    body = weightless_rod()
    body.world.joint_torque[6] = 3.0
    body.world.step()
    assert body.world.joint_torque[6] == 0.0
    rate = joint_state(body)[1]
    body.world.step()
    assert joint_state(body)[1] == pytest.approx(rate, rel=1e-14)


def test_free_swing_follows_the_closed_form():
    body = loose_rod(damping=0.3)
    q, v = 2.5, -3.0
    place(body, q, v)
    for n in range(50):
        torque = math.cos(n)
        body.world.joint_torque[6] = torque
        v = free_rate(q, v, torque, damping=0.3)
        q += DT * v
        body.world.step()
        assert joint_state(body) == (pytest.approx(q, rel=1e-12), pytest.approx(v, rel=1e-11))


@pytest.mark.parametrize("share", [0.1, 1.0, 1.9, 2.5])
def test_joint_damping_is_explicit(share):
    """A step takes away dt·d/I of the rate, be it more than there is."""
    body = weightless_rod()
    body.change_dynamics(0, joint_damping=share * INERTIA / DT)
    place(body, 0.0, 1.0)
    for n in range(1, 4):
        body.world.step()
        assert joint_state(body)[1] == pytest.approx((1.0 - share) ** n, abs=1e-13)


def test_joint_damping_is_taken_at_the_rate_before_all_substeps():
    body = weightless_rod(substeps=4)
    body.change_dynamics(0, joint_damping=0.5 * INERTIA / DT)
    place(body, 0.0, 1.0)
    body.world.step()
    assert joint_state(body)[1] == pytest.approx(0.5)


@pytest.mark.parametrize("target", [0.8, -0.8])
@pytest.mark.parametrize(
    ("kp", "kd", "max_force"), [(30.0, 0.0, 100.0), (30.0, 2.0, 100.0), (300.0, 2.0, 4.0), (0.0, 5.0, 1.0)]
)
def test_explicit_pd_is_a_bounded_spring_and_damper(kp, kd, max_force, target):
    body = loose_rod()
    drive(body, target, 0.3, kp, kd, max_force)
    q, v = 0.1, -0.5
    place(body, q, v)
    for _ in range(20):
        torque = kp * (target - q) + kd * (0.3 - v)
        v = free_rate(q, v, max(-max_force, min(max_force, torque)))
        q += DT * v
        body.world.step()
        assert joint_state(body) == (pytest.approx(q, rel=1e-12), pytest.approx(v, rel=1e-11))


def test_explicit_pd_drives_prismatic_joints():
    body = loose_rod(joint_type=JointType.PRISMATIC, joint_axis=(1.0, 0.0, 0.0))
    body.change_dynamics(BASE, linear_damping=0.0, angular_damping=0.0)
    drive(body, 0.5, 0.0, 10.0, 1.0, 1e3)
    body.world.step()
    assert joint_state(body)[1] == pytest.approx(DT * 5.0 / 2.0)


def test_explicit_pd_without_force_is_off():
    body = weightless_rod()
    drive(body, 1.0, 0.0, 10.0, 1.0, 0.0)
    body.world.step()
    assert joint_state(body)[1] == 0.0


def test_a_torque_acts_in_all_substeps():
    body = weightless_rod(substeps=4, time_step=0.25)
    body.world.joint_torque[6] = 0.5
    body.world.step()
    part, rate = 0.0625, 0.5 / INERTIA
    q = sum(part * part * rate * n for n in (1, 2, 3, 4))
    assert joint_state(body) == (pytest.approx(q), pytest.approx(0.25 * rate))


def test_a_force_on_a_link_acts_in_all_substeps():
    body = weightless_rod(substeps=4, time_step=1.0 / 256)
    body.world.link_force[1] = [0.4, 0.0, 0.0, 0.0, 0.0, 0.0]
    body.world.step()
    # Half a metre below a joint about y; the arm hardly turns meanwhile.
    assert joint_state(body)[1] == pytest.approx(-0.2 / INERTIA / 256, rel=1e-6)
    assert not body.world.link_force.any()


def test_explicit_pd_adds_up_over_substeps():
    """As in Bullet each substep adds the drive's torque of that moment to those before."""
    body = weightless_rod(substeps=3, time_step=0.375)
    kp, kd, part = 0.9, 0.2, 0.125
    drive(body, 1.0, 0.0, kp, kd, 1e3)
    q, v, torque = 0.2, 0.1, 0.0
    place(body, q, v)
    for _ in range(3):
        torque += kp * (1.0 - q) - kd * v
        v += part * torque / INERTIA
        q += part * v
    body.world.step()
    assert joint_state(body) == (pytest.approx(q), pytest.approx(v))
    body.world.step()
    torque = 0.0
    for _ in range(3):
        torque += kp * (1.0 - q) - kd * v
        v += part * torque / INERTIA
        q += part * v
    assert joint_state(body) == (pytest.approx(q), pytest.approx(v))


def test_the_impulse_of_a_motor_is_per_substep():
    body = weightless_rod(substeps=4, time_step=0.25)
    Motor(velocity=50.0, max_impulse=0.5).set_on(body)
    body.world.step()
    assert joint_state(body)[1] == pytest.approx(4 * 0.5 / INERTIA)
    assert body.world.motor_impulse[6] == pytest.approx(0.5)


def test_substeps_are_smaller_steps():
    """But for forces that last a whole step, n substeps are n steps of a fraction of the time."""
    parts, steps = loose_rod(), loose_rod()
    parts.world.parameters.substeps = 4
    parts.world.parameters.time_step = 1.0 / 64
    parts.world.apply_parameters()
    steps.world.parameters.time_step = 1.0 / 256
    steps.world.apply_parameters()
    for body in (parts, steps):
        place(body, 1.0, 0.0)
    parts.world.step(10)
    steps.world.step(40)
    assert joint_state(parts) == joint_state(steps)
    assert parts.world.time == steps.world.time == 10 / 64
