"""Rows of joints and user constraints for the converged solver."""

import warp as wp

from carom.kernels.dynamics.rows import inverse_mass_entry, row_dof
from carom.kernels.newton.members import place_of
from carom.kernels.solver.activity import is_in_force
from carom.kernels.solver.joint_solver import joint_constraint_rows
from carom.kernels.solver.pair_rows import has_room
from carom.kernels.solver.user_constraints import add_user_rows
from carom.kernels.structs import (
    Model,
    NewtonRows,
    NewtonWork,
    PairRows,
    Scratch,
    Settings,
    State,
    UserConstraints,
)
from carom.kernels.types import Int32, func, real
from carom.layouts.codes import MOTOR, SPHERICAL_LIMIT, SPHERICAL_MOTOR, USER
from carom.layouts.newton import (
    BOUNDED,
    JOINT_REGULAR,
    OF_JOINT,
    OF_USER,
    PAIR_BLOCK,
    PAIR_ROW,
    ROWS,
    SHORT,
)
from carom.layouts.pair_rows import ROWS_PER_PAIR

_JOINT_REGULAR = real(JOINT_REGULAR)


@wp.func_native("""
    auto& own = wp::index(rows, world, row);
    own = {};
    own.bounded_by = own.start = -1;
    own.regular = 1.0;
    own.origin = origin;
    own.source = source;
""")
def clear_row(rows: NewtonRows, world: Int32, row: Int32, origin: Int32, source: Int32):
    """Begin a row that is off."""
    ...


@wp.func_native("""
    auto* all = &wp::index(rows, world, row);
    for (int k = 0; k < count; ++k) {
        auto& own = all[k];
        own = {};
        own.bounded_by = -1;
        own.regular = 1.0;
        own.origin = k == 0 ? 2 : 3;
        own.source = contact;
        own.start = block + k * (blocks_a + blocks_b);
        own.place_a = place_a;
        own.blocks_a = blocks_a;
        own.place_b = place_b;
        own.blocks_b = blocks_b;
    }
""")
def begin_contact_rows(
    rows: NewtonRows,
    world: Int32,
    row: Int32,
    count: Int32,
    contact: Int32,
    block: Int32,
    place_a: Int32,
    blocks_a: Int32,
    place_b: Int32,
    blocks_b: Int32,
):
    """Begin the rows of a contact, its normal first, all off, with Jacobians from `block` on."""
    ...


@func
def bound_row(
    work: NewtonWork, world: Int32, row: Int32, regular: real, target: real, lower: real, upper: real
):
    """Let a row ask for the change `target` of its rate, within bounds of its impulse."""
    work.newton_row[world, row].kind = BOUNDED
    work.newton_row[world, row].regular = regular
    work.newton_row[world, row].target = target
    work.newton_row[world, row].rate = -target
    work.newton_row[world, row].lower = wp.min(lower, upper)
    work.newton_row[world, row].upper = wp.max(lower, upper)


@func
def place_pair(
    model: Model, work: NewtonWork, pair_rows: PairRows, world: Int32, row: Int32, pair_row: Int32,
    tree_a: Int32, tree_b: Int32,
):  # fmt: skip
    """Take over the Jacobian of a row over two trees."""
    place = pair_rows.row_place[world, pair_row]
    work.newton_row[world, row].start = pair_rows.row_start[world, pair_row]
    work.newton_row[world, row].place_a = place_of(model, work, world, tree_a)
    work.newton_row[world, row].blocks_a = place[1]
    work.newton_row[world, row].place_b = place_of(model, work, world, tree_b)
    work.newton_row[world, row].blocks_b = place[3]


@func
def take_joint_row(
    model: Model, state: State, scratch: Scratch, work: NewtonWork, world: Int32, source: Int32
):
    """Add row `source` of a joint; a motor that was not at its bounds is taken not to be there again."""
    row = work.count_newton[world, ROWS] + 0
    clear_row(work.newton_row, world, row, Int32(OF_JOINT), source)
    tree = model.constraint[scratch.row[world, source].constraint].tree
    place = place_of(model, work, world, tree)
    entry = scratch.row[world, source].entry - 4 * scratch.row[world, source].delta
    work.newton_row[world, row].place_a = 4 * place + entry
    mass = scratch.row[world, source].effective_mass
    if mass > 0.0:
        kind = model.constraint[scratch.row[world, source].constraint].kind
        regular = _JOINT_REGULAR / mass
        if kind == SPHERICAL_MOTOR or kind == SPHERICAL_LIMIT:
            # Theirs is that of links alone, as in Bullet.
            regular = _JOINT_REGULAR * inverse_mass_entry(model, scratch, world, tree, entry, entry)
        if scratch.row[world, source].soft != 0:
            # Of rows that yield: λ = share / softness (b − J Δv).
            share = scratch.row_share[world, source]
            regular = scratch.row_softness[world, source] / share
        bound_row(
            work, world, row, regular, scratch.row[world, source].change, scratch.row[world, source].lower,
            scratch.row[world, source].upper,
        )  # fmt: skip
        if kind == MOTOR or kind == SPHERICAL_MOTOR:
            last = state.dof_motor_impulse[world, row_dof(model, scratch, world, source)]
            if last > work.newton_row[world, row].lower and last < work.newton_row[world, row].upper:
                work.newton_row[world, row].rate = -regular * last
    work.count_newton[world, ROWS] = row + 1


@func
def take_user_row(
    model: Model, work: NewtonWork, pair_rows: PairRows, world: Int32, source: Int32, tree_a: Int32,
    tree_b: Int32,
):  # fmt: skip
    """Add row `source` of a user constraint."""
    row = work.count_newton[world, ROWS] + 0
    clear_row(work.newton_row, world, row, Int32(OF_USER), source)
    terms = pair_rows.row_terms[world, source]
    place_pair(model, work, pair_rows, world, row, source, tree_a, tree_b)
    if terms.effective_mass > 0.0:
        softness = terms.softness / terms.effective_mass
        inverse_mass = 1.0 / terms.effective_mass - softness
        regular = wp.max(softness, _JOINT_REGULAR * inverse_mass)
        target = terms.share / terms.effective_mass
        bound_row(work, world, row, regular, target, terms.lower, terms.upper)
    elif terms.lower == terms.upper:
        # A given force along which nothing can move is told all the same.
        bound_row(work, world, row, 1.0, 0.0, terms.lower, terms.upper)
    work.count_newton[world, ROWS] = row + 1


@func
def add_constraints(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    work: NewtonWork,
    world: Int32,
    root: Int32,
    compliant: Int32,
) -> Int32:
    """Add the rows of an island's motors, limits and user constraints; returns how many are of joints.

    If `compliant` is 1, user constraints that yield follow MuJoCo's law to the letter.
    """
    joint_row = Int32(0)
    constraint = pair_rows.tree_first_constraint[world, root]
    while constraint >= 0:
        if work.count_newton[world, ROWS] + 2 * ROWS_PER_PAIR > work.newton_row.shape[1]:
            work.count_newton[world, SHORT] = 1
            return joint_row
        if model.constraint[constraint].kind != USER:
            before = joint_row + 0
            joint_row = joint_constraint_rows(model, settings, state, scratch, world, constraint, joint_row)
            while before < joint_row:
                take_joint_row(model, state, scratch, work, world, before)
                before += 1
        else:
            user = model.constraint[constraint].link
            if is_in_force(state, users, world, user):
                tree_a, tree_b = users.user_tree_a[user], users.user_tree_b[user]
                row = work.count_newton[world, PAIR_ROW] + 0
                block = work.count_newton[world, PAIR_BLOCK] + 0
                if not has_room(model, pair_rows, row, block, tree_a, tree_b):
                    work.count_newton[world, SHORT] = 1
                    return joint_row
                after, block = add_user_rows(
                    settings, model, state, scratch, users, pair_rows, world, user, row, block, compliant
                )
                while row < after:
                    take_user_row(model, work, pair_rows, world, row, tree_a, tree_b)
                    row += 1
                work.count_newton[world, PAIR_ROW] = after
                work.count_newton[world, PAIR_BLOCK] = block
        constraint = pair_rows.constraint_next[world, constraint]
    return joint_row
