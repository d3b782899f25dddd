"""Rows of joints, linearised: motors, limits, friction and actuators."""

import warp as wp

from carom.kernels.linearization.actuator_law import add_actuator_law
from carom.kernels.linearization.ball_rows import add_ball_limit, add_ball_motor
from carom.kernels.linearization.bounded_sums import add_joint_sum
from carom.kernels.linearization.matrices import clear
from carom.kernels.linearization.rows import (
    NEAR,
    add_row_of_dof,
    bring_switch,
    joint_position,
    note_problem,
    rate_of_law,
    set_input,
    share_left,
    share_of_range,
    status_of,
)
from carom.kernels.linearization.soft_rows import (
    ERROR_ITSELF,
    let_row_yield,
    set_error,
    write_mass_changes,
    yielding_law,
)
from carom.kernels.structs import Model, Scratch, Settings, State, StepBatch, StepSpace
from carom.kernels.types import Int32, called_func, func, real
from carom.layouts.codes import (
    ACTUATOR,
    FRICTION,
    LIMIT,
    MOTOR,
    MOTOR_KD,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_SERVO,
    MOTOR_VELOCITY,
    MOTOR_VELOCITY_CLAMP,
    SPHERICAL_LIMIT,
    SPHERICAL_MOTOR,
)
from carom.layouts.linearization import (
    ACTUATOR_ROW,
    BASE_DOF,
    BASE_SPRING,
    BOTH_LIMITS,
    FRICTION_ROW,
    INPUT_BOUND,
    LIMIT_ROW,
    MOTOR_ROW,
    ROW_HOLDS,
    ROW_LOWER,
    ROW_SATURATED,
    ROW_UPPER,
)


@func
def add_motor(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    dof: Int32,
):
    """Add the row of the motor of a revolute or prismatic joint."""
    motor = state.dof_motor[world, space.dof_row[dof]]
    bound = motor[MOTOR_MAX_IMPULSE]
    if bound != 0.0:
        impulse = state.dof_motor_impulse[world, space.dof_row[dof]]
        steps.impulse[place * space.dofs + dof] -= impulse
        status = status_of(impulse, -bound, bound)
        h = settings.time_step
        rate = steps.velocity[(3 * place + 1) * space.dofs + dof]
        error = motor[MOTOR_POSITION] - joint_position(scratch, space, world, dof)
        wanted = motor[MOTOR_KP] * error / h + rate + motor[MOTOR_KD] * (motor[MOTOR_VELOCITY] - rate)
        free = status == ROW_HOLDS
        is_servo = motor[MOTOR_SERVO] != 0.0
        if free and not is_servo and wp.abs(wanted) > motor[MOTOR_VELOCITY_CLAMP]:
            status = Int32(ROW_SATURATED)
        alpha = wp.where(free and not is_servo, real(1.0), real(0.0))
        row = add_row_of_dof(space, steps, place, MOTOR_ROW, status, dof, alpha, 1.0 - alpha)
        if free:
            steps.row_switch[row] = share_left(impulse, -bound, bound)
        given = space.dof_input[dof]
        if not free:
            sign = wp.where(status == ROW_LOWER, real(-1.0), real(1.0))
            set_input(space, steps, row, given, MOTOR_MAX_IMPULSE, sign)
        elif is_servo:
            # Impulse = h (stiffness error + damping (target - rate)), of error and rate at the end.
            after = steps.velocity[(3 * place + 2) * space.dofs + dof]
            yielding = h * (motor[MOTOR_KD] + h * motor[MOTOR_KP])
            steps.alpha[row * space.most_rows + row - place * space.most_rows] = yielding
            steps.side[row * space.columns + dof] = -h * motor[MOTOR_KP]
            set_input(space, steps, row, given, MOTOR_POSITION, h * motor[MOTOR_KP])
            set_input(space, steps, row, given, MOTOR_VELOCITY, h * motor[MOTOR_KD])
            set_input(space, steps, row, given, MOTOR_KP, h * (error - h * after))
            set_input(space, steps, row, given, MOTOR_KD, h * (motor[MOTOR_VELOCITY] - after))
        elif status == ROW_HOLDS:
            steps.side[row * space.columns + dof] = -motor[MOTOR_KP] / h
            steps.through[row * space.dofs + dof] = 1.0 - motor[MOTOR_KD]
            set_input(space, steps, row, given, MOTOR_POSITION, motor[MOTOR_KP] / h)
            set_input(space, steps, row, given, MOTOR_VELOCITY, motor[MOTOR_KD])
            set_input(space, steps, row, given, MOTOR_KP, error / h)
            set_input(space, steps, row, given, MOTOR_KD, motor[MOTOR_VELOCITY] - rate)
        if not is_servo:
            let_row_yield(model, state, space, steps, place, world, row, impulse)


@func
def let_joint_yield(
    model: Model,
    settings: Settings,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    constraint: Int32,
    row: Int32,
    error: real,
):
    """Let the row of a limit or of friction on one dof yield, as `dynamics.yielding.yielding_row` does."""
    n = space.dofs
    clear(steps.rate, row * n, n)
    impedance = model.constraint_impedance[world, constraint]
    law = yielding_law(settings, model.constraint_reference[world, constraint], impedance, error)
    stated = impedance[3] + 0.0
    of_row = stated <= 0.0
    if of_row:
        stated = write_mass_changes(model, state, space, steps, place, world, row)
    set_error(space, steps, place, row, law, error, ERROR_ITSELF, stated, real(1.0), of_row)


@func
def add_limit_of_side(
    model: Model,
    settings: Settings,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    constraint: Int32,
    dof: Int32,
    least: real,
    violation: real,
    side: real,
):
    """Add the row of a limit that yields, if it pushes with more than `least`; `side` is the sign of that.

    Friction and the other limit may act on the dof as well, so the impulse is what its law says.
    """
    n = space.dofs
    impedance = model.constraint_impedance[world, constraint]
    error = -side * violation
    law = yielding_law(settings, model.constraint_reference[world, constraint], impedance, error)
    inverse_mass = impedance[3] + 0.0
    if inverse_mass <= 0.0:
        inverse_mass = steps.inverse[(place * n + dof) * n + dof]
    before = steps.velocity[3 * place * n + dof]
    after = steps.velocity[(3 * place + 2) * n + dof]
    impulse = (law[0] * before - law[1] * error - after) / (law[2] * inverse_mass)
    if violation >= 0.0 and side * impulse > least:
        steps.impulse[place * n + dof] -= impulse
        row = add_row_of_dof(space, steps, place, LIMIT_ROW, ROW_HOLDS, dof, real(1.0), real(0.0))
        steps.row_impulse[row] = impulse
        steps.side[row * space.columns + dof] = 1.0
        let_joint_yield(model, settings, state, space, steps, place, world, constraint, row, error)


@func
def add_limit(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    constraint: Int32,
    dof: Int32,
    least: real,
):
    """Add the rows of the limits of a joint that push with more than `least`."""
    position = joint_position(scratch, space, world, dof)
    impulse = steps.impulse[place * space.dofs + dof]
    side = wp.where(impulse > 0.0, real(1.0), real(-1.0))
    margin = model.constraint_margin[world, constraint]
    violation = model.constraint_lower[world, constraint] + margin - position
    other = position - model.constraint_upper[world, constraint] + margin
    if model.constraint_impedance[world, constraint][1] > 0.0:
        for end in range(2):
            excess = wp.where(end == 0, violation, other)
            sign = wp.where(end == 0, real(1.0), real(-1.0))
            add_limit_of_side(
                model, settings, state, space, steps, place, world, constraint, dof, least, excess, sign
            )
    else:
        if violation >= 0.0 and other >= 0.0 and margin > 0.0:
            # Only the sum of both impulses is known.
            note_problem(steps, place, BOTH_LIMITS, dof)
        if side < 0.0:
            violation = other
        if violation >= 0.0 and side * impulse > least:
            steps.impulse[place * space.dofs + dof] = 0.0
            bound = model.constraint_max_impulse[world, constraint] * (1.0 - NEAR)
            if side * impulse >= bound:
                status = wp.where(side > 0.0, Int32(ROW_UPPER), Int32(ROW_LOWER))
                add_row_of_dof(space, steps, place, LIMIT_ROW, status, dof, real(0.0), real(1.0))
            else:
                row = add_row_of_dof(space, steps, place, LIMIT_ROW, ROW_HOLDS, dof, real(1.0), real(0.0))
                if settings.split_impulse == 0 or -violation > settings.split_threshold:
                    steps.side[row * space.columns + dof] = -settings.joint_erp / settings.time_step
                let_row_yield(model, state, space, steps, place, world, row, impulse)


@func
def is_known_friction(model: Model, space: StepSpace, world: Int32, constraint: Int32) -> bool:
    """Whether the impulse of friction follows from its velocity: where rigid rows yield a little."""
    return space.regular > 0.0 and model.constraint_impedance[world, constraint][1] <= 0.0


@func
def add_friction(
    model: Model,
    settings: Settings,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    constraint: Int32,
    dof: Int32,
):
    """Add the row of the friction of a dof."""
    bound = model.constraint_upper[world, constraint] * settings.time_step
    if bound != 0.0:
        n = space.dofs
        impulse = steps.impulse[place * n + dof] + 0.0
        if is_known_friction(model, space, world, constraint):
            softness = space.regular * steps.inverse[(place * n + dof) * n + dof]
            if softness > 0.0:
                impulse = -steps.velocity[(3 * place + 2) * n + dof] / softness
            impulse = wp.clamp(impulse, -bound, bound)
        steps.impulse[place * n + dof] -= impulse
        # The rest of a sum is less precise than an impulse of its own.
        status = status_of(impulse, -bound * (1.0 - NEAR), bound * (1.0 - NEAR))
        alpha = wp.where(status == ROW_HOLDS, real(1.0), real(0.0))
        row = add_row_of_dof(space, steps, place, FRICTION_ROW, status, dof, alpha, 1.0 - alpha)
        if status == ROW_HOLDS:
            steps.row_switch[row] = share_left(impulse, -bound, bound)
            if model.constraint_impedance[world, constraint][1] > 0.0:
                steps.row_impulse[row] = impulse
                let_joint_yield(
                    model, settings, state, space, steps, place, world, constraint, row, real(0.0)
                )
            else:
                let_row_yield(model, state, space, steps, place, world, row, impulse)
        else:
            sign = wp.where(status == ROW_LOWER, real(-1.0), real(1.0))
            set_input(
                space, steps, row, space.constraint_input[constraint], INPUT_BOUND, sign * settings.time_step
            )


@func
def add_actuator(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    actuator: Int32,
    dof: Int32,
):
    """Add the row of an actuator of a joint, or of all of one whose sum has bounds."""
    h = settings.time_step
    if model.actuator[actuator].follows == 0:
        gear = model.actuator_gear[world, actuator]
        position = joint_position(scratch, space, world, dof)
        rate = rate_of_law(settings, space, steps, place, dof)
        end = steps.velocity[(3 * place + 2) * space.dofs + dof]
        least = model.actuator_joint_lower[world, actuator]
        greatest = model.actuator_joint_upper[world, actuator]
        row = add_row_of_dof(space, steps, place, ACTUATOR_ROW, ROW_HOLDS, dof, real(0.0), real(1.0))
        if model.actuator[actuator].to_next > 0:
            impulse, law = add_joint_sum(
                model,
                settings,
                state,
                scratch,
                space,
                steps,
                place,
                world,
                actuator,
                row,
                position,
                rate,
                end,
            )
            status = status_of(impulse, h * least, h * greatest)
            impulse = wp.clamp(impulse, h * least, h * greatest)
        else:
            first, second = least / gear, greatest / gear
            lowest = wp.max(model.actuator_force_lower[world, actuator], wp.min(first, second))
            highest = wp.min(model.actuator_force_upper[world, actuator], wp.max(first, second))
            force = wp.min(wp.max(state.actuator_force[world, actuator], lowest), highest)
            impulse = h * gear * force
            status = status_of(force, lowest, highest)
            law = add_actuator_law(
                model, settings, state, scratch, space, steps, place, world, actuator, row, gear * position,
                gear * rate, gear * end, gear,
            )  # fmt: skip
            bring_switch(steps, row, share_of_range(force, lowest, highest))
        steps.impulse[place * space.dofs + dof] -= impulse
        steps.row_status[row] = status
        if status != ROW_HOLDS:
            # It has the impulse of its bound, whatever changes.
            number = row - place * space.most_rows
            steps.alpha[row * space.most_rows + number] = 0.0
            steps.row_switch[row] = -1.0
            clear(steps.side, row * space.columns, space.columns)
        else:
            steps.side[row * space.columns + dof] = law[0]
            if settings.explicit_forces != 0:
                steps.side[row * space.columns + space.dofs + dof] = law[1]
            else:
                steps.through[row * space.dofs + dof] = law[1]


@called_func
def add_joint_rows(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
):
    """Add the rows of all joints.

    Impulses of motors and actuators are known, and those of friction where it follows from velocities; those
    of limits and other friction are what is left of the impulses on their dofs.
    """
    greatest = real(1.0e-300)
    for dof in range(space.dofs):
        greatest = wp.max(greatest, wp.abs(steps.impulse[place * space.dofs + dof]))
        if space.dof_first[dof] == BASE_DOF and model.dof_stiffness[world, space.dof_row[dof]] != 0.0:
            note_problem(steps, place, BASE_SPRING, dof)
    least = NEAR * greatest
    for part in range(3):
        for constraint in range(space.constraints):
            kind = model.constraint[constraint].kind
            own = part == 0 and (kind == MOTOR or kind == SPHERICAL_MOTOR or kind == ACTUATOR)
            own = own or (part == 1 and (kind == LIMIT or kind == SPHERICAL_LIMIT))
            known = kind == FRICTION and is_known_friction(model, space, world, constraint)
            own = own or (kind == FRICTION and part == wp.where(known, Int32(0), Int32(2)))
            if own:
                link = model.constraint[constraint].link
                dof = space.row_dof[model.link[link].first_dof]
                if kind == MOTOR:
                    add_motor(model, settings, state, scratch, space, steps, place, world, dof)
                elif kind == SPHERICAL_MOTOR:
                    add_ball_motor(model, settings, state, scratch, space, steps, place, world, link, dof)
                elif kind == ACTUATOR:
                    actuator = model.constraint[constraint].actuator
                    add_actuator(model, settings, state, scratch, space, steps, place, world, actuator, dof)
                elif kind == LIMIT:
                    add_limit(
                        model, settings, state, scratch, space, steps, place, world, constraint, dof, least
                    )
                elif kind == FRICTION:
                    for axis in range(model.link[link].dof_count):
                        add_friction(
                            model, settings, state, space, steps, place, world, constraint, dof + axis
                        )
                else:
                    add_ball_limit(
                        model, settings, state, scratch, space, steps, place, world, constraint, dof, least
                    )
