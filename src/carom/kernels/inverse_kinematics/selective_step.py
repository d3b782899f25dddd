"""Selectively damped least squares: each singular direction of the Jacobian has its own damping.

After Buss and Kim, "Selectively damped least squares for inverse kinematics" (2005): by the singular value
decomposition of the Jacobian, a step has one part for each singular vector. The bound of a part depends on
the ratio of the motion of the ends to the sum of the motions that the single joints cause.
"""

import warp as wp

from carom.kernels.inverse_kinematics.steps import MAX_STEP, limit_step
from carom.kernels.structs import Chain, ChainSizes, Search
from carom.kernels.types import Int32, Vector3, func, real

_MAX_SWEEPS = wp.constant(30)
_NEGLIGIBLE = real(1e-20)


@func
def diagonalise_rows(search: Search, rows: Int32):
    """Diagonalise `spectrum_matrix` by Jacobi rotations; eigenvectors are columns of `spectrum_vectors`."""
    a = search.spectrum_matrix
    sweep = Int32(0)
    while sweep < _MAX_SWEEPS:
        off, trace = real(0.0), real(0.0)
        for i in range(rows):
            trace += a[i * rows + i]
            for k in range(i):
                off += a[i * rows + k] * a[i * rows + k]
        if off <= _NEGLIGIBLE * trace * trace:
            sweep = _MAX_SWEEPS
        else:
            for p in range(rows):
                for q in range(p + 1, rows):
                    rotate_rows(search, rows, p, q)
            sweep += 1


@func
def rotate_rows(search: Search, rows: Int32, p: Int32, q: Int32):
    """Apply the Jacobi rotation that makes the entries (p, q) and (q, p) zero."""
    a = search.spectrum_matrix
    v = search.spectrum_vectors
    entry = a[p * rows + q]
    if entry == 0.0:
        return
    theta = (a[q * rows + q] - a[p * rows + p]) / (2.0 * entry)
    tangent = 1.0 / (wp.abs(theta) + wp.sqrt(theta * theta + 1.0))
    if theta < 0.0:
        tangent = -tangent
    cosine = 1.0 / wp.sqrt(tangent * tangent + 1.0)
    sine = tangent * cosine
    for k in range(rows):
        kp = a[k * rows + p]
        kq = a[k * rows + q]
        a[k * rows + p] = cosine * kp - sine * kq
        a[k * rows + q] = sine * kp + cosine * kq
    for k in range(rows):
        pk = a[p * rows + k]
        qk = a[q * rows + k]
        a[p * rows + k] = cosine * pk - sine * qk
        a[q * rows + k] = sine * pk + cosine * qk
        kp = v[k * rows + p]
        kq = v[k * rows + q]
        v[k * rows + p] = cosine * kp - sine * kq
        v[k * rows + q] = sine * kp + cosine * kq


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
    diagonalise_rows(search, rows)
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
