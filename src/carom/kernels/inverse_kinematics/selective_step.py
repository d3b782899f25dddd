"""Selectively damped least squares: each singular direction of the Jacobian has its own damping.

After Buss and Kim, "Selectively damped least squares for inverse kinematics" (2005): by the singular value
decomposition of the Jacobian, a step has one part for each singular vector. The bound of a part depends on
the ratio of the motion of the ends to the sum of the motions that the single joints cause.
"""

import warp as wp

from carom.kernels.inverse_kinematics.steps import MAX_STEP, limit_step
from carom.kernels.maths.jacobi import diagonalise
from carom.kernels.structs import Chain, ChainSizes, Search
from carom.kernels.types import Int32, Vector3, func, real

_NEGLIGIBLE = real(1e-20)


@func
def fill_spectrum(sizes: ChainSizes, search: Search, blocks: Int32):
    """Set `spectrum_matrix` to J Jᵀ, and `spectrum_vectors` to the identity."""
    rows = 3 * blocks
    a = search.spectrum_matrix
    v = search.spectrum_vectors
    for i in range(rows):
        for k in range(rows):
            total = real(0.0)
            for column in range(sizes.columns):
                first = column * blocks
                total += (
                    search.entry_jacobian[first + i // 3][i % 3]
                    * search.entry_jacobian[first + k // 3][k % 3]
                )
            a[i * rows + k] = total
            v[i * rows + k] = real(0.0)
        v[i * rows + i] = real(1.0)


@func
def selective_step(sizes: ChainSizes, chain: Chain, search: Search, blocks: Int32) -> real:
    """Selectively damped step of all dofs; returns its largest component."""
    rows = 3 * blocks
    a = search.spectrum_matrix
    fill_spectrum(sizes, search, blocks)
    diagonalise(search.spectrum_matrix, search.spectrum_vectors, rows)
    largest = real(0.0)
    for i in range(rows):
        largest = wp.max(largest, a[i * rows + i])
    for column in range(sizes.columns):
        search.dof[chain.column[column].dof].step = real(0.0)
    for i in range(rows):
        if a[i * rows + i] > 1.0e-12 * largest:
            add_direction(sizes, chain, search, blocks, i)
    return limit_step(sizes, search)


@func
def direction_block(search: Search, blocks: Int32, block: Int32, direction: Int32) -> Vector3:
    """The three entries of an eigenvector that belong to a block of the errors."""
    rows = 3 * blocks
    first = 3 * block * rows + direction
    v = search.spectrum_vectors
    return Vector3(v[first], v[first + rows], v[first + 2 * rows])


@func
def add_direction(sizes: ChainSizes, chain: Chain, search: Search, blocks: Int32, direction: Int32):
    """Add the part of the step along one singular vector."""
    singular = wp.sqrt(search.spectrum_matrix[direction * 3 * blocks + direction])
    along, end_motion = real(0.0), real(0.0)
    for block in range(blocks):
        part = direction_block(search, blocks, block, direction)
        along += wp.dot(part, search.block_error[block])
        end_motion += wp.length(part)
    joint_motion, greatest = real(0.0), real(0.0)
    for column in range(sizes.columns):
        share = wp.abs(direction_share(search, blocks, column, direction) / singular)
        max_distance = real(0.0)
        for block in range(blocks):
            max_distance += wp.length(search.entry_jacobian[column * blocks + block])
        joint_motion += share * max_distance
        greatest = wp.max(greatest, share)
    bound = MAX_STEP * wp.min(real(1.0), end_motion * singular / wp.max(joint_motion, _NEGLIGIBLE))
    factor = along / singular
    if wp.abs(factor) * greatest > bound:
        factor *= bound / (wp.abs(factor) * greatest)
    for column in range(sizes.columns):
        share = direction_share(search, blocks, column, direction) / singular
        search.dof[chain.column[column].dof].step += factor * share


@func
def direction_share(search: Search, blocks: Int32, column: Int32, direction: Int32) -> real:
    """Singular value times the entry of a column in the right singular vector."""
    total = real(0.0)
    for block in range(blocks):
        part = direction_block(search, blocks, block, direction)
        total += wp.dot(search.entry_jacobian[column * blocks + block], part)
    return total
