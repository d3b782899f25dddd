"""Projected Gauss-Seidel on the constraint rows of one island, contacts and user constraints included.

Directions and stopping rule of the sweeps are those of `joint_solver`, which is for trees without contacts
and user constraints.
"""

import warp as wp

from carom.kernels.convergence.active_set import FIRST_SWEEPS, SWEEPS_BETWEEN, solve_free_rows
from carom.kernels.convergence.conjugate import go_on, remember_impulses
from carom.kernels.convergence.last_impulses import start_from_last
from carom.kernels.maths.min_max import later_maximum
from carom.kernels.solver.activity import is_in_force
from carom.kernels.solver.joint_solver import clear_delta_velocities, joint_constraint_rows, keep_row_results
from carom.kernels.solver.pair_rows import has_room
from carom.kernels.solver.sweeps import contact_sweep, leave_out_settled, resting_sweep, visit_sweep
from carom.kernels.solver.units import YIELDING, keep_unit_impulses, write_units
from carom.kernels.solver.user_constraints import add_user_rows, keep_user_impulses
from carom.kernels.solver.warm_starting import (
    NOT_RESTING,
    RESTING_PRECISION,
    RESTING_SWEEPS,
    SOLVED,
    UNSOLVED,
)
from carom.kernels.structs import Contacts, Model, PairRows, Scratch, Settings, Shapes, State, UserConstraints
from carom.kernels.types import Int32, called_func, func, real
from carom.layouts.codes import CONE, USER
from carom.layouts.programs import SETTLING_SWEEPS
from carom.layouts.status import OVERFLOW, STATUS

# In place of the number of rows over one tree, if not all of them are in `visit_row`.
NOT_IN_ORDER = -1


@func
def island_rows(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    root: Int32,
):
    """Write the rows of an island's active motors, limits and user constraints.

    Returns:
        Next free row over one tree; next free row and block over two trees; number of rows in `visit_row`,
        negative if some did not fit.
    """
    row, pair_row, block, visits = Int32(0), Int32(0), Int32(0), Int32(0)
    fits = Int32(1)
    constraint = pair_rows.tree_first_constraint[world, root]
    while constraint >= 0:
        before = row + 0
        if model.constraint[constraint].kind != USER:
            row = joint_constraint_rows(model, settings, state, scratch, world, constraint, row)
        else:
            user = model.constraint[constraint].link
            if not is_in_force(state, users, world, user):
                constraint = pair_rows.constraint_next[world, constraint]
                continue
            if has_room(model, pair_rows, pair_row, block, users.user_tree_a[user], users.user_tree_b[user]):
                first = pair_row + 0
                pair_row, block = add_user_rows(
                    settings, model, state, scratch, users, pair_rows, world, user, pair_row, block, Int32(0)
                )
                while first < pair_row:
                    pair_rows.visit_row[world, visits] = -1 - first
                    visits += 1
                    first += 1
            else:
                fits = Int32(0)
        while before < row:
            pair_rows.visit_row[world, visits] = before
            visits += 1
            before += 1
        constraint = pair_rows.constraint_next[world, constraint]
    if fits == 0:
        visits = Int32(-1)
    return row, pair_row, block, visits


@func
def forget_changes(
    settings: Settings, model: Model, state: State, scratch: Scratch, world: Int32, root: Int32
):
    """Set the delta velocities of all trees of an island to zero."""
    for tree in range(settings.tree_count):
        if state.tree_island[world, tree] == root:
            clear_delta_velocities(model, scratch, world, tree)


@called_func
def sweep_island(
    model: Model,
    settings: Settings,
    scratch: Scratch,
    contacts: Contacts,
    pair_rows: PairRows,
    world: Int32,
    root: Int32,
    rows: Int32,
    visits: Int32,
    units: Int32,
    manifold_blocks: Int32,
    character: Int32,
    resting: Int32,
):
    """Sweep over the rows of an island until it converges; with conjugate directions if it is at rest.

    `rows` are those of motors and limits, `visits` those and the rows of user constraints, `units` the units
    of contacts, with so many manifold blocks among them. `character` is as `write_units` returns it,
    `resting` 1 if the island is warm started; then all units are manifold blocks of rigid bodies.

    Returns:
        Residual of the last sweep, the maximum change of a row's velocity, squared; number of sweeps.
    """
    threshold = settings.residual_threshold
    most = settings.iterations
    if resting == 1:
        threshold = threshold * RESTING_PRECISION
        most = most * RESTING_SWEEPS
    residual, square = real(0.0), real(0.0)
    sweep = Int32(0)
    # The sweep after which the free rows are solved for.
    solving = most + 0
    if character == YIELDING and units > 0 and settings.cone_friction == CONE:
        solving = Int32(FIRST_SWEEPS)
        if solving < most:
            start_from_last(model, settings, scratch, contacts, pair_rows, world, root, units)
    between = Int32(SWEEPS_BETWEEN)
    searching = Int32(1) if (visits > 0 or units > 0) and most > 0 else Int32(0)
    while searching == 1:
        if resting == 1:
            remember_impulses(pair_rows, world, manifold_blocks)
        residual = visit_sweep(settings, scratch, pair_rows, world, rows, visits, sweep)
        if resting == 1:
            change = resting_sweep(settings, scratch, pair_rows, world, manifold_blocks)
            residual = later_maximum(residual, change)
        elif units > 0:
            residual = contact_sweep(settings, scratch, pair_rows, world, units, character, residual)
        sweep += 1
        if residual <= threshold or sweep >= most:
            searching = Int32(0)
        elif sweep == solving:
            solving = most + 0
            # Not where nothing can move along some row, which makes the residual NaN.
            if residual > threshold:
                if solve_free_rows(model, scratch, pair_rows, world, root, visits, units) == 1:
                    solving = sweep + between
                    between += 1
        elif sweep <= SETTLING_SWEEPS and visits > 0:
            left = leave_out_settled(scratch, pair_rows, world, visits)
            rows = wp.where(left < visits, Int32(NOT_IN_ORDER), rows)
            visits = left
        elif resting == 1:
            square = go_on(scratch, pair_rows, world, manifold_blocks, square)
    return residual, sweep


@func
def solve_island(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    root: Int32,
):
    """Solve the rows of one island; leaves the result in `delta_velocity`.

    A warm started island whose sweeps do not converge is solved again, from zero impulses.
    """
    rows, pair_row, block, visits = island_rows(
        model, settings, state, scratch, users, pair_rows, world, root
    )
    first_contact = pair_rows.tree_first_contact[world, root]
    # With 0 iterations there must be no impulses, so there is no warm starting either.
    resting = wp.min(wp.min(pair_rows.tree_rest[world, root], 1), settings.iterations)
    outcome = Int32(NOT_RESTING)
    units, manifold_blocks, character = Int32(0), Int32(0), Int32(0)
    residual = real(0.0)
    sweeps = Int32(0)
    trying = Int32(1)
    while trying == 1:
        trying = Int32(0)
        if first_contact >= 0:
            share = settings.contact_warm_starting * real(resting)
            units, manifold_blocks, character = write_units(
                model, settings, state, scratch, shapes, contacts, pair_rows, world, first_contact,
                pair_row, block, share,
            )  # fmt: skip
        if visits < 0 or units < 0:
            state.status_entry[world, STATUS] = OVERFLOW
            return
        residual, sweeps = sweep_island(
            model, settings, scratch, contacts, pair_rows, world, root, rows, visits, units, manifold_blocks,
            character, resting,
        )  # fmt: skip
        if resting == 1:
            outcome = Int32(SOLVED)
            if residual > settings.residual_threshold:
                outcome = Int32(UNSOLVED)
                forget_changes(settings, model, state, scratch, world, root)
                resting = Int32(0)
                trying = Int32(1)
    keep_row_results(model, settings, state, scratch, world, root, rows, sweeps, residual)
    keep_unit_impulses(contacts, pair_rows, world, units, outcome)
    keep_constraint_impulses(model, settings, state, users, pair_rows, world, root)


@func
def keep_constraint_impulses(
    model: Model,
    settings: Settings,
    state: State,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    root: Int32,
):
    """Store the impulses of an island's user constraints."""
    constraint = pair_rows.tree_first_constraint[world, root]
    while constraint >= 0:
        if model.constraint[constraint].kind == USER:
            keep_user_impulses(settings, state, users, pair_rows, world, model.constraint[constraint].link)
        constraint = pair_rows.constraint_next[world, constraint]
