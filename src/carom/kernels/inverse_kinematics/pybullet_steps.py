"""Errors and steps of the iteration of `calculateInverseKinematics` as PyBullet computes them.

They differ from those of `kinematics` and `steps`, which are more exact, in what shows in PyBullet's answers:
rotation errors are rounded to single precision, a step solves the normal equations with any damping that is
given, and null-space steps leave out directions in which J Jᵀ is small beside its largest eigenvalue.
"""

import math

import warp as wp

from carom.kernels.inverse_kinematics.kinematics import end_position
from carom.kernels.inverse_kinematics.selective_step import direction_block, fill_spectrum
from carom.kernels.inverse_kinematics.steps import (
    jacobian_times,
    limit_step,
    response,
    solve_blocks,
    start_from_errors,
)
from carom.kernels.maths.jacobi import diagonalise, rotate_all
from carom.kernels.structs import Chain, ChainSizes, Search
from carom.kernels.types import Int32, Quaternion, Reals, Vector3, func, real

_PI = real(math.pi)
# A rotation whose quaternion has a vector part with a smaller square has the x axis for its axis.
_NO_AXIS = real(10.0 * 2.0**-52)
_REST_GAIN = real(0.001)
_LIMIT_GAIN = real(10.0)
_NULL_SPACE_DAMPING = real(0.36)
# The projection into the null space knows only eigenvalues above this share of the largest.
_KNOWN_SHARE = real(0.01)
# A pivot below this share of the largest entry of the diagonal is rounding: its joint does not move.
_NO_PIVOT = real(1e-14)


@func
def signed_like_matrix(q: Quaternion) -> Quaternion:
    """A quaternion with the sign that conversion from a rotation matrix gives.

    Its largest component is positive, as far as the diagonal of the matrix shows which that is; w, if the
    trace is positive.
    """
    scale = 2.0 / wp.dot(q, q)
    xx, yy, zz = q[0] * (q[0] * scale), q[1] * (q[1] * scale), q[2] * (q[2] * scale)
    first, second, third = 1.0 - (yy + zz), 1.0 - (xx + zz), 1.0 - (xx + yy)
    leading = q[3]
    if first + second + third <= 0.0:
        leading = q[1] if first < second else q[0]
        if wp.max(first, second) < third:
            leading = q[2]
    return -q if leading < 0.0 else q


@func
def turn_between(start: Quaternion, target: Quaternion) -> Vector3:
    """Rotation vector from one orientation to another, its angle rounded to single precision twice."""
    change = target * wp.quat_inverse(start)
    angle = wp.float32(2.0 * wp.acos(wp.clamp(change[3], real(-1.0), real(1.0))))
    if real(angle) > _PI:
        angle = wp.float32(real(angle) - 2.0 * _PI)
    axis = Vector3(1.0, 0.0, 0.0)
    if 1.0 - change[3] * change[3] >= _NO_AXIS:
        axis = wp.normalize(Vector3(change[0], change[1], change[2]))
    return axis * real(angle)


@func
def measure_as_pybullet(sizes: ChainSizes, chain: Chain, search: Search, oriented: Int32) -> real:
    """Fill `block_error` with the ways to the targets; returns the largest distance [m]."""
    distance = real(0.0)
    stride = 1 + oriented
    for end in range(sizes.ends):
        way = search.end_target_position[end] - end_position(chain, search, end)
        search.block_error[end * stride] = way
        distance = wp.max(distance, wp.length(way))
        if oriented == 1:
            rotation = chain.end_turn[end]
            joint = chain.end_joint[end]
            if joint >= 0:
                rotation = search.joint[joint].rotation * rotation
            search.block_error[end * stride + 1] = turn_between(
                signed_like_matrix(rotation), signed_like_matrix(search.end_target_rotation[end])
            )
    return distance


@func
def eliminate(a: Reals, count: Int32):
    """Solve the linear equations of the `count` rows of `a`, whose last column is the right side.

    Gaussian elimination with the largest entry of a column as its pivot; the solution is in the last column.
    The unknown of a pivot that is mere rounding is 0.
    """
    width = count + 1
    largest = real(0.0)
    for i in range(count):
        largest = wp.max(largest, wp.abs(a[i * width + i]))
    negligible = _NO_PIVOT * largest
    for i in range(count):
        best = i
        for row in range(i + 1, count):
            if wp.abs(a[row * width + i]) > wp.abs(a[best * width + i]):
                best = row
        if best != i:
            for k in range(i, width):
                kept = a[i * width + k]
                a[i * width + k] = a[best * width + k]
                a[best * width + k] = kept
        pivot = a[i * width + i]
        if wp.abs(pivot) > negligible:
            for row in range(i + 1, count):
                share = a[row * width + i] / pivot
                for k in range(i + 1, width):
                    a[row * width + k] -= a[i * width + k] * share
    for back in range(count):
        i = count - 1 - back
        total = a[i * width + count]
        for k in range(i + 1, count):
            total -= a[i * width + k] * a[k * width + count]
        pivot = a[i * width + i]
        a[i * width + count] = total / pivot if wp.abs(pivot) > negligible else real(0.0)


@func
def normal_step(sizes: ChainSizes, chain: Chain, search: Search, blocks: Int32):
    """Step of the dofs by (JᵀJ + damping) step = Jᵀ errors."""
    count = sizes.columns
    width = count + 1
    a = search.normal_matrix
    for i in range(count):
        side = real(0.0)
        for block in range(blocks):
            side += wp.dot(search.entry_jacobian[i * blocks + block], search.block_error[block])
        a[i * width + count] = side
        for k in range(i + 1):
            total = real(0.0)
            for block in range(blocks):
                total += wp.dot(
                    search.entry_jacobian[i * blocks + block], search.entry_jacobian[k * blocks + block]
                )
            a[i * width + k] = total
            a[k * width + i] = total
        a[i * width + i] += search.dof[chain.column[i].dof].damping
    eliminate(a, count)
    for i in range(count):
        search.dof[chain.column[i].dof].step = a[i * width + count]
    limit_step(sizes, search)


@func
def pull_of(position: real, lower: real, upper: real, span: real, rest: real) -> real:
    """Velocity of a joint towards its rest position, and back towards either limit that it is beyond."""
    pull = _REST_GAIN * (rest - position)
    # Without a range PyBullet divides by 0.
    if span != 0.0:
        if position > upper:
            pull += _LIMIT_GAIN * (upper - position) / span
        if position < lower:
            pull += _LIMIT_GAIN * (lower - position) / span
    return pull


@func
def project(sizes: ChainSizes, chain: Chain, search: Search, blocks: Int32):
    """Subtract from `block_solution` (J Jᵀ + damping)⁺ J pull, with the pull of the dofs in `dof.step`.

    Of the inverse only the directions of eigenvalues above `_KNOWN_SHARE` of the largest count.
    """
    fill_spectrum(sizes, search, blocks)
    rows = 3 * blocks
    diagonalise(search.spectrum_matrix, search.spectrum_vectors, rows)
    # Once more: eigenvectors converge after the entries beside the diagonal are small enough for steps.
    rotate_all(search.spectrum_matrix, search.spectrum_vectors, rows)
    largest = real(0.0)
    for i in range(rows):
        largest = wp.max(largest, search.spectrum_matrix[i * rows + i] + _NULL_SPACE_DAMPING)
    for i in range(rows):
        eigenvalue = search.spectrum_matrix[i * rows + i] + _NULL_SPACE_DAMPING
        if eigenvalue > _KNOWN_SHARE * largest:
            along = real(0.0)
            for column in range(sizes.columns):
                share = real(0.0)
                for block in range(blocks):
                    share += wp.dot(
                        search.entry_jacobian[column * blocks + block],
                        direction_block(search, blocks, block, i),
                    )
                along += share * search.dof[chain.column[column].dof].step
            for block in range(blocks):
                search.block_solution[block] -= direction_block(search, blocks, block, i) * (
                    along / eigenvalue
                )


@func
def rest_step(sizes: ChainSizes, chain: Chain, search: Search, coordinates: Reals, blocks: Int32):
    """Step of the dofs towards the targets, and towards rest positions where that does not move the ends."""
    for dof in range(sizes.dofs):
        search.dof[dof].step = pull_of(
            coordinates[chain.dof_coordinate[dof]],
            search.dof[dof].lower,
            search.dof[dof].upper,
            search.dof[dof].range,
            search.dof[dof].rest,
        )
    # The trace of J Jᵀ + damping, and so more than its largest eigenvalue.
    trace = 3.0 * _NULL_SPACE_DAMPING * real(blocks)
    for entry in range(sizes.columns * blocks):
        trace += wp.dot(search.entry_jacobian[entry], search.entry_jacobian[entry])
    start_from_errors(search, blocks)
    if _KNOWN_SHARE * trace < _NULL_SPACE_DAMPING:
        for column in range(sizes.columns):
            jacobian_times(search, blocks, column, search.dof[chain.column[column].dof].step)
        solve_blocks(sizes, search, blocks, _NULL_SPACE_DAMPING)
    else:
        solve_blocks(sizes, search, blocks, _NULL_SPACE_DAMPING)
        project(sizes, chain, search, blocks)
    for column in range(sizes.columns):
        search.dof[chain.column[column].dof].step += response(search, blocks, column)
    limit_step(sizes, search)
