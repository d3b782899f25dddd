"""Muscles: force by length, velocity and activation, and how the activation follows the control.

A muscle pulls: its force is negative. Lengths are those of the fibre, in units of its length at rest.
"""

import warp as wp

from carom.kernels.types import Vector8, func, real
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
def rise(x: real, first: real, last: real) -> real:
    """From 0 at `first` to 1 at `last`, by two parabolas that meet halfway, flat at both ends."""
    t = (x - first) / (last - first)
    if t <= 0.0:
        return real(0.0)
    if t >= 1.0:
        return real(1.0)
    return 2.0 * t * t if t <= 0.5 else 1.0 - 2.0 * (1.0 - t) * (1.0 - t)


@func
def force_of_length(length: real, shortest: real, longest: real) -> real:
    """Share of the greatest active force that a fibre has at a length: 1 at rest, 0 out of its range."""
    if length <= 1.0:
        return rise(length, shortest, real(1.0))
    return rise(-length, -longest, real(-1.0))


@func
def force_of_velocity(velocity: real, greatest: real) -> real:
    """Share of the force that a fibre has at a velocity: from 0 where it shortens at 1 to `greatest`."""
    if velocity <= -1.0:
        return real(0.0)
    if velocity <= 0.0:
        return (velocity + 1.0) * (velocity + 1.0)
    more = greatest - 1.0
    if velocity <= more:
        return greatest - (more - velocity) * (more - velocity) / more
    return greatest


@func
def passive_force(length: real, longest: real, greatest: real) -> real:
    """Force of a fibre without activation: 0 up to its length at rest, then a parabola, then a line."""
    half = 0.5 * (longest - 1.0)
    stretch = (length - 1.0) / half
    if stretch <= 0.0:
        return real(0.0)
    if stretch <= 1.0:
        return greatest * 0.5 * stretch * stretch
    return greatest * (stretch - 0.5)


@func
def muscle_force(muscle: Vector8, length: real, speed: real, activation: real) -> real:
    """Force of a muscle; `muscle` is a row of `Model.actuator_muscle`."""
    fibre = (length - muscle[MUSCLE_TENDON]) / muscle[MUSCLE_FIBRE]
    velocity = speed / (muscle[MUSCLE_FIBRE] * muscle[MUSCLE_SPEED])
    active = force_of_length(fibre, muscle[MUSCLE_SHORTEST], muscle[MUSCLE_LONGEST])
    active *= force_of_velocity(velocity, muscle[MUSCLE_LENGTHENING])
    passive = passive_force(fibre, muscle[MUSCLE_LONGEST], muscle[MUSCLE_PASSIVE])
    return -muscle[MUSCLE_FORCE] * (active * activation + passive)


@func
def activation_rate(control: real, activation: real, rising: real, falling: real, width: real) -> real:
    """Rate of a muscle's activation, with time constants of rising and falling.

    Both depend on the activation. A `width` above 0 makes the transition between them smooth.
    """
    wanted = wp.clamp(control, real(0.0), real(1.0))
    present = wp.clamp(activation, real(0.0), real(1.0))
    scale = 0.5 + 1.5 * present
    up, down = rising * scale, falling / scale
    difference = wanted - activation
    share = real(1.0) if difference > 0.0 else real(0.0)
    if width > 0.0:
        x = wp.clamp(difference / width + 0.5, real(0.0), real(1.0))
        share = x * x * x * (x * (6.0 * x - 15.0) + 10.0)
    return difference / wp.max(down + (up - down) * share, _SHORTEST_TIME)
