"""Rows of tendons, of couplings of two of them, and of actuators of tendons and sites, linearised."""

import warp as wp

from carom.kernels.linearization.actuator_law import add_actuator_law
from carom.kernels.linearization.bounded_sums import add_bounded_share
from carom.kernels.linearization.path_arms import (
    add_bent_mass,
    add_path_arms,
    arms_of,
    bend_rate,
    clear_arms,
    scale_arms,
    take_arms,
)
from carom.kernels.linearization.rows import add_row, rate_of_law, share_left, status_of
from carom.kernels.linearization.site_arms import add_site_arms
from carom.kernels.linearization.soft_rows import (
    ERROR_ITSELF,
    follows_own_mass,
    rigid_law,
    set_error,
    write_mass_changes,
    yielding_law,
)
from carom.kernels.structs import Model, Scratch, Settings, State, StepBatch, StepSpace, UserConstraints
from carom.kernels.tendons.compliance import is_compliant
from carom.kernels.tendons.rows import tendon_limits
from carom.kernels.types import Int32, Vector2, func, real
from carom.layouts.linearization import (
    ROW_HOLDS,
    TENDON_COUPLING_ROW,
    TENDON_FRICTION,
    TENDON_LIMIT,
    TENDON_SPRING,
    TRANSMISSION_ROW,
)


@func
def rates_of(settings: Settings, space: StepSpace, steps: StepBatch, place: Int32, row: Int32) -> Vector2:
    """The rates of a row by `rate_of_law`, and at the end of the step."""
    n = space.dofs
    speed, after = real(0.0), real(0.0)
    for dof in range(n):
        arm = steps.jacobian[row * n + dof]
        speed += arm * rate_of_law(settings, space, steps, place, dof)
        after += arm * steps.velocity[(3 * place + 2) * n + dof]
    return Vector2(speed, after)


@func
def add_spring(
    settings: Settings,
    state: State,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    user: Int32,
    length: real,
):
    """Add the row of spring, damper and armature, if the tendon has any.

    What armature feels of the motion of steady joints the host adds, see `linearization.path_inertia`.
    """
    h, n = settings.time_step, space.dofs
    spring = users.user_spring[user]
    armature = users.user_armature[user]
    terms = users.user_polynomial[user]
    stretch = wp.max(length - spring[3], real(0.0)) + wp.min(length - spring[2], real(0.0))
    stiffness, stiffens = real(0.0), real(0.0)
    if length > spring[3] or length < spring[2]:
        stiffness = spring[0] + stretch * (terms[0] + stretch * terms[1])
        stiffens = terms[0] + 2.0 * stretch * terms[1]
    explicit = settings.explicit_forces != 0 or stiffness < 0.0
    yielding = h * (spring[1] + h * stiffness) + armature
    # By how much its impulse grows with the rate before the step.
    before = armature + 0.0
    acts = yielding > 0.0 or stiffness < 0.0
    if explicit:
        yielding = armature
        before -= h * spring[1]
    if acts:
        row = add_row(space, steps, place, TENDON_SPRING, ROW_HOLDS, user, yielding, real(1.0))
        steps.row_impulse[row] = state.user_impulse[world, user][0]
        take_arms(settings, space, steps, place, row)
        bend_rate(space, steps, place, row, -before, real(0.0), yielding)
        side = row * space.columns
        if stiffens != 0.0:
            if not explicit:
                stretch += h * rates_of(settings, space, steps, place, row)[1]
            stiffness += stiffens * stretch
        for dof in range(n):
            arm = steps.jacobian[row * n + dof]
            steps.side[side + dof] = -h * stiffness * arm - steps.rate[row * n + dof]
            steps.side[side + n + dof] = before * arm


@func
def add_tendon_friction(
    model: Model,
    settings: Settings,
    state: State,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    user: Int32,
):
    """Add the row of friction, if the tendon has any."""
    n = space.dofs
    bound = settings.time_step * users.user_range[user][2]
    if bound > 0.0:
        impulse = state.user_impulse[world, user][1]
        status = status_of(impulse, -bound, bound)
        alpha = wp.where(status == ROW_HOLDS, real(1.0), real(0.0))
        row = add_row(space, steps, place, TENDON_FRICTION, status, user, alpha, 1.0 - alpha)
        steps.row_impulse[row] = impulse
        take_arms(settings, space, steps, place, row)
        if status == ROW_HOLDS:
            steps.row_switch[row] = share_left(impulse, -bound, bound)
            softness, softens = real(0.0), place * n * space.most_rows + n
            if space.regular > 0.0:
                softness = space.regular * write_mass_changes(model, state, space, steps, place, world, row)
                add_bent_mass(space, steps, place)
                steps.row_yield[row] = space.regular
            bend_rate(space, steps, place, row, real(0.0), real(0.0), real(1.0))
            for dof in range(n):
                found = -steps.rate[row * n + dof]
                if space.regular > 0.0:
                    found -= impulse * space.regular * steps.response[softens + dof]
                steps.side[row * space.columns + dof] = found
            steps.beta[row * space.most_rows + row - place * space.most_rows] += softness


@func
def set_path_error(
    model: Model,
    settings: Settings,
    state: State,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    user: Int32,
    row: Int32,
    gain: real,
    error: real,
):
    """Let a row that holds an error of a length, of which its arms are there, correct it as it does.

    `gain` is the part that a rigid one corrects in a unit of time [1/s].
    """
    law = rigid_law(space, gain)
    stated = users.user_impedance[user][3] + 0.0
    yields = is_compliant(users, user)
    of_row = follows_own_mass(space, yields, stated)
    if yields:
        law = yielding_law(settings, users.user_reference[user], users.user_impedance[user], error)
    if of_row:
        stated = write_mass_changes(model, state, space, steps, place, world, row)
        add_bent_mass(space, steps, place)
    bend_rate(space, steps, place, row, -law[0], real(0.0), real(1.0))
    for dof in range(space.dofs):
        steps.side[row * space.columns + dof] = steps.jacobian[row * space.dofs + dof]
    set_error(space, steps, place, row, law, error, ERROR_ITSELF, stated, real(1.0), of_row)


@func
def add_tendon_limit(
    model: Model,
    settings: Settings,
    state: State,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    user: Int32,
    length: real,
    place_of_impulse: Int32,
):
    """Add the row of a limit, if it pushes."""
    impulse = state.user_impulse[world, user][place_of_impulse]
    if impulse != 0.0:
        row = add_row(space, steps, place, TENDON_LIMIT, ROW_HOLDS, user, real(1.0), real(0.0))
        steps.row_impulse[row] = impulse
        take_arms(settings, space, steps, place, row)
        margin = users.user_range[user][3]
        error = length - users.user_range[user][0] - margin
        if impulse < 0.0:
            error = length - users.user_range[user][1] + margin
        gain = real(0.0)
        if settings.split_impulse == 0 or -wp.abs(error) > settings.split_threshold:
            gain = settings.joint_erp / settings.time_step
        set_path_error(model, settings, state, users, space, steps, place, world, user, row, gain, error)


@func
def add_tendon(
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
    """Add the rows of a tendon."""
    clear_arms(space, steps, place)
    length = add_path_arms(
        model, state, scratch, users, space, steps, place, world, users.user_first_path[user],
        users.user_second_path[user],
    )  # fmt: skip
    add_spring(settings, state, users, space, steps, place, world, user, length)
    add_tendon_friction(model, settings, state, users, space, steps, place, world, user)
    for limit in range(tendon_limits(users, user)):
        add_tendon_limit(model, settings, state, users, space, steps, place, world, user, length, 2 + limit)


@func
def add_tendon_coupling(
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
    """Add the row that holds the length of a tendon at a polynomial of that of another one."""
    first, second = users.user_first_path[user], users.user_second_path[user]
    end = first + users.user_path_count[user]
    clear_arms(space, steps, place)
    wanted = users.user_relative_target[user] + 0.0
    if second < end:
        other = add_path_arms(model, state, scratch, users, space, steps, place, world, second, end)
        x = other - users.user_range[user][1]
        c = users.user_polynomial[user]
        wanted += x * (c[0] + x * (c[1] + x * (c[2] + x * c[3])))
        slope = c[0] + x * (2.0 * c[1] + x * (3.0 * c[2] + x * 4.0 * c[3]))
        growth = 2.0 * c[1] + x * (6.0 * c[2] + x * 12.0 * c[3])
        scale_arms(space, steps, place, -slope, -growth)
    length = add_path_arms(model, state, scratch, users, space, steps, place, world, first, second)
    error = length - users.user_range[user][0] - wanted
    impulse = state.user_impulse[world, user][0]
    bound = users.user_max_impulse[user]
    status = status_of(impulse, -bound, bound)
    holds = wp.where(status == ROW_HOLDS, real(1.0), real(0.0))
    row = add_row(space, steps, place, TENDON_COUPLING_ROW, status, user, holds, 1.0 - holds)
    steps.row_impulse[row] = impulse
    take_arms(settings, space, steps, place, row)
    if status == ROW_HOLDS:
        steps.row_switch[row] = share_left(impulse, -bound, bound)
        gain = users.user_erp[user] * settings.joint_erp / settings.time_step
        set_path_error(model, settings, state, users, space, steps, place, world, user, row, gain, error)


@func
def add_transmission(
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
    """Add the row of an actuator of a tendon or a site."""
    n, h = space.dofs, settings.time_step
    actuator = users.user_actuator[user]
    gear = model.actuator_gear[world, actuator]
    arms = arms_of(space, place)
    clear_arms(space, steps, place)
    length = real(0.0)
    if users.user_is_wrench[user] != 0:
        length = add_site_arms(model, state, users, space, steps, place, world, user, gear)
    else:
        length = gear * add_path_arms(
            model, state, scratch, users, space, steps, place, world, users.user_first_path[user],
            users.user_second_path[user],
        )  # fmt: skip
        scale_arms(space, steps, place, gear, real(0.0))
        for dof in range(n):
            steps.change[arms + n + dof] = steps.change[arms + dof]
    impulse = state.user_impulse[world, user][0]
    lower = h * model.actuator_force_lower[world, actuator]
    upper = h * model.actuator_force_upper[world, actuator]
    status = status_of(impulse, lower, upper)
    row = add_row(space, steps, place, TRANSMISSION_ROW, status, user, real(0.0), real(1.0))
    steps.row_impulse[row] = impulse
    take_arms(settings, space, steps, place, row)
    if status == ROW_HOLDS:
        rates = rates_of(settings, space, steps, place, row)
        shared = Int32(0)
        law = Vector2(0.0, 0.0)
        if users.user_is_wrench[user] == 0:
            shared, law = add_bounded_share(
                model, settings, state, scratch, space, steps, world, actuator, row, length, rates[0]
            )
        if shared == 0:
            law = add_actuator_law(
                model, settings, state, scratch, space, steps, place, world, actuator, row, length,
                rates[0], rates[1], real(1.0),
            )  # fmt: skip
        number = row - place * space.most_rows
        yielding = steps.alpha[row * space.most_rows + number]
        before, free = real(0.0), law[1] + 0.0
        if settings.explicit_forces != 0:
            before, free = law[1] + 0.0, real(0.0)
        bend_rate(space, steps, place, row, -before, -free, yielding)
        side = row * space.columns
        for dof in range(n):
            steps.side[side + dof] += law[0] * steps.change[arms + n + dof] - steps.rate[row * n + dof]
            steps.side[side + n + dof] += before * steps.jacobian[row * n + dof]
            steps.through[row * n + dof] = free * steps.jacobian[row * n + dof]
