"""The law of an actuator, linearised: of a joint, of a path, and of a site."""

import warp as wp

from carom.kernels.linearization.muscle_law import activation_rate_slopes, muscle_terms
from carom.kernels.linearization.rows import bring_switch, set_input, share_of_range
from carom.kernels.structs import Model, Scratch, Settings, State, StepBatch, StepSpace
from carom.kernels.types import Int32, Vector2, Vector3, Vector4, func, real
from carom.layouts.codes import FILTER_EXACT, INTEGRATOR, MUSCLE, UNFILTERED
from carom.layouts.linearization import INPUT_BIAS, INPUT_CONTROL, INPUT_GAIN


@func
def activation_changes(model: Model, state: State, scratch: Scratch, world: Int32, actuator: Int32, h: real):
    """How the activation after a step changes with that before it, and with a control within its range."""
    after = state.actuator_activation[world, actuator]
    if after <= model.actuator_activation_lower[world, actuator] or (
        after >= model.actuator_activation_upper[world, actuator]
    ):
        return real(0.0), real(0.0)
    dynamics = model.actuator[actuator].dynamics
    constant = model.actuator_time_constant[world, actuator]
    if dynamics == INTEGRATOR:
        return real(1.0), h
    if dynamics == MUSCLE:
        lower, upper = (
            model.actuator_control_lower[world, actuator],
            model.actuator_control_upper[world, actuator],
        )
        control = wp.min(wp.max(state.actuator_control[world, actuator], lower), upper)
        times = model.actuator_muscle_time[world, actuator]
        by_activation, by_control = activation_rate_slopes(
            control, scratch.actuator_start[world, actuator], constant, times[0], times[1]
        )
        return 1.0 + h * by_activation, h * by_control
    share = h / constant
    if dynamics == FILTER_EXACT:
        share = 1.0 - wp.exp(-share)
    return 1.0 - share, share


@func
def follows_control(model: Model, state: State, world: Int32, actuator: Int32) -> bool:
    """Whether a control is within its range, so that changes of it have an effect."""
    control = state.actuator_control[world, actuator]
    lower, upper = (
        model.actuator_control_lower[world, actuator],
        model.actuator_control_upper[world, actuator],
    )
    return lower <= control and control <= upper


@func
def drive_of(model: Model, state: State, scratch: Scratch, world: Int32, actuator: Int32, h: real) -> Vector3:
    """What an actuator acts by, and its derivatives by activation and by a control within its range."""
    if model.actuator[actuator].dynamics == UNFILTERED:
        lower, upper = (
            model.actuator_control_lower[world, actuator],
            model.actuator_control_upper[world, actuator],
        )
        control = wp.min(wp.max(state.actuator_control[world, actuator], lower), upper)
        return Vector3(control, real(0.0), real(1.0))
    if model.actuator[actuator].is_early != 0:
        by_activation, by_control = activation_changes(model, state, scratch, world, actuator, h)
        return Vector3(state.actuator_activation[world, actuator], by_activation, by_control)
    return Vector3(scratch.actuator_start[world, actuator], real(1.0), real(0.0))


@func
def set_drive(
    model: Model,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    world: Int32,
    actuator: Int32,
    row: Int32,
    drive: Vector3,
    by_drive: real,
):
    """Add to a row's derivatives by activation and control those by what an actuator acts by, `drive_of`."""
    column = space.actuator_column[actuator]
    if column >= 0:
        steps.side[row * space.columns + 2 * space.dofs + column] += drive[1] * by_drive
    if follows_control(model, state, world, actuator):
        set_input(space, steps, row, space.actuator_input[actuator], INPUT_CONTROL, drive[2] * by_drive)
        # At an end of its range a control acts to one side only.
        lower, upper = (
            model.actuator_control_lower[world, actuator],
            model.actuator_control_upper[world, actuator],
        )
        bring_switch(steps, row, share_of_range(state.actuator_control[world, actuator], lower, upper))


@func
def present_terms(
    model: Model, world: Int32, actuator: Int32, drive: real, length: real, speed: real
) -> Vector4:
    """Force of an actuator without its bounds, and its derivatives by length, speed and what it acts by."""
    if model.actuator[actuator].is_muscle != 0:
        return muscle_terms(model.actuator_muscle[world, actuator], length, speed, drive)
    gain = model.actuator_gain[world, actuator]
    terms = gain * drive + model.actuator_bias[world, actuator]
    ends = Vector3(real(1.0), length, speed)
    return Vector4(wp.dot(terms, ends), terms[1], terms[2], wp.dot(gain, ends))


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
    """Add to the impulse of a row that of an actuator within its bounds, which yields as it does.

    `length` is that before the step, `speed` its rate after the free motion, and `after` that at the end; the
    rate of the row times `gear` is its rate. Where forces are explicit, `speed` is that before the step.

    Returns:
        Derivatives of the right side per unit of the row's Jacobian: by positions, and by the velocities that
        `speed` is of.
    """
    h = settings.time_step
    share = h * gear
    drive = drive_of(model, state, scratch, world, actuator, h)
    if model.actuator[actuator].is_muscle != 0:
        pull = muscle_terms(model.actuator_muscle[world, actuator], length, speed, drive[0])
        set_drive(model, state, space, steps, world, actuator, row, drive, share * pull[3])
        return Vector2(share * gear * pull[1], share * gear * pull[2])
    gain = model.actuator_gain[world, actuator]
    terms = gain * drive[0] + model.actuator_bias[world, actuator]
    # Of length and velocity, those at the end count where the force falls with them.
    yielding = real(0.0)
    through = share * gear * terms[2]
    explicit = settings.explicit_forces != 0
    if explicit:
        yielding = real(0.0)
    elif terms[1] < 0.0:
        length += h * after
        yielding -= gear * gear * h * h * terms[1]
    elif terms[1] == 0.0:
        # Derivatives by a term that is 0 are the mean of those of both signs, as of central differences.
        length += 0.5 * h * after
    if explicit:
        yielding = real(0.0)
    elif terms[2] < 0.0:
        speed = after
        yielding -= gear * gear * h * terms[2]
        through = real(0.0)
    elif terms[2] == 0.0:
        speed = 0.5 * (speed + after)
    ends = Vector3(real(1.0), length, speed)
    steps.alpha[row * space.most_rows + row - place * space.most_rows] += yielding
    set_drive(model, state, space, steps, world, actuator, row, drive, share * wp.dot(gain, ends))
    given = space.actuator_input[actuator]
    for term in range(3):
        set_input(space, steps, row, given, INPUT_GAIN + term, share * drive[0] * ends[term])
        set_input(space, steps, row, given, INPUT_BIAS + term, share * ends[term])
    return Vector2(share * gear * terms[1], through)


@func
def write_activations(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
):
    """Write the derivatives of the activations after the step."""
    for actuator in range(space.actuators):
        column = space.actuator_column[actuator]
        if column >= 0:
            by_activation, by_control = activation_changes(
                model, state, scratch, world, actuator, settings.time_step
            )
            own = 2 * space.dofs + column
            first = (place * space.states + own) * space.columns
            steps.step[first + own] = by_activation
            given = space.actuator_input[actuator] + 0
            while given >= 0 and follows_control(model, state, world, actuator):
                if space.input_number[given] == INPUT_CONTROL:
                    steps.step[first + space.states + given] = by_control * space.input_scale[given]
                given = space.input_next[given]
