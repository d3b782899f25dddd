"""Projected Gauss-Seidel on the constraint rows of one island.

The rows are visited last to first in even sweeps and first to last in odd ones; the sweeps end when
no row changed its velocity by more than the residual threshold, or after the given number.
"""

import warp as wp

from carom.model.codes import (
    LIMIT,
    MOTOR,
    SPHERICAL_LIMIT,
    SPHERICAL_MOTOR,
    USER,
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
def joint_rows(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    couplings: Couplings,
    world: Int32,
    root: Int32,
) -> Index4:
    """Write the rows of an island's active motors, limits and user constraints.

    Returns:
        Next free row over one tree; next free row and block over two trees; how many rows to visit,
        negative if some did not fit.
    """
    row = Int32(0)
    place = Index4(0, 0, 0, 0)
    visits = Int32(0)
    fits = Int32(1)
    constraint = couplings.tree_first_constraint[world, root]
    while constraint >= 0:
        before = row + 0
        kind = model.constraint[constraint].kind
        if kind == MOTOR:
            row = motor_row(model, settings, state, scratch, world, constraint, row)
        elif kind == LIMIT:
            row = limit_rows(model, settings, state, scratch, world, constraint, row)
        elif kind == SPHERICAL_MOTOR:
            row = spherical_motor_rows(model, settings, state, scratch, world, constraint, row)
        elif kind == SPHERICAL_LIMIT:
            row = spherical_limit_rows(model, settings, state, scratch, world, constraint, row)
        else:
            user = model.constraint[constraint].link
            if has_room(model, couplings, place, users.user_tree_a[user], users.user_tree_b[user]):
                first = place[0]
                place = add_user_rows(settings, model, state, scratch, users, couplings, world, user, place)
                while first < place[0]:
                    couplings.visit_row[world, visits] = -1 - first
                    visits += 1
                    first += 1
            else:
                fits = Int32(0)
        while before < row:
            couplings.visit_row[world, visits] = before
            visits += 1
            before += 1
        constraint = couplings.constraint_next[world, constraint]
    if fits == 0:
        visits = Int32(-1)
    return Index4(row, place[0], place[1], visits)


@func
def has_room(model: Model, couplings: Couplings, place: Index4, tree_a: Int32, tree_b: Int32) -> bool:
    """Whether all rows there may be between two trees still fit."""
    blocks = tree_blocks(model, tree_a) + tree_blocks(model, tree_b)
    if place[0] + ROWS_PER_PAIR > couplings.coupling_start.shape[1]:
        return False
    return place[1] + ROWS_PER_PAIR * blocks <= couplings.jacobian_row.shape[1]


@func
def contact_rows(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    couplings: Couplings,
    world: Int32,
    first_contact: Int32,
    place: Index4,
) -> Int32:
    """Write the rows of an island's contacts from the free place on; returns 0 if some did not fit."""
    contact = first_contact + 0
    while contact >= 0:
        pair = contacts.contact_shapes[world, contact]
        if not has_room(model, couplings, place, shapes.shape_tree[pair[0]], shapes.shape_tree[pair[1]]):
            return Int32(0)
        place = add_contact_rows(
            settings, model, state, scratch, shapes, contacts, couplings, world, contact, place[0], place[1]
        )
        contact = couplings.contact_next[world, contact]
    return Int32(1)


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
    made = joint_rows(model, settings, state, scratch, users, couplings, world, root)
    visits = made[3]
    first_contact = couplings.tree_first_contact[world, root]
    fits = Int32(1)
    if first_contact >= 0:
        fits = contact_rows(
            model, settings, state, scratch, shapes, contacts, couplings, world, first_contact,
            Index4(made[1], made[2], 0, 0),
        )  # fmt: skip
    if visits < 0 or fits == 0:
        state.fault_tree[world, 0] = OVERFLOW
        return

    residual = real(0.0)
    sweep = Int32(0)
    searching = Int32(0)
    if visits > 0 or first_contact >= 0:
        searching = Int32(1)
    while searching == 1:
        residual = joint_sweep(settings, scratch, couplings, world, visits, sweep)
        if first_contact >= 0:
            residual = wp.max(residual, contact_sweep(settings, scratch, couplings, world, first_contact))
        sweep += 1
        if residual <= settings.residual_threshold or sweep >= settings.iterations:
            searching = Int32(0)
    state.tree_iterations[world, root] = sweep
    state.tree_residual[world, root] = residual

    for row in range(made[0]):
        keep_motor_impulse(model, state, scratch, world, row)
    gather_constraint_forces(model, settings, scratch, world, 0, made[0])
    keep_coupling_impulses(model, contacts, users, couplings, world, root)


@func
def keep_coupling_impulses(
    model: Model, contacts: Contacts, users: UserConstraints, couplings: Couplings, world: Int32, root: Int32
):
    """Report the impulses of an island's contacts and user constraints."""
    contact = couplings.tree_first_contact[world, root]
    while contact >= 0:
        keep_contact_impulses(contacts, couplings, world, contact)
        contact = couplings.contact_next[world, contact]
    constraint = couplings.tree_first_constraint[world, root]
    while constraint >= 0:
        if model.constraint[constraint].kind == USER:
            keep_user_impulses(users, couplings, world, model.constraint[constraint].link)
        constraint = couplings.constraint_next[world, constraint]


@func
def keep_motor_impulse(model: Model, state: State, scratch: Scratch, world: Int32, row: Int32):
    """Report the impulse of a motor's row to the user."""
    kind = model.constraint[scratch.row[world, row].constraint].kind
    if kind == MOTOR or kind == SPHERICAL_MOTOR:
        state.dof_motor_impulse[world, row_dof(model, scratch, world, row)] = scratch.row[world, row].impulse


@func
def clear_delta_velocities(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Start the solver from no change of velocity."""
    first = model.tree[tree].first_delta
    for block in range(first, first + (model.tree[tree].dof_count + 3) // 4):
        scratch.delta_velocity[world, block] = Vector4(0.0, 0.0, 0.0, 0.0)


@func
def apply_delta_velocities(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Add what the solver found to the velocities of a tree."""
    bound = model.tree[tree].max_velocity
    first = model.tree[tree].first_dof
    delta = model.tree[tree].first_delta
    total = real(0.0)
    for i in range(model.tree[tree].dof_count):
        velocity = state.dof_velocity[world, first + i] + scratch.entry_delta_velocity[world, 4 * delta + i]
        state.dof_velocity[world, first + i] = wp.clamp(velocity, -bound, bound)
        total += velocity
    report_fault(state, world, tree, total)
