import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from carom.control import QuinticTrajectory, TrapezoidalTrajectory

position = st.floats(-10.0, 10.0)
positions = st.lists(position, min_size=3, max_size=3)
bound = st.floats(0.1, 10.0)
bounds = st.lists(bound, min_size=3, max_size=3)


@given(positions, positions, st.floats(0.1, 10.0))
def test_quintic_starts_and_ends_at_rest_where_it_should(start, goal, duration):
    path = QuinticTrajectory(start, goal, duration)
    for time, place in ((0.0, start), (-1.0, start), (duration, goal), (duration + 1.0, goal)):
        sample = path.sample(time)
        assert_allclose(sample.position, place, atol=1e-12)
        assert_allclose(sample.velocity, 0.0, atol=1e-12)
        assert_allclose(sample.acceleration, 0.0, atol=1e-9)


@given(position, position, st.floats(0.5, 5.0))
def test_quintic_derivatives_match_finite_differences(start, goal, duration):
    path = QuinticTrajectory(start, goal, duration)
    times = np.linspace(0.05, 0.95, 19) * duration
    h = 1e-5 * duration
    before, now, after = (path.sample(times + shift) for shift in (-h, 0.0, h))
    assert_allclose((after.position - before.position) / (2 * h), now.velocity, atol=1e-6)
    assert_allclose((after.velocity - before.velocity) / (2 * h), now.acceleration, atol=1e-5)


@given(positions, positions, bounds, bounds)
def test_trapezoid_reaches_the_goal_within_its_bounds_and_touches_one_of_them(start, goal, speeds, pushes):
    path = TrapezoidalTrajectory(start, goal, speeds, pushes)
    assert_allclose(path.sample(0.0).position, start, atol=1e-12)
    assert_allclose(path.sample(path.duration).position, goal, atol=1e-12)
    _, velocity, acceleration = path.sample(np.linspace(0.0, path.duration, 101))
    assert np.all(np.abs(velocity) <= np.array(speeds) * (1 + 1e-9))
    assert np.all(np.abs(acceleration) <= np.array(pushes) * (1 + 1e-9))
    assume(path.duration > 1e-3)
    speeding_up = np.abs(path.sample(path.ramp / 2).acceleration)
    cruising = np.abs(path.sample(path.duration / 2).velocity)
    assert max(np.max(speeding_up / pushes), np.max(cruising / speeds)) == pytest.approx(1.0)


@given(position, position, bound, bound)
def test_trapezoid_velocity_is_the_slope_of_its_position(start, goal, speed, push):
    path = TrapezoidalTrajectory(start, goal, speed, push)
    assume(path.duration > 1e-2)
    times = np.linspace(0.013, 0.987, 53) * path.duration
    h = 1e-6 * path.duration
    slope = (path.sample(times + h).position - path.sample(times - h).position) / (2 * h)
    assert_allclose(slope, path.sample(times).velocity, atol=1e-4 * max(speed, push))


def test_trapezoid_has_textbook_durations():
    cruise = TrapezoidalTrajectory(0.0, 4.0, max_velocity=2.0, max_acceleration=2.0)
    assert (cruise.ramp, cruise.duration) == (1.0, 3.0)
    triangle = TrapezoidalTrajectory(0.0, 1.0, max_velocity=9.0, max_acceleration=4.0)
    assert (triangle.ramp, triangle.duration) == (0.5, 1.0)
    assert triangle.sample(0.5).velocity == pytest.approx(2.0)


@pytest.mark.parametrize("way", [0.0, 5e-324, 1e-310])
def test_trapezoid_without_a_way_to_go_takes_no_time(way):
    path = TrapezoidalTrajectory([0.0, 2.0], [way, 2.0], 1.0, 3.0)
    assert path.ramp == path.duration == 0.0
    assert_allclose(path.sample([0.0, 1.0]).position, [[way, 2.0], [way, 2.0]])
    assert_allclose(path.sample(0.0).velocity, 0.0)


@pytest.mark.parametrize(
    "make", [lambda s, g: QuinticTrajectory(s, g, 1.0), lambda s, g: TrapezoidalTrajectory(s, g, 1.0, 1.0)]
)
def test_samples_have_the_shape_of_times_then_joints(make):
    path = make([0.0, 1.0], [1.0, 0.0])
    assert path.sample(0.3).position.shape == (2,)
    assert path.sample(np.zeros((4, 5))).velocity.shape == (4, 5, 2)


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (([0.0, 1.0], [1.0], 1.0), "shape"),
        ((0.0, math.nan, 1.0), "finite"),
        ((0.0, 1.0, 0.0), "duration"),
        ((0.0, 1.0, math.inf), "duration"),
    ],
)
def test_quintic_refuses_bad_input(arguments, complaint):
    with pytest.raises(ValueError, match=complaint):
        QuinticTrajectory(*arguments)


def test_trapezoid_refuses_bounds_that_are_not_positive():
    with pytest.raises(ValueError, match="max_velocity"):
        TrapezoidalTrajectory(0.0, 1.0, -1.0, 1.0)
    with pytest.raises(ValueError, match="max_acceleration"):
        TrapezoidalTrajectory(0.0, 1.0, 1.0, [1.0, 0.0])


def test_sampling_at_nan_is_refused():
    with pytest.raises(ValueError, match="NaN"):
        QuinticTrajectory(0.0, 1.0, 1.0).sample(math.nan)
