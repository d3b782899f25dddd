"""Rows of tendons over joints, and of their actuators, linearised: their moment arms do not change."""

import warp as wp

from carom.kernels.linearization.actuator_law import add_actuator_law
from carom.kernels.linearization.matrices import clear
from carom.kernels.linearization.rows import (
    add_row,
    joint_position,
    note_problem,
    share_left,
    status_of,
)
from carom.kernels.linearization.soft_rows import ERROR_ITSELF, set_error, write_mass_changes, yielding_law
from carom.kernels.structs import Model, Scratch, Settings, State, StepBatch, StepSpace, UserConstraints
from carom.kernels.tendons.compliance import is_compliant
from carom.kernels.tendons.rows import tendon_limits
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.codes import PATH_JOINT
from carom.layouts.linearization import (
    OTHER_USER,
    ROW_HOLDS,
    TENDON_FRICTION,
    TENDON_LIMIT,
    TENDON_SPRING,
    TRANSMISSION_ROW,
)

_UNBOUNDED = real(1e30)


@func
def is_over_joints(users: UserConstraints, user: Int32) -> bool:
    """Whether the length of a path is a sum over positions of joints."""
    found = users.user_is_wrench[user] == 0
    for part in range(users.user_first_path[user], users.user_second_path[user]):
        found = found and users.path_kind[part] == PATH_JOINT
    return found


@func
def add_arms(
    model: Model,
    scratch: Scratch,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    user: Int32,
    row: Int32,
    gear: real,
) -> Vector3:
    """Add moment arms times `gear` to a row; returns the length and its rates, before and at the end, so too.

    The rates are those after the free motion, and at the end of the step.
    """
    n = space.dofs
    length, speed, after = real(0.0), real(0.0), real(0.0)
    for part in range(users.user_first_path[user], users.user_second_path[user]):
        arm = gear * users.path_size[part]
        dof = space.row_dof[model.link[users.path_link[part]].first_dof]
        steps.jacobian[row * n + dof] += arm
        length += arm * joint_position(scratch, space, world, dof)
        speed += arm * steps.velocity[(3 * place + 1) * n + dof]
        after += arm * steps.velocity[(3 * place + 2) * n + dof]
    return Vector3(length, speed, after)


@func
def add_spring(
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
    length: real,
):
    """Add the row of spring, damper and armature, if the tendon has any."""
    h = settings.time_step
    spring = users.user_spring[user]
    armature = users.user_armature[user]
    stiffness = spring[0] if length > spring[3] or length < spring[2] else 0.0
    yielding = h * (spring[1] + h * stiffness) + armature
    if yielding > 0.0:
        row = add_row(space, steps, place, TENDON_SPRING, ROW_HOLDS, user, yielding, real(1.0))
        steps.row_impulse[row] = state.user_impulse[world, user][0]
        add_arms(model, scratch, users, space, steps, place, world, user, row, real(1.0))
        side = row * space.columns
        for dof in range(space.dofs):
            arm = steps.jacobian[row * space.dofs + dof]
            steps.side[side + dof] = -h * stiffness * arm
            steps.side[side + space.dofs + dof] = armature * arm


@func
def add_tendon_friction(
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
    """Add the row of friction, if the tendon has any."""
    bound = settings.time_step * users.user_range[user][2]
    if bound > 0.0:
        impulse = state.user_impulse[world, user][1]
        status = status_of(impulse, -bound, bound)
        alpha = wp.where(status == ROW_HOLDS, real(1.0), real(0.0))
        row = add_row(space, steps, place, TENDON_FRICTION, status, user, alpha, 1.0 - alpha)
        steps.row_impulse[row] = impulse
        add_arms(model, scratch, users, space, steps, place, world, user, row, real(1.0))
        if status == ROW_HOLDS:
            steps.row_switch[row] = share_left(impulse, -bound, bound)


@func
def add_tendon_limit(
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
    length: real,
    place_of_impulse: Int32,
):
    """Add the row of a limit, if it pushes."""
    n = space.dofs
    impulse = state.user_impulse[world, user][place_of_impulse]
    if impulse != 0.0:
        row = add_row(space, steps, place, TENDON_LIMIT, ROW_HOLDS, user, real(1.0), real(0.0))
        steps.row_impulse[row] = impulse
        add_arms(model, scratch, users, space, steps, place, world, user, row, real(1.0))
        margin = users.user_range[user][3]
        error = length - users.user_range[user][0] - margin
        if impulse < 0.0:
            error = length - users.user_range[user][1] + margin
        side = row * space.columns
        if is_compliant(users, user):
            for dof in range(n):
                steps.side[side + dof] = steps.jacobian[row * n + dof]
            clear(steps.rate, row * n, n)
            impedance = users.user_impedance[user]
            law = yielding_law(settings, users.user_reference[user], impedance, error)
            stated = impedance[3] + 0.0
            of_row = stated <= 0.0
            if of_row:
                stated = write_mass_changes(model, state, space, steps, place, world, row)
            set_error(space, steps, place, row, law, error, ERROR_ITSELF, stated, real(1.0), of_row)
        elif settings.split_impulse == 0 or -wp.abs(error) > settings.split_threshold:
            for dof in range(n):
                arm = steps.jacobian[row * n + dof]
                steps.side[side + dof] = -settings.joint_erp / settings.time_step * arm


@func
def path_length(
    model: Model, scratch: Scratch, users: UserConstraints, space: StepSpace, world: Int32, user: Int32
) -> real:
    """Length of a path over joints before the step."""
    length = real(0.0)
    for part in range(users.user_first_path[user], users.user_second_path[user]):
        dof = space.row_dof[model.link[users.path_link[part]].first_dof]
        length += users.path_size[part] * joint_position(scratch, space, world, dof)
    return length


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
    if is_over_joints(users, user):
        length = path_length(model, scratch, users, space, world, user)
        add_spring(model, settings, state, scratch, users, space, steps, place, world, user, length)
        add_tendon_friction(model, settings, state, scratch, users, space, steps, place, world, user)
        for limit in range(tendon_limits(users, user)):
            add_tendon_limit(
                model, settings, state, scratch, users, space, steps, place, world, user, length, 2 + limit
            )
    else:
        note_problem(steps, place, OTHER_USER, users.user_kind[user])


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
    """Add the row of an actuator of a tendon."""
    n, h = space.dofs, settings.time_step
    actuator = users.user_actuator[user]
    known = is_over_joints(users, user) and model.actuator[actuator].is_muscle == 0
    known = known and model.actuator_joint_lower[world, actuator] <= -_UNBOUNDED
    known = known and model.actuator_joint_upper[world, actuator] >= _UNBOUNDED
    if known:
        impulse = state.user_impulse[world, user][0]
        lower = h * model.actuator_force_lower[world, actuator]
        upper = h * model.actuator_force_upper[world, actuator]
        status = status_of(impulse, lower, upper)
        row = add_row(space, steps, place, TRANSMISSION_ROW, status, user, real(0.0), real(1.0))
        steps.row_impulse[row] = impulse
        gear = model.actuator_gear[world, actuator]
        rates = add_arms(model, scratch, users, space, steps, place, world, user, row, gear)
        if status == ROW_HOLDS:
            law = add_actuator_law(
                model, settings, state, scratch, space, steps, place, world, actuator, row, rates[0],
                rates[1], rates[2], real(1.0),
            )  # fmt: skip
            for dof in range(n):
                arm = steps.jacobian[row * n + dof]
                steps.side[row * space.columns + dof] = law[0] * arm
                steps.through[row * n + dof] = law[1] * arm
    else:
        note_problem(steps, place, OTHER_USER, users.user_kind[user])
