import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from carom.control import PID

gain = st.floats(-50.0, 50.0)
signal = st.floats(-1e3, 1e3)
time_step = st.floats(1e-4, 0.5)
sample = st.tuples(signal, signal, time_step)
anti_windup = st.sampled_from([None, 0.01, 1.0])
derivative_on = st.sampled_from(["measurement", "error"])


def test_proportional_term_is_gain_times_error_plus_feed_forward():
    assert PID(kp=3.0).update(2.0, 0.5, dt=0.1, feed_forward=0.25) == pytest.approx(3.0 * 1.5 + 0.25)


def test_integral_of_a_constant_error_grows_with_time_whatever_the_step():
    for dt in (0.5, 0.1, 0.01):
        pid = PID(kp=0.0, ki=2.0)
        outputs = [pid.update(1.5, 1.0, dt) for _ in range(round(1.0 / dt))]
        assert outputs[-1] == pytest.approx(2.0 * 0.5 * 1.0)


def test_derivative_is_zero_at_the_first_update_and_exact_on_a_ramp():
    pid = PID(kp=0.0, kd=2.0)
    outputs = [pid.update(0.0, 3.0 * k * 0.1, dt=0.1) for k in range(4)]
    assert outputs[0] == 0.0
    assert_allclose(outputs[1:], -2.0 * 3.0)


def test_a_setpoint_step_kicks_only_when_the_error_is_differentiated():
    on_measurement, on_error = PID(0.0, kd=1.0), PID(0.0, kd=1.0, derivative_on="error")
    for pid in (on_measurement, on_error):
        pid.update(0.0, 0.0, dt=0.1)
    assert on_measurement.update(1.0, 0.0, dt=0.1) == 0.0
    assert on_error.update(1.0, 0.0, dt=0.1) == pytest.approx(10.0)


@pytest.mark.parametrize("steps_per_time_constant", [50, 200])
def test_filtered_derivative_approaches_a_ramp_as_a_first_order_lag(steps_per_time_constant):
    tau = 0.2
    dt = tau / steps_per_time_constant
    pid = PID(0.0, kd=1.0, derivative_on="error", derivative_filter=tau)
    pid.update(0.0, 0.0, dt)
    outputs = [pid.update(k * dt, 0.0, dt) for k in range(1, steps_per_time_constant + 1)]
    assert outputs[-1] == pytest.approx(1.0 - math.exp(-1.0), abs=1.0 / steps_per_time_constant)


def test_filtered_derivative_is_stable_for_steps_far_longer_than_its_time_constant():
    pid = PID(0.0, kd=1.0, derivative_on="error", derivative_filter=1e-3)
    outputs = [pid.update(0.5 * k, 0.0, dt=0.5) for k in range(20)]
    assert_allclose(outputs[5:], 1.0, rtol=1e-9)


@given(gain, gain, gain, st.lists(sample, min_size=1, max_size=30), anti_windup, derivative_on)
def test_output_and_integral_never_leave_their_limits(kp, ki, kd, samples, tracking_time, on):
    pid = PID(
        kp,
        ki,
        kd,
        output_limits=(-2.0, 5.0),
        integral_limits=(-1.0, 3.0),
        derivative_on=on,
        derivative_filter=0.05,
        tracking_time=tracking_time,
    )
    for setpoint, measurement, dt in samples:
        assert -2.0 <= pid.update(setpoint, measurement, dt, feed_forward=0.3) <= 5.0
        assert -1.0 <= pid.integral <= 3.0


@given(st.floats(0.1, 20.0), st.floats(0.1, 20.0), st.floats(1.0, 1e3), time_step)
def test_conditional_integration_stops_at_saturation_and_resumes_when_the_error_turns(kp, ki, error, dt):
    pid = PID(kp, ki, output_limits=(-1.0, 1.0))
    for _ in range(50):
        pid.update(error, 0.0, dt)
    frozen = pid.integral
    assert frozen <= 1.0
    pid.update(-1e-3, 0.0, dt)
    assert_allclose(pid.integral, frozen - ki * 1e-3 * dt, atol=1e-12)


def test_back_calculation_settles_where_integration_and_bleeding_balance():
    kp, ki, tracking_time, limit, error = 2.0, 4.0, 0.1, 1.0, 3.0
    pid = PID(kp, ki, output_limits=(-limit, limit), tracking_time=tracking_time)
    for _ in range(5000):
        pid.update(error, 0.0, dt=1e-3)
    # ki·e = excess / tracking time, and the excess is measured before the bleeding of that step.
    excess = ki * error * tracking_time
    assert pid.integral == pytest.approx(limit + excess - kp * error - ki * error * 1e-3, rel=1e-6)


def overshoot(**options: Any) -> float:
    """The overshoot of a unit mass pushed to 1 m by a controller that can push with at most 1 N."""
    pid = PID(kp=3.0, ki=1.0, kd=4.0, derivative_filter=0.01, **options)
    position = velocity = furthest = 0.0
    for _ in range(10_000):
        force = np.clip(pid.update(1.0, position, dt=1e-3), -1.0, 1.0)
        velocity += force * 1e-3
        position += velocity * 1e-3
        furthest = max(furthest, position)
    return furthest - 1.0


def test_both_kinds_of_anti_windup_overshoot_less_than_none():
    wound_up = overshoot()
    assert overshoot(output_limits=(-1.0, 1.0)) < 0.9 * wound_up
    assert overshoot(output_limits=(-1.0, 1.0), tracking_time=0.2) < 0.9 * wound_up


@given(gain, gain, gain, signal, signal, signal)
def test_preload_takes_over_without_a_jump(kp, ki, kd, output, setpoint, measurement):
    pid = PID(kp, ki, kd)
    pid.update(1.0, -1.0, dt=0.1)
    pid.preload(output, setpoint, measurement, feed_forward=2.0)
    dt = 1e-6
    expected = output + ki * (setpoint - measurement) * dt
    assert_allclose(pid.update(setpoint, measurement, dt, feed_forward=2.0), expected, atol=1e-8)


def test_a_new_integral_gain_does_not_make_the_output_jump():
    pid = PID(kp=1.0, ki=1.0)
    before = [pid.update(1.0, 0.0, dt=0.1) for _ in range(10)][-1]
    pid.ki = 5.0
    assert pid.update(1.0, 0.0, dt=1e-9) == pytest.approx(before, abs=1e-6)


def test_reset_forgets_integral_and_derivative():
    used, fresh = PID(1.0, 2.0, 3.0), PID(1.0, 2.0, 3.0)
    used.update(1.0, 0.2, dt=0.1)
    used.update(-1.0, 0.7, dt=0.1)
    used.reset()
    assert used.update(0.5, 0.1, dt=0.1) == fresh.update(0.5, 0.1, dt=0.1)


def test_reset_clips_the_integral_it_is_given():
    pid = PID(0.0, integral_limits=(-1.0, 2.0))
    pid.reset(integral=7.0)
    assert pid.update(0.0, 0.0, dt=0.1) == 2.0


@given(st.lists(st.tuples(sample, sample, sample), min_size=1, max_size=10), anti_windup, derivative_on)
def test_an_array_controller_equals_one_controller_per_element(history, tracking_time, on):
    kp, ki, kd = np.array([1.0, 20.0, -3.0]), np.array([0.5, 0.0, 4.0]), 0.2
    upper = np.array([5.0, 1.0, np.inf])
    options: dict[str, Any] = {"derivative_on": on, "derivative_filter": 0.02, "tracking_time": tracking_time}
    together = PID(kp, ki, kd, output_limits=(-2.0, upper), **options)
    alone = [PID(kp[i], ki[i], kd, output_limits=(-2.0, upper[i]), **options) for i in range(3)]
    for samples in history:
        setpoints, measurements, (dt, *_) = zip(*samples, strict=True)
        output = together.update(setpoints, measurements, dt)
        rows = zip(alone, setpoints, measurements, strict=True)
        expected = [pid.update(setpoint, measurement, dt) for pid, setpoint, measurement in rows]
        assert_allclose(output, expected, rtol=1e-14)


def test_scalars_in_give_a_float_out_and_arrays_an_array_of_the_broadcast_shape():
    assert isinstance(PID(1.0).update(1.0, 0.0, dt=0.1), float)
    assert PID([1.0, 2.0]).update(1.0, [[0.0], [1.0], [2.0]], dt=0.1).shape == (3, 2)


@pytest.mark.parametrize(
    ("argument", "value"),
    [
        *itertools.product(["kp", "ki", "kd"], [math.nan, math.inf, [1.0, math.nan]]),
        ("output_limits", (1.0, 0.0)),
        ("output_limits", (math.nan, 1.0)),
        ("integral_limits", ([0.0, 2.0], 1.0)),
        ("derivative_on", "setpoint"),
        ("derivative_filter", -0.1),
        ("derivative_filter", math.nan),
        ("tracking_time", 0.0),
        ("tracking_time", math.inf),
    ],
)
def test_bad_parameters_are_refused_by_name(argument, value):
    with pytest.raises(ValueError, match=argument):
        PID(**{"kp": 1.0, argument: value})


@pytest.mark.parametrize(
    ("name", "signals"),
    [
        ("dt", (0.0, 0.0, 0.0)),
        ("dt", (0.0, 0.0, -0.1)),
        ("dt", (0.0, 0.0, math.nan)),
        ("setpoint", (math.nan, 0.0, 0.1)),
        ("measurement", (0.0, math.inf, 0.1)),
        ("feed_forward", (0.0, 0.0, 0.1, math.nan)),
    ],
)
def test_a_bad_signal_is_refused_and_leaves_the_memory_as_it_was(name, signals):
    pid, untouched = PID(1.0, 2.0, 3.0), PID(1.0, 2.0, 3.0)
    for controller in (pid, untouched):
        controller.update(1.0, 0.5, dt=0.1)
    with pytest.raises(ValueError, match=name):
        pid.update(*signals)
    assert pid.update(1.0, 0.6, dt=0.1) == untouched.update(1.0, 0.6, dt=0.1)
