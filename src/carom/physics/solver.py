"""Projected Gauss-Seidel on the constraint rows of one island.

The rows are visited last to first in even sweeps and first to last in odd ones; the sweeps end when
no row changed its velocity by more than the residual threshold, or after the given number.
"""

import warp as wp

from carom.model.codes import (
    LIMIT,
    MOTOR,
    ROW_IMPULSE,
    SPHERICAL_MOTOR,
)
from carom.model.contact_structs import Contacts, Couplings, Shapes, UserConstraints
from carom.model.real import Index4, Int32, Vector4, func, real
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.contact_rows import add_contact_rows, keep_contact_impulses
from carom.physics.couplings import tree_blocks
from carom.physics.feedback import gather_constraint_forces
from carom.physics.limits import limit_rows, spherical_limit_rows
from carom.physics.motors import motor_row, spherical_motor_rows
from carom.physics.quarantine import OVERFLOW, report_fault
from carom.physics.rows import row_dof
from carom.physics.sweeps import contact_sweep, joint_sweep
from carom.physics.user_constraints import add_user_rows, keep_user_impulses

# A contact or a user constraint adds at most this many rows.
ROWS_PER_PAIR = 6


@func
def island_rows(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    couplings: Couplings,
    world: Int32,
    root: Int32,
) -> Int32:
    """Write the rows of the active motors and limits of an island; returns their number."""
    row = Int32(0)
    tree = couplings.tree_first_tree[world, root]
    while tree >= 0:
        first = model.tree_first_constraint[tree]
        for constraint in range(first, first + model.tree_constraint_count[tree]):
            kind = model.constraint_kind[constraint]
            if kind == MOTOR:
                row = motor_row(model, settings, state, scratch, world, constraint, row)
            elif kind == LIMIT:
                row = limit_rows(model, settings, state, scratch, world, constraint, row)
            elif kind == SPHERICAL_MOTOR:
                row = spherical_motor_rows(model, settings, state, scratch, world, constraint, row)
            else:
                row = spherical_limit_rows(model, settings, state, scratch, world, constraint, row)
        tree = couplings.tree_next_tree[world, tree]
    return row


@func
def island_couplings(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    couplings: Couplings,
    world: Int32,
    root: Int32,
) -> Index4:
    """Write the rows of an island's user constraints, then of its contacts.

    Returns:
        Number of rows of user constraints, of all rows, and whether some did not fit.
    """
    place = Index4(0, 0, 0, 0)
    row_capacity = couplings.coupling_start.shape[1]
    block_capacity = couplings.jacobian_row.shape[1]
    overflow = Int32(0)
    user = couplings.tree_first_user[world, root]
    while user >= 0:
        blocks = tree_blocks(model, users.user_tree_a[user]) + tree_blocks(model, users.user_tree_b[user])
        if place[0] + ROWS_PER_PAIR > row_capacity or place[1] + ROWS_PER_PAIR * blocks > block_capacity:
            overflow = Int32(1)
        else:
            place = add_user_rows(settings, model, state, scratch, users, couplings, world, user, place)
        user = couplings.user_next[world, user]
    user_rows = place[0]

    contact = couplings.tree_first_contact[world, root]
    while contact >= 0:
        pair = contacts.contact_shapes[world, contact]
        blocks = tree_blocks(model, shapes.shape_tree[pair[0]]) + tree_blocks(
            model, shapes.shape_tree[pair[1]]
        )
        if place[0] + ROWS_PER_PAIR > row_capacity or place[1] + ROWS_PER_PAIR * blocks > block_capacity:
            overflow = Int32(1)
        else:
            place = add_contact_rows(
                settings,
                model,
                state,
                scratch,
                shapes,
                contacts,
                couplings,
                world,
                contact,
                place[0],
                place[1],
            )
        contact = couplings.contact_next[world, contact]
    return Index4(user_rows, place[0], overflow, 0)


@func
def solve_island(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    couplings: Couplings,
    world: Int32,
    root: Int32,
):
    """Solve the rows of one island; leaves the change of velocity in `delta_velocity`."""
    row_count = island_rows(model, settings, state, scratch, couplings, world, root)
    first_contact = couplings.tree_first_contact[world, root]
    made = Index4(0, 0, 0, 0)
    if first_contact >= 0 or couplings.tree_first_user[world, root] >= 0:
        made = island_couplings(
            model, settings, state, scratch, shapes, contacts, users, couplings, world, root
        )
        if made[2] != 0:
            state.fault_tree[world, 0] = OVERFLOW

    residual = real(0.0)
    sweep = Int32(0)
    searching = Int32(0)
    if row_count + made[1] > 0 and made[2] == 0:
        searching = Int32(1)
    while searching == 1:
        residual = joint_sweep(settings, scratch, couplings, world, row_count, made[0], sweep)
        if first_contact >= 0:
            residual = wp.max(residual, contact_sweep(settings, scratch, couplings, world, first_contact))
        sweep += 1
        if residual <= settings.residual_threshold or sweep >= settings.iterations:
            searching = Int32(0)
    state.tree_iterations[world, root] = sweep
    state.tree_residual[world, root] = residual

    for row in range(row_count):
        keep_motor_impulse(model, state, scratch, world, row)
    gather_constraint_forces(model, settings, scratch, world, 0, row_count)
    if made[2] == 0:
        keep_coupling_impulses(contacts, users, couplings, world, root)


@func
def keep_coupling_impulses(
    contacts: Contacts, users: UserConstraints, couplings: Couplings, world: Int32, root: Int32
):
    """Report the impulses of an island's contacts and user constraints."""
    contact = couplings.tree_first_contact[world, root]
    while contact >= 0:
        keep_contact_impulses(contacts, couplings, world, contact)
        contact = couplings.contact_next[world, contact]
    user = couplings.tree_first_user[world, root]
    while user >= 0:
        keep_user_impulses(users, couplings, world, user)
        user = couplings.user_next[world, user]


@func
def keep_motor_impulse(model: Model, state: State, scratch: Scratch, world: Int32, row: Int32):
    """Report the impulse of a motor's row to the user."""
    kind = model.constraint_kind[scratch.row_constraint[world, row]]
    if kind == MOTOR or kind == SPHERICAL_MOTOR:
        state.dof_motor_impulse[world, row_dof(model, scratch, world, row)] = scratch.row_terms[world, row][
            ROW_IMPULSE
        ]


@func
def clear_delta_velocities(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Start the solver from no change of velocity."""
    first = model.tree_first_delta[tree]
    for block in range(first, first + (model.tree_dof_count[tree] + 3) // 4):
        scratch.delta_velocity[world, block] = Vector4(0.0, 0.0, 0.0, 0.0)


@func
def apply_delta_velocities(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Add what the solver found to the velocities of a tree."""
    bound = model.tree_max_velocity[tree]
    first = model.tree_first_dof[tree]
    delta = model.tree_first_delta[tree]
    total = real(0.0)
    for i in range(model.tree_dof_count[tree]):
        velocity = state.dof_velocity[world, first + i] + scratch.entry_delta_velocity[world, 4 * delta + i]
        state.dof_velocity[world, first + i] = wp.clamp(velocity, -bound, bound)
        total += velocity
    report_fault(state, world, tree, total)
