"""Motors of a single joint, against what their rows say in closed form."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.physics.one_joint import (
    DT,
    INERTIA,
    OFF,
    WEIGHT_MOMENT,
    Motor,
    free_rate,
    hanging_rod,
    joint_state,
    place,
)
from tests.thorough.profiles import cases

from carom import Body
from carom.description import JointType
from carom.layouts.codes import MOTOR_KD, MOTOR_KP, MOTOR_MAX_IMPULSE, MOTOR_VELOCITY, MOTOR_VELOCITY_CLAMP


def assert_steps_follow(body: Body, motor: Motor, q: float, v: float, count: int = 3) -> None:
    """The rod moves as the closed form says, and the motor reports its impulse."""
    place(body, q, v)
    motor.set_on(body)
    for _ in range(count):
        free = free_rate(q, v)
        impulse = motor.impulse(q, free)
        v = max(-100.0, min(100.0, free + impulse / INERTIA))
        q = q + DT * v
        body.world.step()
        assert joint_state(body) == (
            pytest.approx(q, rel=1e-13, abs=1e-13),
            pytest.approx(v, rel=1e-12, abs=1e-13),
        )
        if motor.max_impulse:
            reported = body.world.motor_impulse[body.velocity_index[0]]
            assert reported == pytest.approx(impulse, rel=1e-11, abs=1e-12)


angles = st.floats(-3.0, 3.0)
rates = st.floats(-5.0, 5.0)
gains = st.floats(0.0, 1.0)


@pytest.fixture(scope="module")
def rod() -> Body:
    return hanging_rod()


@settings(max_examples=cases(100), deadline=None)
@given(
    q=angles,
    v=rates,
    motor=st.builds(
        Motor,
        position=angles,
        velocity=rates,
        kp=gains,
        kd=gains,
        max_impulse=st.one_of(st.floats(0.0, 2.0), st.just(1e6)),
        clamp=st.one_of(st.floats(0.0, 3.0), st.just(math.inf)),
    ),
)
def test_any_motor(rod, q, v, motor):
    assert_steps_follow(rod, motor, q, v)


@pytest.mark.parametrize(
    ("motor", "q", "v"),
    [
        (Motor(), 0.3, 0.1),
        (Motor(), 1.4, 20.0),
        (Motor(position=1.0, kp=0.1, kd=1.0, max_impulse=1e3), 0.2, -0.4),
        (Motor(position=1.0, kp=0.1, kd=1.0, max_impulse=50.0 * DT), 0.2, -0.4),
        (Motor(position=1.0, kp=0.1, max_impulse=1e3, clamp=1.5), 0.0, 0.0),
        (Motor(velocity=2.0, kd=0.5, max_impulse=1e3), 0.0, 0.3),
    ],
    ids=[
        "default holds",
        "default too weak",
        "position",
        "weak position",
        "bounded speed",
        "partial velocity",
    ],
)
def test_typical_motors(rod, motor, q, v):
    assert_steps_follow(rod, motor, q, v, count=20)


def test_every_joint_starts_with_a_motor_that_brakes_it():
    row = hanging_rod().world.motor[6]
    assert (row[MOTOR_KP], row[MOTOR_KD], row[MOTOR_VELOCITY]) == (0.0, 1.0, 0.0)
    assert (row[MOTOR_MAX_IMPULSE], row[MOTOR_VELOCITY_CLAMP]) == (1.0, math.inf)


def test_the_default_motor_holds_what_it_can_carry():
    body = hanging_rod()
    place(body, math.pi / 2, 0.0)
    body.world.step(240)
    q, v = joint_state(body)
    assert q == pytest.approx(math.pi / 2, abs=1e-12)
    assert v == pytest.approx(0.0, abs=1e-13)
    assert body.world.motor_impulse[6] / DT == pytest.approx(WEIGHT_MOMENT, rel=1e-12)


def test_a_motor_without_force_is_off_and_keeps_its_last_report():
    body = hanging_rod()
    place(body, 1.0, 0.0)
    body.world.step()
    reported = float(body.world.motor_impulse[6])
    assert reported == pytest.approx(WEIGHT_MOMENT * math.sin(1.0) * DT, rel=1e-12)
    q, v = joint_state(body)
    OFF.set_on(body)
    body.world.step()
    assert joint_state(body)[1] == pytest.approx(free_rate(q, v), rel=1e-13)
    assert body.world.motor_impulse[6] == reported


def test_position_gain_takes_away_its_share_of_the_error_in_every_step():
    body = hanging_rod()
    Motor(position=1.0, kp=0.1, max_impulse=1e6).set_on(body)
    body.world.step(30)
    assert 1.0 - joint_state(body)[0] == pytest.approx(0.9**30, rel=1e-12)


def test_a_strong_motor_drives_a_prismatic_joint():
    body = hanging_rod(joint_type=JointType.PRISMATIC, joint_axis=(0.0, 0.0, 1.0))
    Motor(velocity=0.5, max_impulse=1e6).set_on(body)
    body.world.step(48)
    assert joint_state(body) == (pytest.approx(0.1), pytest.approx(0.5))
    # It carries the rod, and gives it back what the damping of a moving link takes.
    carried = body.world.motor_impulse[6] / DT
    k = float(np.float32(0.04))
    assert carried == pytest.approx(2.0 * 9.81 + 2.0 * 0.5 * k * 1.5, rel=1e-9)
