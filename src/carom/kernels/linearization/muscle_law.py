"""The force of a muscle and the rate of its activation, with their derivatives; see `dynamics.muscles`."""

import warp as wp

from carom.kernels.dynamics.muscles import force_of_length, force_of_velocity, muscle_force
from carom.kernels.types import Vector4, Vector8, func, real
from carom.layouts.codes import (
    MUSCLE_FIBRE,
    MUSCLE_FORCE,
    MUSCLE_LENGTHENING,
    MUSCLE_LONGEST,
    MUSCLE_PASSIVE,
    MUSCLE_SHORTEST,
    MUSCLE_SPEED,
    MUSCLE_TENDON,
)

_SHORTEST_TIME = real(1e-15)


@func
def rise_slope(x: real, first: real, last: real) -> real:
    """Derivative of `muscles.rise` by x."""
    t = (x - first) / (last - first)
    slope = wp.where(t <= 0.5, 4.0 * t, 4.0 * (1.0 - t)) / (last - first)
    return wp.where(t <= 0.0 or t >= 1.0, real(0.0), slope)


@func
def force_of_length_slope(length: real, shortest: real, longest: real) -> real:
    """Derivative of `muscles.force_of_length` by the length."""
    rising = rise_slope(length, shortest, real(1.0))
    return wp.where(length <= 1.0, rising, -rise_slope(-length, -longest, real(-1.0)))


@func
def force_of_velocity_slope(velocity: real, greatest: real) -> real:
    """Derivative of `muscles.force_of_velocity` by the velocity."""
    more = greatest - 1.0
    slope = real(0.0)
    if velocity > -1.0 and velocity <= 0.0:
        slope = 2.0 * (velocity + 1.0)
    elif velocity > 0.0 and velocity <= more:
        slope = 2.0 * (more - velocity) / more
    return slope


@func
def passive_force_slope(length: real, longest: real, greatest: real) -> real:
    """Derivative of `muscles.passive_force` by the length."""
    half = 0.5 * (longest - 1.0)
    stretch = (length - 1.0) / half
    return greatest * wp.clamp(stretch, real(0.0), real(1.0)) / half


@func
def muscle_terms(muscle: Vector8, length: real, speed: real, activation: real) -> Vector4:
    """Force of a muscle, and its derivatives by length, speed and activation."""
    fibre = (length - muscle[MUSCLE_TENDON]) / muscle[MUSCLE_FIBRE]
    fastest = muscle[MUSCLE_FIBRE] * muscle[MUSCLE_SPEED]
    velocity = speed / fastest
    shortest, longest = muscle[MUSCLE_SHORTEST], muscle[MUSCLE_LONGEST]
    of_length = force_of_length(fibre, shortest, longest)
    of_velocity = force_of_velocity(velocity, muscle[MUSCLE_LENGTHENING])
    stiffens = force_of_length_slope(fibre, shortest, longest) * of_velocity * activation
    stiffens += passive_force_slope(fibre, longest, muscle[MUSCLE_PASSIVE])
    damps = of_length * force_of_velocity_slope(velocity, muscle[MUSCLE_LENGTHENING]) * activation
    active = of_length * of_velocity
    # As it is computed in a step.
    force = muscle_force(muscle, length, speed, activation)
    pull = -muscle[MUSCLE_FORCE]
    return Vector4(force, pull * stiffens / muscle[MUSCLE_FIBRE], pull * damps / fastest, pull * active)


@func
def activation_rate_slopes(control: real, activation: real, rising: real, falling: real, width: real):
    """Derivatives of `muscles.activation_rate` by the activation and by the control."""
    wanted = wp.clamp(control, real(0.0), real(1.0))
    present = wp.clamp(activation, real(0.0), real(1.0))
    follows = wp.where(control >= 0.0 and control <= 1.0, real(1.0), real(0.0))
    moves = wp.where(activation >= 0.0 and activation <= 1.0, real(1.5), real(0.0))
    scale = 0.5 + 1.5 * present
    up, down = rising * scale, falling / scale
    difference = wanted - activation
    share = wp.where(difference > 0.0, real(1.0), real(0.0))
    steepness = real(0.0)
    if width > 0.0:
        x = wp.clamp(difference / width + 0.5, real(0.0), real(1.0))
        share = x * x * x * (x * (6.0 * x - 15.0) + 10.0)
        steepness = 30.0 * x * x * (1.0 - x) * (1.0 - x) / width
    time = down + (up - down) * share
    slower = moves * (rising * share - (1.0 - share) * falling / (scale * scale))
    by_difference = (up - down) * steepness
    if time <= _SHORTEST_TIME:
        time = _SHORTEST_TIME
        slower = real(0.0)
        by_difference = real(0.0)
    rate = difference / time
    by_control = (1.0 - rate * by_difference) / time
    return -by_control - rate * slower / time, by_control * follows
