"""Projected Gauss-Seidel on the constraint rows of one island.

The rows are visited last to first in even sweeps and first to last in odd ones; the sweeps end when
no row changed its velocity by more than the residual threshold, or after the given number.
"""

import warp as wp

from carom.model.codes import LIMIT, MOTOR, SPHERICAL_MOTOR
from carom.model.real import Int32, Vector4, func, real
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.feedback import gather_constraint_forces
from carom.physics.limits import limit_rows, spherical_limit_rows
from carom.physics.motors import motor_row, spherical_motor_rows


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
def relax_row(model: Model, scratch: Scratch, world: Int32, row: Int32) -> real:
    """Bring one row to its target as far as its bounds allow; returns the change of its velocity."""
    inverse_diagonal = scratch.row_inverse_diagonal[world, row]
    if inverse_diagonal == 0.0:
        return 0.0
    tree = scratch.row_tree[world, row]
    dof = scratch.row_dof[world, row]
    sign = scratch.row_sign[world, row]
    blocks = (model.tree_dof_count[tree] + 3) // 4
    delta = model.tree_first_delta[tree]

    missing = scratch.row_target[world, row] - sign * scratch.delta_velocity[world, delta + dof // 4][dof % 4]
    before = scratch.row_impulse[world, row]
    after = wp.clamp(
        before + missing * inverse_diagonal, scratch.row_lower[world, row], scratch.row_upper[world, row]
    )
    change = after - before
    scratch.row_impulse[world, row] = after

    response = model.tree_first_block[tree] + dof * blocks
    push = sign * change
    for block in range(blocks):
        scratch.delta_velocity[world, delta + block] += push * scratch.block_inverse_mass[world, response + block]
    return change / inverse_diagonal


@func
def solve_island(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, island: Int32
):
    """Solve the rows of one island; leaves the change of velocity in `delta_velocity`."""
    first = model.island_first_constraint[island] * 3
    last = island_rows(model, settings, state, scratch, world, island)
    count = last - first
    residual = real(0.0)
    sweep = int(0)
    searching = int(count > 0)
    while searching == 1:
        residual = real(0.0)
        for _inner in range(settings.inner_iterations):
            residual = real(0.0)
            for i in range(count):
                row = first + i
                if sweep % 2 == 0:
                    row = last - 1 - i
                change = relax_row(model, scratch, world, row)
                residual = wp.max(residual, change * change)
        sweep += 1
        if residual <= settings.residual_threshold or sweep >= settings.iterations:
            searching = 0
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
        dof = model.tree_first_dof[scratch.row_tree[world, row]] + scratch.row_dof[world, row]
        state.dof_motor_impulse[world, dof] = scratch.row_impulse[world, row]


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
    for i in range(model.tree_dof_count[tree]):
        velocity = state.dof_velocity[world, first + i] + scratch.delta_velocity[world, delta + i // 4][i % 4]
        state.dof_velocity[world, first + i] = wp.clamp(velocity, -bound, bound)
