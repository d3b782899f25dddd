"""Damped steps of the joints towards targets that may be far away, or near singular poses.

A step is W Jᵀ y, where y solves (J W Jᵀ + μ) y = e, with Jacobian J, errors e, weights W and damping μ. It is
the smallest step, in the norm of the weights, that moves the ends part of the way to their targets; the
smaller the damping, the farther.
"""

import math

import warp as wp

from carom.kernels.structs import Chain, ChainSizes, Search
from carom.kernels.types import Int32, Matrix3, Reals, Vector3, func, real

# No joint turns by more than this in one step.
MAX_STEP = real(math.pi / 4.0)
# PyBullet's values: gains towards rest poses and back into the limits, and the damping of null-space steps.
_REST_GAIN = real(0.001)
_LIMIT_GAIN = real(10.0)
_NULL_SPACE_DAMPING = real(0.36)


@func
def jacobian_times(search: Search, blocks: Int32, column: Int32, factor: real):
    """Subtract from `block_solution` a column of the Jacobian times a factor."""
    for block in range(blocks):
        search.block_solution[block] -= search.entry_jacobian[column * blocks + block] * factor


@func
def response(search: Search, blocks: Int32, column: Int32) -> real:
    """One entry of the transposed Jacobian times `block_solution`."""
    # Most searches are for the position of one end.
    if blocks == 1:
        return wp.dot(search.entry_jacobian[column], search.block_solution[0])
    entry = column * blocks
    total = wp.dot(search.entry_jacobian[entry], search.block_solution[0]) + wp.dot(
        search.entry_jacobian[entry + 1], search.block_solution[1]
    )
    for block in range(2, blocks):
        total += wp.dot(search.entry_jacobian[entry + block], search.block_solution[block])
    return total


@func
def start_from_errors(search: Search, blocks: Int32):
    """Set `block_solution` to the errors."""
    for block in range(blocks):
        search.block_solution[block] = search.block_error[block]


@func
def weighted_product(sizes: ChainSizes, search: Search, blocks: Int32, i: Int32, k: Int32) -> Matrix3:
    """The block (i, k) of J W Jᵀ, without the columns that are held."""
    total = Matrix3()
    for column in range(sizes.columns):
        if search.column[column].held == 0:
            weighted = search.column[column].weight * search.entry_jacobian[column * blocks + i]
            total += wp.outer(weighted, search.entry_jacobian[column * blocks + k])
    return total


@func
def solve_for_points(sizes: ChainSizes, search: Search, damping: real):
    """`solve_blocks` for a single block."""
    a = wp.diag(Vector3(damping, damping, damping))
    for column in range(sizes.columns):
        if search.column[column].held == 0:
            first = search.entry_jacobian[column]
            a += wp.outer(search.column[column].weight * first, first)
    search.block_solution[0] = wp.inverse(a) * search.block_solution[0]


@func
def solve_for_pairs(sizes: ChainSizes, search: Search, damping: real):
    """`solve_blocks` for two blocks, in one pass over the columns."""
    a = wp.diag(Vector3(damping, damping, damping))
    b = Matrix3()
    c = wp.diag(Vector3(damping, damping, damping))
    for column in range(sizes.columns):
        if search.column[column].held == 0:
            weight = search.column[column].weight
            first = search.entry_jacobian[2 * column]
            second = search.entry_jacobian[2 * column + 1]
            weighted = weight * second
            a += wp.outer(weight * first, first)
            b += wp.outer(weighted, first)
            c += wp.outer(weighted, second)
    inverse = wp.inverse(a)
    ratio = b * inverse
    x = search.block_solution[0]
    y = wp.inverse(c - ratio * wp.transpose(b)) * (search.block_solution[1] - ratio * x)
    search.block_solution[0] = inverse * (x - wp.transpose(b) * y)
    search.block_solution[1] = y


@func
def solve_blocks(sizes: ChainSizes, search: Search, blocks: Int32, damping: real):
    """Multiply `block_solution` by (J W Jᵀ + damping)⁻¹, without the columns of J that are held."""
    if blocks == 1:
        solve_for_points(sizes, search, damping)
        return
    if blocks == 2:
        solve_for_pairs(sizes, search, damping)
        return
    a = search.square_matrix
    x = search.block_solution
    # Block LDLᵀ factorisation; the diagonal holds the inverse pivots.
    for i in range(blocks):
        pivot = weighted_product(sizes, search, blocks, i, i) + wp.diag(Vector3(damping, damping, damping))
        for k in range(i):
            entry = weighted_product(sizes, search, blocks, i, k)
            for before in range(k):
                entry -= a[i * blocks + before] * wp.transpose(a[k * blocks + before])
            a[i * blocks + k] = entry
        for k in range(i):
            entry = a[i * blocks + k]
            scaled = entry * a[k * blocks + k]
            a[i * blocks + k] = scaled
            pivot -= entry * wp.transpose(scaled)
        a[i * blocks + i] = wp.inverse(pivot)
    for i in range(blocks):
        for k in range(i):
            x[i] -= a[i * blocks + k] * x[k]
    for i in range(blocks):
        x[i] = a[i * blocks + i] * x[i]
    for back in range(blocks):
        i = blocks - 1 - back
        for k in range(i + 1, blocks):
            x[i] -= wp.transpose(a[k * blocks + i]) * x[k]


@func
def limit_step(sizes: ChainSizes, search: Search) -> real:
    """Scale a step down to the maximum rotation of a joint; returns the largest one before that."""
    greatest = real(0.0)
    for dof in range(sizes.dofs):
        greatest = wp.max(greatest, wp.abs(search.dof[dof].step))
    if greatest > MAX_STEP:
        for dof in range(sizes.dofs):
            search.dof[dof].step = search.dof[dof].step * (MAX_STEP / greatest)
    return greatest


@func
def damped_step(sizes: ChainSizes, chain: Chain, search: Search, blocks: Int32) -> real:
    """Damped least squares as in PyBullet, with a damping for each joint; returns the largest component."""
    start_from_errors(search, blocks)
    solve_blocks(sizes, search, blocks, real(1.0))
    for column in range(sizes.columns):
        search.dof[chain.column[column].dof].step = search.column[column].weight * response(
            search, blocks, column
        )
    return limit_step(sizes, search)


@func
def null_space_step(
    sizes: ChainSizes, chain: Chain, search: Search, coordinates: Reals, blocks: Int32
) -> real:
    """Null-space step as in PyBullet: towards rest poses, and back into limits, without moving the ends.

    Returns the step's largest component.
    """
    for dof in range(sizes.dofs):
        pull = real(0.0)
        coordinate = chain.dof_coordinate[dof]
        if coordinate >= 0:
            position = coordinates[coordinate]
            pull = _REST_GAIN * (search.dof[dof].rest - position)
            push = real(0.0)
            if position > search.dof[dof].upper:
                push += search.dof[dof].upper - position
            if position < search.dof[dof].lower:
                push += search.dof[dof].lower - position
            if push != 0.0 and search.dof[dof].range != 0.0:
                pull += _LIMIT_GAIN * push / search.dof[dof].range
        search.dof[dof].step = pull
    start_from_errors(search, blocks)
    for column in range(sizes.columns):
        jacobian_times(search, blocks, column, search.dof[chain.column[column].dof].step)
    solve_blocks(sizes, search, blocks, _NULL_SPACE_DAMPING)
    for column in range(sizes.columns):
        search.dof[chain.column[column].dof].step += response(search, blocks, column)
    return limit_step(sizes, search)


@func
def bounded_step(
    sizes: ChainSizes, chain: Chain, search: Search, coordinates: Reals, blocks: Int32, damping: real
):
    """A step that stays within the joint limits.

    Joints that it would move beyond a limit are held there, and the step is computed again for the others.
    """
    for column in range(sizes.columns):
        search.column[column].held = 0
    passes, settled = Int32(0), Int32(0)
    while settled == 0:
        start_from_errors(search, blocks)
        for column in range(sizes.columns):
            if search.column[column].held == 1:
                jacobian_times(search, blocks, column, search.dof[chain.column[column].dof].step)
        solve_blocks(sizes, search, blocks, damping)
        settled = Int32(1)
        for column in range(sizes.columns):
            if search.column[column].held == 0:
                dof = chain.column[column].dof
                step = search.column[column].weight * response(search, blocks, column)
                coordinate = chain.dof_coordinate[dof]
                if coordinate >= 0:
                    position = coordinates[coordinate]
                    within = wp.clamp(
                        step, search.dof[dof].lower - position, search.dof[dof].upper - position
                    )
                    if within != step:
                        step = within
                        search.column[column].held = 1
                        settled = Int32(0)
                search.dof[dof].step = step
        passes += 1
        if passes > sizes.columns:
            settled = Int32(1)
    limit_step(sizes, search)
