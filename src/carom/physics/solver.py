"""Projected Gauss-Seidel on the constraint rows of one island.

The rows are visited last to first in even sweeps and first to last in odd ones; the sweeps end when
no row changed its velocity by more than the residual threshold, or after the given number.
"""

import warp as wp

from carom.model.codes import (
    LIMIT,
    MOTOR,
    PLACE_BLOCKS,
    PLACE_DELTA,
    PLACE_ENTRY,
    PLACE_RESPONSE,
    ROW_EFFECTIVE_MASS,
    ROW_IMPULSE,
    ROW_INVERSE_MASS,
    ROW_LOWER,
    ROW_SHARE,
    ROW_UPPER,
    SPHERICAL_MOTOR,
)
from carom.model.real import Int32, Vector4, func, real
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.feedback import gather_constraint_forces
from carom.physics.limits import limit_rows, spherical_limit_rows
from carom.physics.motors import motor_row, spherical_motor_rows
from carom.physics.quarantine import report_fault
from carom.physics.rows import row_dof


@func
def island_rows(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, island: Int32
) -> Int32:
    """Write the rows of an island's active constraints; returns one past the last row."""
    first = model.island_first_constraint[island]
    row = first * 3
    for constraint in range(first, first + model.island_constraint_count[island]):
        kind = model.constraint_kind[constraint]
        if kind == MOTOR:
            row = motor_row(model, settings, state, scratch, world, constraint, row)
        elif kind == LIMIT:
            row = limit_rows(model, settings, state, scratch, world, constraint, row)
        elif kind == SPHERICAL_MOTOR:
            row = spherical_motor_rows(model, settings, state, scratch, world, constraint, row)
        else:
            row = spherical_limit_rows(model, settings, state, scratch, world, constraint, row)
    return row


@func
def relax_row(scratch: Scratch, world: Int32, row: Int32) -> real:
    """Bring one row to its target as far as its bounds allow; returns the change of its velocity."""
    terms = scratch.row_terms[world, row]
    place = scratch.row_place[world, row]
    before = terms[ROW_IMPULSE]
    # The order of operations keeps the chain from one row to the next short.
    already = scratch.entry_delta_velocity[world, place[PLACE_ENTRY]] * terms[ROW_EFFECTIVE_MASS]
    after = (before + terms[ROW_SHARE]) - already
    if after < terms[ROW_LOWER]:
        after = terms[ROW_LOWER]
    if after > terms[ROW_UPPER]:
        after = terms[ROW_UPPER]
    change = after - before
    scratch.row_terms[world, row][ROW_IMPULSE] = after

    delta = place[PLACE_DELTA]
    response = place[PLACE_RESPONSE]
    end = delta + place[PLACE_BLOCKS]
    while delta < end:
        scratch.delta_velocity[world, delta] += change * scratch.block_inverse_mass[world, response]
        delta += 1
        response += 1
    return change * terms[ROW_INVERSE_MASS]


@func
def solve_island(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, island: Int32
):
    """Solve the rows of one island; leaves the change of velocity in `delta_velocity`."""
    first = model.island_first_constraint[island] * 3
    last = island_rows(model, settings, state, scratch, world, island)
    count = last - first
    residual = real(0.0)
    sweep = Int32(0)
    searching = Int32(0)
    if count > 0:
        searching = Int32(1)
    while searching == 1:
        residual = real(0.0)
        for _inner in range(settings.inner_iterations):
            residual = real(0.0)
            for i in range(count):
                row = first + i
                if sweep % 2 == 0:
                    row = last - 1 - i
                change = relax_row(scratch, world, row)
                if change * change > residual:
                    residual = change * change
        sweep += 1
        if residual <= settings.residual_threshold or sweep >= settings.iterations:
            searching = Int32(0)
    state.island_iterations[world, island] = sweep
    state.island_residual[world, island] = residual

    for row in range(first, last):
        keep_motor_impulse(model, state, scratch, world, row)
    gather_constraint_forces(model, settings, scratch, world, first, last)


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
