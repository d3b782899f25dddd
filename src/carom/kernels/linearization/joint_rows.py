"""Rows of joints, linearised: motors, limits, friction, actuators, and joints that are tied together."""

import warp as wp

from carom.kernels.linearization.rows import (
    NEAR,
    add_row,
    add_row_of_dof,
    note_problem,
    set_input,
    status_of,
)
from carom.kernels.structs import Model, Scratch, Settings, State, StepBatch, StepSpace, UserConstraints
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.codes import (
    ABSENT,
    ACTUATOR,
    FRICTION,
    LIMIT,
    MOTOR,
    MOTOR_KD,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_VELOCITY,
    MOTOR_VELOCITY_CLAMP,
    SPHERICAL_LIMIT,
    UNFILTERED,
    USER_COUPLING,
    USER_GEAR,
)
from carom.layouts.linearization import (
    ACTUATOR_ROW,
    BALL_LIMIT,
    BASE_DOF,
    BASE_SPRING,
    BOUNDED_SUM,
    COUPLING_ROW,
    FRICTION_ROW,
    GEAR_ROW,
    INPUT_BIAS,
    INPUT_BOUND,
    INPUT_CONTROL,
    INPUT_GAIN,
    LIMIT_ROW,
    MOTOR_ROW,
    MUSCLE_ROW,
    ROW_HOLDS,
    ROW_LOWER,
    ROW_SATURATED,
    ROW_UPPER,
    YIELDING_FRICTION,
    YIELDING_LIMIT,
    YIELDING_USER,
)


@func
def joint_position(scratch: Scratch, space: StepSpace, world: Int32, dof: Int32) -> real:
    """Position before the step of the joint of a dof that has one."""
    return scratch.position_start[world, space.dof_position[dof]]


@func
def is_there(state: State, world: Int32, tree: Int32) -> Int32:
    """1 unless a tree is absent; -1 is the world."""
    there = Int32(1)
    if tree >= 0:
        if state.tree_activity[world, tree] == ABSENT:
            there = Int32(0)
    return there


@func
def add_tie(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    user: Int32,
):
    """Add the row of a gear or of a coupling."""
    n = space.dofs
    if users.user_impedance[user][1] > 0.0:
        note_problem(steps, place, YIELDING_USER, user)
    impulse = state.user_impulse[world, user][0]
    bound = users.user_max_impulse[user]
    status = status_of(impulse, -bound, bound)
    holds = wp.where(status == ROW_HOLDS, real(1.0), real(0.0))
    is_gear = users.user_kind[user] == USER_GEAR
    kind = wp.where(is_gear, Int32(GEAR_ROW), Int32(COUPLING_ROW))
    row = add_row(space, steps, place, kind, status, user, holds, 1.0 - holds)
    steps.row_impulse[row] = impulse
    first = row * n
    follower = space.row_dof[model.link[users.user_link_a[user]].first_dof]
    steps.jacobian[first + follower] += 1.0
    bent = real(0.0)
    leader = Int32(-1)
    if is_gear:
        other = space.row_dof[model.link[users.user_link_b[user]].first_dof]
        steps.jacobian[first + other] += users.user_gear_ratio[user]
    elif users.user_tree_b[user] >= 0:
        leader = space.row_dof[model.link[users.user_link_b[user]].first_dof]
        x = joint_position(scratch, space, world, leader)
        c = users.user_polynomial[user]
        steps.jacobian[first + leader] -= c[0] + x * (2.0 * c[1] + x * (3.0 * c[2] + x * 4.0 * c[3]))
        bent = -(2.0 * c[1] + x * (6.0 * c[2] + x * 12.0 * c[3]))
    if status == ROW_HOLDS:
        gain = users.user_erp[user] * settings.joint_erp / settings.time_step
        for dof in range(n):
            steps.side[row * space.columns + dof] = -gain * steps.jacobian[first + dof]
        if is_gear:
            auxiliary = users.user_gear_auxiliary[user]
            if auxiliary >= 0:
                third = space.row_dof[model.link[auxiliary].first_dof]
                steps.through[first + third] = 1.0
                steps.side[row * space.columns + third] += gain
    if leader >= 0:
        # The Jacobian changes with the position of the leader.
        force = ((2 * place + 1) * n + leader) * space.columns + leader
        steps.force[force] += impulse / settings.time_step * bent
        solved = steps.velocity[(3 * place + 2) * n + leader]
        steps.side[row * space.columns + leader] -= holds * solved * bent


@func
def add_ties(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
):
    """Add the rows of gears and couplings; those of other user constraints are added on the host."""
    for user in range(space.users):
        kind = users.user_kind[user]
        if kind == USER_GEAR or kind == USER_COUPLING:
            there = is_there(state, world, users.user_tree_a[user])
            there *= is_there(state, world, users.user_tree_b[user])
            if users.user_enabled[world, user] != 0 and there == 1:
                add_tie(model, settings, state, scratch, users, space, steps, place, world, user)


@func
def add_motor(
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
        if free and wp.abs(wanted) > motor[MOTOR_VELOCITY_CLAMP]:
            status = Int32(ROW_SATURATED)
        alpha = wp.where(free, real(1.0), real(0.0))
        row = add_row_of_dof(space, steps, place, MOTOR_ROW, status, dof, alpha, 1.0 - alpha)
        given = space.dof_input[dof]
        if not free:
            sign = wp.where(status == ROW_LOWER, real(-1.0), real(1.0))
            set_input(space, steps, row, given, MOTOR_MAX_IMPULSE, sign)
        elif status == ROW_HOLDS:
            steps.side[row * space.columns + dof] = -motor[MOTOR_KP] / h
            steps.through[row * space.dofs + dof] = 1.0 - motor[MOTOR_KD]
            set_input(space, steps, row, given, MOTOR_POSITION, motor[MOTOR_KP] / h)
            set_input(space, steps, row, given, MOTOR_VELOCITY, motor[MOTOR_KD])
            set_input(space, steps, row, given, MOTOR_KP, error / h)
            set_input(space, steps, row, given, MOTOR_KD, motor[MOTOR_VELOCITY] - rate)


@func
def add_limit(
    model: Model,
    settings: Settings,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    constraint: Int32,
    dof: Int32,
    least: real,
):
    """Add the row of a limit of a joint that pushes with more than `least`."""
    position = joint_position(scratch, space, world, dof)
    impulse = steps.impulse[place * space.dofs + dof]
    side = wp.where(impulse > 0.0, real(1.0), real(-1.0))
    violation = model.constraint_lower[world, constraint] - position
    if side < 0.0:
        violation = position - model.constraint_upper[world, constraint]
    if violation >= 0.0 and side * impulse > least:
        steps.impulse[place * space.dofs + dof] = 0.0
        if model.constraint_impedance[world, constraint][1] > 0.0:
            note_problem(steps, place, YIELDING_LIMIT, dof)
        if side * impulse >= model.constraint_max_impulse[world, constraint] * (1.0 - NEAR):
            status = wp.where(side > 0.0, Int32(ROW_UPPER), Int32(ROW_LOWER))
            add_row_of_dof(space, steps, place, LIMIT_ROW, status, dof, real(0.0), real(1.0))
        else:
            row = add_row_of_dof(space, steps, place, LIMIT_ROW, ROW_HOLDS, dof, real(1.0), real(0.0))
            if settings.split_impulse == 0 or -violation > settings.split_threshold:
                steps.side[row * space.columns + dof] = -settings.joint_erp / settings.time_step


@func
def add_friction(
    model: Model,
    settings: Settings,
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
        impulse = steps.impulse[place * space.dofs + dof]
        steps.impulse[place * space.dofs + dof] = 0.0
        # The rest of a sum is less precise than an impulse of its own.
        status = status_of(impulse, -bound * (1.0 - NEAR), bound * (1.0 - NEAR))
        alpha = wp.where(status == ROW_HOLDS, real(1.0), real(0.0))
        row = add_row_of_dof(space, steps, place, FRICTION_ROW, status, dof, alpha, 1.0 - alpha)
        if status == ROW_HOLDS:
            if model.constraint_impedance[world, constraint][1] > 0.0:
                note_problem(steps, place, YIELDING_FRICTION, dof)
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
    """Add the row of an actuator of a joint."""
    h = settings.time_step
    if model.actuator[actuator].is_muscle != 0:
        note_problem(steps, place, MUSCLE_ROW, dof)
    if model.actuator[actuator].to_next != 0:
        note_problem(steps, place, BOUNDED_SUM, dof)
    gear = model.actuator_gear[world, actuator]
    first = model.actuator_joint_lower[world, actuator] / gear
    second = model.actuator_joint_upper[world, actuator] / gear
    lowest = wp.max(model.actuator_force_lower[world, actuator], wp.min(first, second))
    highest = wp.min(model.actuator_force_upper[world, actuator], wp.max(first, second))
    force = wp.min(wp.max(state.actuator_force[world, actuator], lowest), highest)
    steps.impulse[place * space.dofs + dof] -= h * gear * force
    status = status_of(force, lowest, highest)
    if status != ROW_HOLDS:
        add_row_of_dof(space, steps, place, ACTUATOR_ROW, status, dof, real(0.0), real(1.0))
    else:
        control = state.actuator_control[world, actuator]
        lower = model.actuator_control_lower[world, actuator]
        upper = model.actuator_control_upper[world, actuator]
        filtered = model.actuator[actuator].dynamics != UNFILTERED
        drive = wp.min(wp.max(control, lower), upper)
        if filtered:
            drive = scratch.actuator_start[world, actuator]
        gain = model.actuator_gain[world, actuator]
        terms = gain * drive + model.actuator_bias[world, actuator]
        length = gear * joint_position(scratch, space, world, dof)
        speed = gear * steps.velocity[(3 * place + 1) * space.dofs + dof]
        after = gear * steps.velocity[(3 * place + 2) * space.dofs + dof]
        # Of length and velocity, those at the end count where the force falls with them.
        yielding = real(0.0)
        through = h * gear * gear * terms[2]
        if terms[1] < 0.0:
            length += h * after
            yielding -= gear * gear * h * h * terms[1]
        if terms[2] < 0.0:
            speed = after
            yielding -= gear * gear * h * terms[2]
            through = real(0.0)
        ends = Vector3(real(1.0), length, speed)
        row = add_row_of_dof(space, steps, place, ACTUATOR_ROW, ROW_HOLDS, dof, yielding, real(1.0))
        side = row * space.columns
        share = h * gear
        steps.side[side + dof] = share * gear * terms[1]
        steps.through[row * space.dofs + dof] = through
        by_drive = share * wp.dot(gain, ends)
        given = space.actuator_input[actuator]
        if filtered:
            steps.side[side + 2 * space.dofs + space.actuator_column[actuator]] = by_drive
        elif lower <= control and control <= upper:
            set_input(space, steps, row, given, INPUT_CONTROL, by_drive)
        for term in range(3):
            set_input(space, steps, row, given, INPUT_GAIN + term, share * drive * ends[term])
            set_input(space, steps, row, given, INPUT_BIAS + term, share * ends[term])


@func
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

    Impulses of motors and actuators are known; those of limits and friction are what is left of the impulses
    on their dofs. Motors of spherical joints are added on the host.
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
            own = part == 0 and (kind == MOTOR or kind == ACTUATOR)
            own = own or (part == 1 and (kind == LIMIT or kind == SPHERICAL_LIMIT))
            own = own or (part == 2 and kind == FRICTION)
            if own:
                link = model.constraint[constraint].link
                dof = space.row_dof[model.link[link].first_dof]
                if kind == MOTOR:
                    add_motor(settings, state, scratch, space, steps, place, world, dof)
                elif kind == ACTUATOR:
                    actuator = model.constraint[constraint].actuator
                    add_actuator(model, settings, state, scratch, space, steps, place, world, actuator, dof)
                elif kind == LIMIT:
                    add_limit(model, settings, scratch, space, steps, place, world, constraint, dof, least)
                elif kind == FRICTION:
                    for axis in range(model.link[link].dof_count):
                        add_friction(model, settings, space, steps, place, world, constraint, dof + axis)
                else:
                    for axis in range(3):
                        if wp.abs(steps.impulse[place * space.dofs + dof + axis]) > least:
                            note_problem(steps, place, BALL_LIMIT, dof)
