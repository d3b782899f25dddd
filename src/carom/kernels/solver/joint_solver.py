"""Projected Gauss-Seidel on the rows of motors and limits, for trees without contacts and user constraints.

The rows are visited last to first in even sweeps and first to last in odd ones. Sweeps end when the maximum
squared change of a row's velocity is at most the residual threshold, or after the maximum number of sweeps.
As in Bullet, a row along which nothing can move changes by 0/0, and hides the changes of the rows before it.
"""

import warp as wp

from carom.kernels.dynamics.actuators import actuator_row, keep_actuator_force
from carom.kernels.dynamics.feedback import gather_constraint_forces
from carom.kernels.dynamics.friction import friction_row
from carom.kernels.dynamics.limits import limit_rows, spherical_limit_rows
from carom.kernels.dynamics.motors import motor_row, spherical_motor_rows
from carom.kernels.dynamics.quarantine import report_fault
from carom.kernels.dynamics.rows import row_dof
from carom.kernels.maths.min_max import within_bounds
from carom.kernels.structs import ConstraintRows, Model, Scratch, Settings, State
from carom.kernels.types import Int32, RealRows, Vector4, Vector4Rows, func, real
from carom.layouts.codes import (
    ACTUATOR,
    FRICTION,
    LIMIT,
    MOTOR,
    MOTOR_MAX_IMPULSE,
    SPHERICAL_LIMIT,
    SPHERICAL_MOTOR,
)


@func
def is_constrained(model: Model, state: State, world: Int32, root: Int32) -> bool:
    """Whether some motor or limit of a batch of trees may be active in this substep."""
    constraint = model.tree[root].first_constraint
    end = constraint + model.tree[root].batch_constraints
    while constraint < end:
        link = model.constraint[constraint].link
        kind = model.constraint[constraint].kind
        if kind == MOTOR:
            if state.dof_motor[world, model.link[link].first_dof][MOTOR_MAX_IMPULSE] != 0.0:
                return True
        elif kind == LIMIT:
            position = state.position[world, model.link[link].first_position]
            margin = model.constraint_margin[world, constraint]
            if (
                position <= model.constraint_lower[world, constraint] + margin
                or position >= model.constraint_upper[world, constraint] - margin
            ):
                return True
        else:
            return True
        constraint += 1
    return False


@func
def joint_constraint_rows(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    constraint: Int32,
    row: Int32,
) -> Int32:
    """Write the rows of a motor, a limit or friction, if it is active; returns the next free row."""
    kind = model.constraint[constraint].kind
    if kind == MOTOR:
        row = motor_row(model, settings, state, scratch, world, constraint, row)
    elif kind == LIMIT:
        row = limit_rows(model, settings, state, scratch, world, constraint, row)
    elif kind == SPHERICAL_MOTOR:
        row = spherical_motor_rows(model, settings, state, scratch, world, constraint, row)
    elif kind == SPHERICAL_LIMIT:
        row = spherical_limit_rows(model, settings, state, scratch, world, constraint, row)
    elif kind == FRICTION:
        row = friction_row(model, settings, state, scratch, world, constraint, row)
    elif kind == ACTUATOR:
        row = actuator_row(model, settings, state, scratch, world, constraint, row)
    return row


@wp.func_native("""
    auto* rows = &wp::index(row, world, 0);
    auto* delta = &wp::index(delta_velocity, world, 0);
    const auto* responses = &wp::index(response, world, 0);
    auto residual = largest_before;
    wp::float64 rate = delta[rows[first].entry / 4][rows[first].entry % 4];
    for (int i = first, left = count; left > 0; --left) {
        auto& own = rows[i];
        const auto before = own.impulse;
        auto change = own.change - rate;
        if (own.soft != 0)
            change = change * wp::index(share, world, i) - wp::index(softness, world, i) * before;
        // An impulse at its only possible value stays there, whatever products round to.
        const auto is_settled = before == own.lower && before == own.upper;
        if (is_settled)
            change = wp::where(is_settled, 0.0, change);
        i += stride;
        auto after = before + change * own.effective_mass;
        if (after < own.lower || after > own.upper) {
            // In a lane of several, whether this holds there. For one world nothing has to be chosen.
            const auto is_out = after < own.lower || after > own.upper;
            // A negative greatest force exchanges the bounds: as in Bullet, the lower comes first.
            const auto bounded = wp::where(after < own.lower, own.lower, own.upper);
            const auto moves = own.effective_mass != 0.0;
            const auto bounded_change = wp::where(moves, (bounded - before) / own.effective_mass, 0.0);
            change = wp::where(is_out, bounded_change, change);
            after = wp::where(is_out, wp::where(moves, before + change * own.effective_mass, bounded), after);
        }
        // As in Bullet, a row along which nothing can move changes by 0/0, or infinity where it is clamped.
        auto shown = change;
        if (own.effective_mass == 0.0)
            shown = wp::where(own.effective_mass == 0.0, (after - before) / 0.0, change);
        const auto square = shown * shown;
        residual = wp::where(residual > square, residual, square);
        own.impulse = after;
        const auto* x = responses + own.response;
        auto* y = delta + own.delta;
        if (left > 1) {
            const int entry = rows[i].entry;
            const int place = entry - 4 * own.delta;
            rate = delta[entry / 4][entry % 4];
            if (place >= 0 && place < 4 * own.blocks)
                rate += change * x[place / 4][place % 4];
        }
        #pragma clang loop vectorize(disable)
        for (int block = 0; block < own.blocks; ++block)
            y[block] = wp::add(y[block], wp::mul(change, x[block]));
    }
    return residual;
""")
def relax_rows(
    row: ConstraintRows,
    share: RealRows,
    softness: RealRows,
    delta_velocity: Vector4Rows,
    response: Vector4Rows,
    world: Int32,
    first: Int32,
    count: Int32,
    stride: Int32,
    largest_before: real,
) -> real:
    """Relax `count` rows within their bounds, at least one: `first`, `first + stride`...

    `largest_before` is what this function or another returned of the rows before these in the same sweep.

    Each row depends on the row before only through one entry of the delta velocities. It is computed first,
    so that the next row need not wait for the vectors; and clamping is a branch that is seldom taken.

    Returns:
        The maximum change of a row's velocity, squared, of these rows and those before; NaN after a row along
        which nothing can move, which also hides what all rows before it have changed (`later_maximum`).
    """
    ...


@func
def row_sweep(settings: Settings, scratch: Scratch, world: Int32, count: Int32, sweep: Int32) -> real:
    """Relax all `count` rows `inner_iterations` times; returns as `relax_rows`, for the last time."""
    first = Int32(0)
    stride = Int32(1)
    if sweep % 2 == 0:
        first = count - 1
        stride = Int32(-1)
    residual = real(0.0)
    inner = Int32(0)
    while inner < settings.inner_iterations:
        residual = relax_rows(
            scratch.row, scratch.row_share, scratch.row_softness, scratch.delta_velocity,
            scratch.block_response, world, first, count, stride, real(0.0),
        )  # fmt: skip
        inner += 1
        if residual == 0.0 and count_stuck_rows(scratch, world, count) == 0:
            # No row has changed, so further inner sweeps would not change any.
            inner = settings.inner_iterations
    return residual


@func
def count_stuck_rows(scratch: Scratch, world: Int32, count: Int32) -> Int32:
    """Along how many of the first `count` rows nothing can move, which hides changes of those before."""
    stuck = Int32(0)
    for row in range(count):
        if scratch.row[world, row].effective_mass == 0.0:
            stuck += 1
    return stuck


@func
def solve_joints(model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, root: Int32):
    """Solve the rows of one batch of trees; leaves the result in `delta_velocity`."""
    state.tree_island[world, root] = model.tree[root].batch
    count = Int32(0)
    constraint = model.tree[root].first_constraint
    end = constraint + model.tree[root].batch_constraints
    while constraint < end:
        count = joint_constraint_rows(model, settings, state, scratch, world, constraint, count)
        constraint += 1

    residual = real(0.0)
    sweep = Int32(0)
    searching = count > 0 and settings.iterations > 0
    while searching:
        residual = row_sweep(settings, scratch, world, count, sweep)
        sweep += 1
        # NaN, after rows along which nothing can move, is not below the threshold.
        searching = not residual <= settings.residual_threshold and sweep < settings.iterations
    keep_row_results(model, settings, state, scratch, world, root, count, sweep, residual)


@func
def keep_row_results(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    root: Int32,
    count: Int32,
    sweeps: Int32,
    residual: real,
):
    """Store number of sweeps and residual, motor impulses, and constraint forces of `count` rows."""
    state.tree_iterations[world, root] = sweeps
    state.tree_residual[world, root] = residual
    for row in range(count):
        keep_motor_impulse(model, settings, state, scratch, world, row)
    gather_constraint_forces(model, settings, state, scratch, world, 0, count)


@func
def keep_motor_impulse(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, row: Int32
):
    """Store the impulse of a row in the state if it is a motor's, or the force if it is an actuator's."""
    kind = model.constraint[scratch.row[world, row].constraint].kind
    if kind == MOTOR or kind == SPHERICAL_MOTOR:
        state.dof_motor_impulse[world, row_dof(model, scratch, world, row)] = scratch.row[world, row].impulse
    elif kind == ACTUATOR:
        keep_actuator_force(model, settings, state, scratch, world, row)


@func
def clear_delta_velocities(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Set the delta velocities of a tree to zero.

    Every tree has at least two blocks, enough for a free base: manifold blocks read two for any tree.
    """
    first = model.tree[tree].first_delta
    for block in range(first, first + wp.max((model.tree[tree].dof_count + 3) // 4, 2)):
        scratch.delta_velocity[world, block] = Vector4(0.0, 0.0, 0.0, 0.0)


@func
def apply_delta_velocities(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Add the delta velocities to the velocities of a tree."""
    bound = model.tree_max_velocity[world, tree]
    first = model.tree[tree].first_dof
    delta = model.tree[tree].first_delta
    total = real(0.0)
    for i in range(model.tree[tree].dof_count):
        velocity = state.dof_velocity[world, first + i] + scratch.entry_delta_velocity[world, 4 * delta + i]
        state.dof_velocity[world, first + i] = within_bounds(velocity, -bound, bound)
        total += velocity
    report_fault(state, world, tree, total)
