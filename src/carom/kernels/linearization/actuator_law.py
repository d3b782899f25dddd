"""The law of an actuator, linearised: of a joint, and of a tendon."""

import warp as wp

from carom.kernels.linearization.rows import set_input
from carom.kernels.structs import Model, Scratch, Settings, State, StepBatch, StepSpace
from carom.kernels.types import Int32, Vector2, Vector3, func, real
from carom.layouts.codes import FILTER_EXACT, INTEGRATOR, UNFILTERED
from carom.layouts.linearization import INPUT_BIAS, INPUT_CONTROL, INPUT_GAIN


@func
def activation_changes(model: Model, state: State, world: Int32, actuator: Int32, h: real):
    """How the activation after a step changes with that before it, and with a control within its range."""
    after = state.actuator_activation[world, actuator]
    if after <= model.actuator_activation_lower[world, actuator] or (
        after >= model.actuator_activation_upper[world, actuator]
    ):
        return real(0.0), real(0.0)
    dynamics = model.actuator[actuator].dynamics
    if dynamics == INTEGRATOR:
        return real(1.0), h
    share = h / model.actuator_time_constant[world, actuator]
    if dynamics == FILTER_EXACT:
        share = 1.0 - wp.exp(-share)
    return 1.0 - share, share


@func
def add_actuator_law(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    actuator: Int32,
    row: Int32,
    length: real,
    speed: real,
    after: real,
    gear: real,
) -> Vector2:
    """Let the impulse of a row be that of an actuator within its bounds, which yields as it does.

    `length` is that before the step, `speed` its rate after the free motion, and `after` that at the end; the
    rate of the row times `gear` is its rate. The row has no softness yet.

    Returns:
        Derivatives of the right side per unit of the row's Jacobian: by positions, and by the velocities
        after the free motion.
    """
    h = settings.time_step
    control = state.actuator_control[world, actuator]
    lower = model.actuator_control_lower[world, actuator]
    upper = model.actuator_control_upper[world, actuator]
    filtered = model.actuator[actuator].dynamics != UNFILTERED
    drive = wp.min(wp.max(control, lower), upper)
    by_activation, by_control = real(0.0), real(1.0)
    if filtered:
        drive = scratch.actuator_start[world, actuator]
        by_activation, by_control = real(1.0), real(0.0)
        if model.actuator[actuator].is_early != 0:
            drive = state.actuator_activation[world, actuator]
            by_activation, by_control = activation_changes(model, state, world, actuator, h)
    gain = model.actuator_gain[world, actuator]
    terms = gain * drive + model.actuator_bias[world, actuator]
    # Of length and velocity, those at the end count where the force falls with them.
    yielding = real(0.0)
    share = h * gear
    through = share * gear * terms[2]
    if terms[1] < 0.0:
        length += h * after
        yielding -= gear * gear * h * h * terms[1]
    elif terms[1] == 0.0:
        # Derivatives by a term that is 0 are the mean of those of both signs, as of central differences.
        length += 0.5 * h * after
    if terms[2] < 0.0:
        speed = after
        yielding -= gear * gear * h * terms[2]
        through = real(0.0)
    elif terms[2] == 0.0:
        speed = 0.5 * (speed + after)
    ends = Vector3(real(1.0), length, speed)
    steps.alpha[row * space.most_rows + row - place * space.most_rows] = yielding
    by_drive = share * wp.dot(gain, ends)
    given = space.actuator_input[actuator]
    if filtered:
        column = 2 * space.dofs + space.actuator_column[actuator]
        steps.side[row * space.columns + column] = by_activation * by_drive
    if lower <= control and control <= upper:
        set_input(space, steps, row, given, INPUT_CONTROL, by_control * by_drive)
    for term in range(3):
        set_input(space, steps, row, given, INPUT_GAIN + term, share * drive * ends[term])
        set_input(space, steps, row, given, INPUT_BIAS + term, share * ends[term])
    return Vector2(share * gear * terms[1], through)
