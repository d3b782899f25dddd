"""Steps of the joints towards targets that are out of reach of a linear step, or near singular poses.

A step solves (J W Jᵀ + μ) y = e for the rows and is W Jᵀ y: the least one, as the weights W measure
it, that takes the ends some way towards their targets, and the further the smaller the damping μ.
"""

import math

import warp as wp

from carom.algorithms.reach.structs import Chain, ChainSizes, Search
from carom.model.real import Int32, Reals, func, real

# No joint turns by more than this in one step.
MAX_STEP = real(math.pi / 4.0)
# Gains of the pull towards rest poses and of the push back into the limits, and the damping that goes
# with them: PyBullet's.
_REST_GAIN = real(0.001)
_LIMIT_GAIN = real(10.0)
_NULL_SPACE_DAMPING = real(0.36)


@func
def jacobian_times(search: Search, rows: Int32, column: Int32, factor: real):
    """Subtract from `row_solution` what a freedom does to the ends."""
    for row in range(rows):
        search.row_solution[row] -= search.entry_jacobian[column * rows + row] * factor


@func
def response(search: Search, rows: Int32, column: Int32) -> real:
    """One entry of the transposed Jacobian times `row_solution`."""
    total = real(0.0)
    for row in range(rows):
        total += search.entry_jacobian[column * rows + row] * search.row_solution[row]
    return total


@func
def solve_rows(sizes: ChainSizes, search: Search, rows: Int32, damping: real):
    """Replace `row_solution` by (J W Jᵀ + damping)⁻¹ times it, leaving out the columns that are held."""
    a = search.square_matrix
    for i in range(rows):
        for k in range(i):
            a[i * rows + k] = real(0.0)
        a[i * rows + i] = damping
    for column in range(sizes.columns):
        if search.column_held[column] == 0:
            first = column * rows
            weight = search.column_weight[column]
            for i in range(rows):
                scaled = weight * search.entry_jacobian[first + i]
                for k in range(i + 1):
                    a[i * rows + k] += scaled * search.entry_jacobian[first + k]
    # LDLᵀ in place; the diagonal holds the inverse pivots.
    for i in range(rows):
        for k in range(i):
            entry = a[i * rows + k]
            for before in range(k):
                entry -= a[i * rows + before] * a[k * rows + before]
            a[i * rows + k] = entry
        pivot = a[i * rows + i]
        for k in range(i):
            entry = a[i * rows + k]
            scaled = entry * a[k * rows + k]
            a[i * rows + k] = scaled
            pivot -= entry * scaled
        # No pivot is less than the damping, but for rounding.
        a[i * rows + i] = 1.0 / wp.max(pivot, damping)
    x = search.row_solution
    for i in range(rows):
        for k in range(i):
            x[i] -= a[i * rows + k] * x[k]
    for i in range(rows):
        x[i] = x[i] * a[i * rows + i]
    for back in range(rows):
        i = rows - 1 - back
        for k in range(i + 1, rows):
            x[i] -= a[k * rows + i] * x[k]


@func
def limit_step(sizes: ChainSizes, search: Search) -> real:
    """Shorten a step in which a joint moves too far; returns how far the farthest wanted to."""
    greatest = real(0.0)
    for dof in range(sizes.dofs):
        greatest = wp.max(greatest, wp.abs(search.dof_step[dof]))
    if greatest > MAX_STEP:
        for dof in range(sizes.dofs):
            search.dof_step[dof] = search.dof_step[dof] * (MAX_STEP / greatest)
    return greatest


@func
def damped_step(sizes: ChainSizes, chain: Chain, search: Search, rows: Int32) -> real:
    """PyBullet's step: every joint as unwilling to move as its damping says. Returns its greatest part."""
    for row in range(rows):
        search.row_solution[row] = search.row_error[row]
    solve_rows(sizes, search, rows, real(1.0))
    for column in range(sizes.columns):
        search.dof_step[chain.column_dof[column]] = search.column_weight[column] * response(
            search, rows, column
        )
    return limit_step(sizes, search)


@func
def null_space_step(sizes: ChainSizes, chain: Chain, search: Search, coordinates: Reals, rows: Int32) -> real:
    """PyBullet's step with a pull towards rest poses, and back into limits, that spares the ends.

    Returns its greatest part.
    """
    for dof in range(sizes.dofs):
        pull = real(0.0)
        coordinate = chain.dof_coordinate[dof]
        if coordinate >= 0:
            position = coordinates[coordinate]
            pull = _REST_GAIN * (search.dof_rest[dof] - position)
            push = real(0.0)
            if position > search.dof_upper[dof]:
                push += search.dof_upper[dof] - position
            if position < search.dof_lower[dof]:
                push += search.dof_lower[dof] - position
            if push != 0.0 and search.dof_range[dof] != 0.0:
                pull += _LIMIT_GAIN * push / search.dof_range[dof]
        search.dof_step[dof] = pull
    for row in range(rows):
        search.row_solution[row] = search.row_error[row]
    for column in range(sizes.columns):
        jacobian_times(search, rows, column, search.dof_step[chain.column_dof[column]])
    solve_rows(sizes, search, rows, _NULL_SPACE_DAMPING)
    for column in range(sizes.columns):
        search.dof_step[chain.column_dof[column]] += response(search, rows, column)
    return limit_step(sizes, search)


@func
def bounded_step(
    sizes: ChainSizes, chain: Chain, search: Search, coordinates: Reals, rows: Int32, damping: real
):
    """A step that keeps within the limits.

    Joints that it would take beyond a limit are held there, and the others do their share.
    """
    for column in range(sizes.columns):
        search.column_held[column] = 0
    passes = Int32(0)
    settled = Int32(0)
    while settled == 0:
        for row in range(rows):
            search.row_solution[row] = search.row_error[row]
        for column in range(sizes.columns):
            if search.column_held[column] == 1:
                jacobian_times(search, rows, column, search.dof_step[chain.column_dof[column]])
        solve_rows(sizes, search, rows, damping)
        settled = Int32(1)
        for column in range(sizes.columns):
            if search.column_held[column] == 0:
                dof = chain.column_dof[column]
                step = search.column_weight[column] * response(search, rows, column)
                coordinate = chain.dof_coordinate[dof]
                if coordinate >= 0:
                    position = coordinates[coordinate]
                    within = wp.clamp(
                        step, search.dof_lower[dof] - position, search.dof_upper[dof] - position
                    )
                    if within != step:
                        step = within
                        search.column_held[column] = 1
                        settled = Int32(0)
                search.dof_step[dof] = step
        passes += 1
        if passes > sizes.columns:
            settled = Int32(1)
    limit_step(sizes, search)
