"""Actuators of which a file bounds the sum of the forces, linearised: of a tendon, and of a joint."""

import warp as wp

from carom.kernels.linearization.actuator_law import (
    add_actuator_law,
    drive_of,
    present_terms,
    set_drive,
)
from carom.kernels.linearization.rows import set_input
from carom.kernels.structs import Model, Scratch, Settings, State, StepBatch, StepSpace
from carom.kernels.types import Int32, Vector2, Vector3, func, real
from carom.layouts.linearization import INPUT_BIAS, INPUT_GAIN

_UNBOUNDED = real(1e30)


@func
def next_of(model: Model, actuator: Int32) -> Int32:
    """The actuator of the same tendon or joint that follows another one, or -1."""
    step = model.actuator[actuator].to_next + 0
    return wp.where(step > 0, actuator + step, Int32(-1))


@func
def add_explicit_terms(
    model: Model,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    world: Int32,
    actuator: Int32,
    row: Int32,
    length: real,
    speed: real,
    h: real,
    share: real,
):
    """Add a share of the impulse of an actuator at its present length and speed to a row.

    Returns:
        The derivatives of the right side by length and speed.
    """
    drive = drive_of(model, state, scratch, world, actuator, h)
    terms = present_terms(model, world, actuator, drive[0], length, speed)
    set_drive(model, state, space, steps, world, actuator, row, drive, share * h * terms[3])
    if model.actuator[actuator].is_muscle == 0:
        ends = Vector3(real(1.0), length, speed)
        given = space.actuator_input[actuator]
        for term in range(3):
            set_input(space, steps, row, given, INPUT_GAIN + term, share * h * drive[0] * ends[term])
            set_input(space, steps, row, given, INPUT_BIAS + term, share * h * ends[term])
    return Vector2(share * h * terms[1], share * h * terms[2])


@func
def add_bounded_share(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    world: Int32,
    actuator: Int32,
    row: Int32,
    length: real,
    speed: real,
):
    """Let the impulse of a row be the share of an actuator of a tendon in the bound of all, if that acts.

    `length` and `speed` are those of the actuator, before the step and as `rows.rate_of_law`; see
    `tendons.rows.share_of_tendon`.

    Returns:
        1 if the bound acts, else 0, and as `add_actuator_law`.
    """
    h = settings.time_step
    least, greatest = model.actuator_joint_lower[world, actuator], model.actuator_joint_upper[world, actuator]
    law = Vector2(0.0, 0.0)
    if least <= -_UNBOUNDED and greatest >= _UNBOUNDED:
        return Int32(0), law
    gear = model.actuator_gear[world, actuator]
    total, force = real(0.0), real(0.0)
    other = actuator - model.actuator[actuator].follows
    while other >= 0:
        ratio = model.actuator_gear[world, other] / gear
        drive = drive_of(model, state, scratch, world, other, h)
        terms = present_terms(model, world, other, drive[0], ratio * length, ratio * speed)
        total += terms[0]
        if other == actuator:
            force = terms[0]
        other = next_of(model, other)
    bound = wp.clamp(total, least, greatest)
    if bound == total or total == 0.0:
        return Int32(0), law
    share = bound / total
    law += add_explicit_terms(
        model, state, scratch, space, steps, world, actuator, row, length, speed, h, share
    )
    # All others, and it itself, change the sum by which it is divided.
    other = actuator - model.actuator[actuator].follows
    while other >= 0:
        ratio = model.actuator_gear[world, other] / gear
        law += ratio * add_explicit_terms(
            model, state, scratch, space, steps, world, other, row, ratio * length, ratio * speed, h,
            -share * force / total,
        )  # fmt: skip
        other = next_of(model, other)
    return Int32(1), law


@func
def add_joint_sum(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    first: Int32,
    row: Int32,
    position: real,
    rate: real,
    after: real,
):
    """Let the impulse of a row be that of all actuators of a joint, within the bounds of their sum.

    `first` is the first of them; see `dynamics.actuators.joint_law`.

    Returns:
        The impulse without those bounds, and as `add_actuator_law`.
    """
    h = settings.time_step
    total = real(0.0)
    law = Vector2(0.0, 0.0)
    actuator = first + 0
    while actuator >= 0:
        gear = model.actuator_gear[world, actuator]
        drive = drive_of(model, state, scratch, world, actuator, h)
        terms = present_terms(model, world, actuator, drive[0], gear * position, gear * rate)
        lower = model.actuator_force_lower[world, actuator]
        upper = model.actuator_force_upper[world, actuator]
        bounded = wp.min(wp.max(terms[0], lower), upper)
        total += h * gear * bounded
        if bounded == terms[0]:
            if model.actuator[actuator].is_muscle == 0 and settings.explicit_forces == 0:
                stiffness, damping = wp.max(-terms[1], real(0.0)), wp.max(-terms[2], real(0.0))
                total -= h * gear * gear * (h * stiffness * after + damping * (after - rate))
            law += add_actuator_law(
                model, settings, state, scratch, space, steps, place, world, actuator, row,
                gear * position, gear * rate, gear * after, gear,
            )  # fmt: skip
        actuator = next_of(model, actuator)
    return total, law
