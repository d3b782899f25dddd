"""Rows of user constraints, linearised: gears, couplings, tendons, and those between two links."""

import warp as wp

from carom.kernels.linearization.matrices import clear
from carom.kernels.linearization.pose_rows import add_pose_rows, is_pose_constraint
from carom.kernels.linearization.rows import add_row, joint_position, note_problem, share_left, status_of
from carom.kernels.linearization.soft_rows import (
    ERROR_ITSELF,
    follows_own_mass,
    let_row_yield,
    rigid_law,
    set_error,
    write_mass_changes,
    yielding_law,
)
from carom.kernels.linearization.tendon_rows import add_tendon, add_tendon_coupling, add_transmission
from carom.kernels.structs import Model, Scratch, Settings, State, StepBatch, StepSpace, UserConstraints
from carom.kernels.tendons.compliance import is_compliant
from carom.kernels.types import Int32, func, real
from carom.layouts.codes import (
    ABSENT,
    USER_COUPLING,
    USER_GEAR,
    USER_TENDON,
    USER_TENDON_COUPLING,
    USER_TRANSMISSION,
)
from carom.layouts.linearization import COUPLING_ROW, GEAR_ROW, OTHER_USER, ROW_HOLDS


@func
def is_there(state: State, world: Int32, tree: Int32) -> Int32:
    """1 unless a tree is absent; -1 is the world."""
    there = Int32(1)
    if tree >= 0:
        if state.tree_activity[world, tree] == ABSENT:
            there = Int32(0)
    return there


@func
def add_only_row(
    state: State,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    user: Int32,
    kind: Int32,
):
    """Add the row of a constraint that has one, without its entries; returns it and its status."""
    impulse = state.user_impulse[world, user][0]
    bound = users.user_max_impulse[user]
    status = status_of(impulse, -bound, bound)
    holds = wp.where(status == ROW_HOLDS, real(1.0), real(0.0))
    row = add_row(space, steps, place, kind, status, user, holds, 1.0 - holds)
    steps.row_impulse[row] = impulse
    if status == ROW_HOLDS:
        steps.row_switch[row] = share_left(impulse, -bound, bound)
    return row, status


@func
def add_gear(
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
    """Add the row of a gear."""
    n = space.dofs
    row, status = add_only_row(state, users, space, steps, place, world, user, GEAR_ROW)
    link_b = users.user_link_b[user]
    ratio = users.user_gear_ratio[user]
    follower = space.row_dof[model.link[users.user_link_a[user]].first_dof]
    leader = space.row_dof[model.link[link_b].first_dof]
    steps.jacobian[row * n + follower] += 1.0
    steps.jacobian[row * n + leader] += ratio
    if status == ROW_HOLDS:
        side = row * space.columns
        gain = users.user_erp[user] * settings.joint_erp / settings.time_step
        steps.side[side + follower] -= gain
        # Its error has the position of another joint, see `geared_position`.
        tree_a = users.user_tree_a[user]
        number = link_b - model.tree[users.user_tree_b[user]].first_link
        if number < model.tree[tree_a].link_count:
            link_b = model.tree[tree_a].first_link + number
        if model.link[link_b].dof_count > 0:
            geared = space.row_dof[model.link[link_b].first_dof]
            steps.side[side + geared] -= gain * ratio
        auxiliary = users.user_gear_auxiliary[user]
        if auxiliary >= 0:
            third = space.row_dof[model.link[auxiliary].first_dof]
            steps.through[row * n + third] = 1.0
            steps.side[side + third] += gain
        let_row_yield(model, state, space, steps, place, world, row, steps.row_impulse[row])


@func
def add_coupling(
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
    """Add the row of a coupling."""
    n = space.dofs
    row, status = add_only_row(state, users, space, steps, place, world, user, COUPLING_ROW)
    first = row * n
    follower = space.row_dof[model.link[users.user_link_a[user]].first_dof]
    steps.jacobian[first + follower] += 1.0
    error = joint_position(scratch, space, world, follower) - users.user_relative_target[user]
    bent = real(0.0)
    leader = Int32(-1)
    if users.user_tree_b[user] >= 0:
        leader = space.row_dof[model.link[users.user_link_b[user]].first_dof]
        x = joint_position(scratch, space, world, leader)
        c = users.user_polynomial[user]
        error -= x * (c[0] + x * (c[1] + x * (c[2] + x * c[3])))
        steps.jacobian[first + leader] -= c[0] + x * (2.0 * c[1] + x * (3.0 * c[2] + x * 4.0 * c[3]))
        bent = -(2.0 * c[1] + x * (6.0 * c[2] + x * 12.0 * c[3]))
        # The Jacobian changes with the position of the leader.
        force = ((2 * place + 1) * n + leader) * space.columns + leader
        steps.force[force] += steps.row_impulse[row] / settings.time_step * bent
    if status == ROW_HOLDS:
        law = rigid_law(space, users.user_erp[user] * settings.joint_erp / settings.time_step)
        stated = users.user_impedance[user][3]
        yields = is_compliant(users, user)
        of_row = follows_own_mass(space, yields, stated)
        if yields:
            law = yielding_law(settings, users.user_reference[user], users.user_impedance[user], error)
        if of_row:
            stated = write_mass_changes(model, state, space, steps, place, world, row)
        clear(steps.rate, first, n)
        if leader >= 0:
            rate = steps.velocity[(3 * place + 2) * n + leader]
            rate -= law[0] * steps.velocity[3 * place * n + leader]
            steps.rate[first + leader] = rate * bent
            if of_row:
                response = place * n * space.most_rows
                steps.response[response + n + leader] += 2.0 * steps.response[response + leader] * bent
        for dof in range(n):
            steps.side[row * space.columns + dof] = steps.jacobian[first + dof]
        set_error(space, steps, place, row, law, error, ERROR_ITSELF, stated, real(1.0), of_row)


@func
def add_users(
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
    """Add the rows of all user constraints."""
    for user in range(space.users):
        there = is_there(state, world, users.user_tree_a[user])
        there *= is_there(state, world, users.user_tree_b[user])
        if users.user_enabled[world, user] != 0 and there == 1:
            kind = users.user_kind[user]
            if kind == USER_GEAR:
                add_gear(model, settings, state, users, space, steps, place, world, user)
            elif kind == USER_COUPLING:
                add_coupling(model, settings, state, scratch, users, space, steps, place, world, user)
            elif kind == USER_TENDON:
                add_tendon(model, settings, state, scratch, users, space, steps, place, world, user)
            elif kind == USER_TENDON_COUPLING:
                add_tendon_coupling(model, settings, state, scratch, users, space, steps, place, world, user)
            elif kind == USER_TRANSMISSION:
                add_transmission(model, settings, state, scratch, users, space, steps, place, world, user)
            elif is_pose_constraint(kind):
                add_pose_rows(model, settings, state, users, space, steps, place, world, user)
            else:
                note_problem(steps, place, OTHER_USER, kind)
