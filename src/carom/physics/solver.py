"""Projected Gauss-Seidel on the constraint rows of one island, contacts and user constraints included.

Sweeps go and end as those of `joint_solver`, which does the same where nothing is coupled.
"""

import warp as wp

from carom.model.codes import USER
from carom.model.contact_structs import Contacts, Couplings, Shapes, UserConstraints
from carom.model.real import Index4, Int32, func, real
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.contact_rows import add_contact_rows, keep_contact_impulses
from carom.physics.couplings import tree_blocks
from carom.physics.joint_solver import joint_constraint_rows, keep_row_results
from carom.physics.patches import gather_units, scatter_impulses
from carom.physics.quarantine import OVERFLOW
from carom.physics.sweeps import contact_sweep, visit_sweep
from carom.physics.user_constraints import add_user_rows, keep_user_impulses

# A contact or a user constraint adds at most this many rows.
ROWS_PER_PAIR = 6


@func
def island_rows(
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
        if model.constraint[constraint].kind != USER:
            row = joint_constraint_rows(model, settings, state, scratch, world, constraint, row)
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
    made = island_rows(model, settings, state, scratch, users, couplings, world, root)
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

    units = Index4(0, 0, 0, 0)
    if first_contact >= 0:
        units = gather_units(contacts, couplings, world, first_contact)
    residual = real(0.0)
    sweep = Int32(0)
    searching = Int32(0)
    if visits > 0 or first_contact >= 0:
        searching = Int32(1)
    while searching == 1:
        residual = visit_sweep(settings, scratch, couplings, world, visits, sweep)
        if first_contact >= 0:
            residual = wp.max(residual, contact_sweep(settings, scratch, couplings, world, units))
        sweep += 1
        if residual <= settings.residual_threshold or sweep >= settings.iterations:
            searching = Int32(0)
    for patch in range(units[1]):
        scatter_impulses(couplings, world, patch)
    keep_row_results(model, settings, state, scratch, world, root, made[0], sweep, residual)
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
