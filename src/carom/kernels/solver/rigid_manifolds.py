"""Manifold blocks: up to four consecutive contacts of the same two trees, relaxed together.

The effect of each row of a manifold block on the velocities of the rows after it is computed beforehand, as a
Delassus matrix. So the velocities of all rows are computed at once, then the impulses row by row, and the
delta velocities of the trees are updated once per block. These are the same Gauss-Seidel steps as with
single rows, with fewer reads and writes of memory.

Entries beyond the last contact of a manifold block have effective mass 0. This module is for rigid bodies;
`articulated_manifolds` does the same for articulated bodies.
"""

from typing import Any

import warp as wp

from carom.kernels.maths.equal_steps import equal_steps
from carom.kernels.maths.min_max import INDEFINITE, later_maximum, maximum, within_bounds
from carom.kernels.structs import PairRows, Scratch, Settings
from carom.kernels.types import Int32, Matrix48, Vector4, Vector8, func, real, shared_func
from carom.layouts.codes import ISOTROPIC


@func
def body_change(scratch: Scratch, world: Int32, delta: Int32) -> Vector8:
    """Delta velocities of a rigid body so far."""
    first = scratch.delta_velocity[world, delta]
    second = scratch.delta_velocity[world, delta + 1]
    return Vector8(first[0], first[1], first[2], first[3], second[0], second[1], second[2], second[3])


@func
def add_change(scratch: Scratch, world: Int32, delta: Int32, change: Vector8):
    """Add a change to the delta velocities of a rigid body."""
    scratch.delta_velocity[world, delta] += Vector4(change[0], change[1], change[2], change[3])
    scratch.delta_velocity[world, delta + 1] += Vector4(change[4], change[5], change[6], change[7])


@func
def combination(rows: Any, factors: Vector8) -> Any:
    """Linear combination of the eight rows of a matrix."""
    return ((factors[0] * rows[0] + factors[1] * rows[1]) + (factors[2] * rows[2] + factors[3] * rows[3])) + (
        (factors[4] * rows[4] + factors[5] * rows[5]) + (factors[6] * rows[6] + factors[7] * rows[7])
    )


@func
def push_of_normals(response: Matrix48, impulse: Vector4) -> Vector8:
    """Change of velocities by impulses along the normals."""
    return (impulse[0] * response[0] + impulse[1] * response[1]) + (
        impulse[2] * response[2] + impulse[3] * response[3]
    )


@func
def push_manifold_block(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    manifold_block: Int32,
    normal: Vector4,
    friction: Vector8,
):
    """Apply impulses along the rows of a manifold block of rigid bodies."""
    place = pair_rows.manifold_block[world, manifold_block].place
    for body in range(2):
        side = 2 * manifold_block + body
        if place[2 * body + 1] > 0:
            moved = push_of_normals(pair_rows.side[world, side].normal_response, normal) + combination(
                pair_rows.side[world, side].friction_response, friction
            )
            add_change(scratch, world, place[2 * body], moved)


@func
def greatest_square(change: Vector4) -> real:
    """The largest square of the entries."""
    square = wp.cw_mul(change, change)
    return maximum(maximum(square[0], square[1]), maximum(square[2], square[3]))


@func
def normals_alone(pair_rows: PairRows, world: Int32, manifold_block: Int32) -> Vector4:
    """Changes of the normal impulses of a block without bounds, if nothing else had moved its bodies."""
    softness = pair_rows.manifold_block[world, manifold_block].normal_softness
    impulse = pair_rows.manifold_block[world, manifold_block].normal_impulse
    return pair_rows.manifold_block[world, manifold_block].normal_share - wp.cw_mul(softness, impulse)


@func
def friction_alone(pair_rows: PairRows, world: Int32, manifold_block: Int32) -> Vector8:
    """As `normals_alone`, of friction."""
    if pair_rows.manifold_block[world, manifold_block].yields == 0:
        return pair_rows.manifold_block[world, manifold_block].friction_share
    softness = pair_rows.manifold_block[world, manifold_block].friction_softness
    impulse = pair_rows.manifold_block[world, manifold_block].friction_impulse
    return pair_rows.manifold_block[world, manifold_block].friction_share - wp.cw_mul(softness, impulse)


@func
def bounded_normals(pair_rows: PairRows, world: Int32, manifold_block: Int32) -> Vector4:
    """Update the normal impulses of a block by the wanted changes, clamped to >= 0; returns the changes."""
    before = pair_rows.manifold_block[world, manifold_block].normal_impulse
    wanted = pair_rows.manifold_block[world, manifold_block].normal_wanted
    delassus = pair_rows.manifold_block[world, manifold_block].normal_delassus
    change = Vector4(0.0, 0.0, 0.0, 0.0)
    for i in range(4):
        change[i] = wanted[i]
        if change[i] < -before[i]:
            change[i] = -before[i]
        wanted -= change[i] * delassus[i]
    pair_rows.manifold_block[world, manifold_block].normal_impulse = before + change
    return change


@func
def residual_of_block(
    pair_rows: PairRows, world: Int32, manifold_block: Int32, change: Vector4, stuck: Int32, before: real
) -> real:
    """Residual of a sweep after a block, from the residual `before` and the changes of its rows' velocities.

    It is the maximum of their squares. As in Bullet, the change of a row along which nothing can move is 0/0,
    so the maximum is that of the rows after it, and NaN if none follows. Bit i of `stuck` says so of row i.
    """
    if stuck == 0:
        return later_maximum(before, greatest_square(change))
    residual = before + 0.0
    for i in range(pair_rows.manifold_block[world, manifold_block].count):
        square = change[i] * change[i] if (stuck >> i) & 1 == 0 else INDEFINITE
        residual = later_maximum(residual, square)
    return residual


@func
def normal_residual(
    pair_rows: PairRows, world: Int32, manifold_block: Int32, change: Vector4, before: real
) -> real:
    """Residual of a sweep after a change of normal impulses; see `residual_of_block`."""
    velocity = wp.cw_mul(change, pair_rows.manifold_block[world, manifold_block].normal_inverse_mass)
    stuck = pair_rows.manifold_block[world, manifold_block].stuck & 15
    return residual_of_block(pair_rows, world, manifold_block, velocity, stuck, before)


@shared_func
def scale_to_circle(square: real, bound: real) -> real:
    """Factor that scales impulses of squared length `square` to the circle of radius `bound`.

    It is not inlined, so that square root and quotient are not computed for impulses within the circle, as
    most are.
    """
    return 0.0 if bound == 0.0 else bound / wp.sqrt(square)


@func
def bounded_friction(settings: Settings, pair_rows: PairRows, world: Int32, manifold_block: Int32) -> Vector8:
    """Update the friction impulses of a block, within bounds by the normal impulses; returns the changes."""
    wanted = pair_rows.manifold_block[world, manifold_block].friction_wanted
    before = pair_rows.manifold_block[world, manifold_block].friction_impulse
    bounds = wp.cw_mul(
        pair_rows.manifold_block[world, manifold_block].friction,
        pair_rows.manifold_block[world, manifold_block].normal_impulse,
    )
    delassus = pair_rows.manifold_block[world, manifold_block].friction_delassus
    change = Vector8(0.0)
    for i in range(4):
        bound = bounds[i]
        first = before[2 * i] + wanted[2 * i]
        second = before[2 * i + 1] + wanted[2 * i + 1]
        change1 = wanted[2 * i]
        change2 = wanted[2 * i + 1]
        if settings.cone_friction == ISOTROPIC:
            inverse1 = pair_rows.manifold_block[world, manifold_block].friction_inverse_mass[2 * i]
            inverse2 = pair_rows.manifold_block[world, manifold_block].friction_inverse_mass[2 * i + 1]
            steps = equal_steps(inverse1, inverse2, delassus[2 * i, 2 * i + 1] * inverse2)
            change1 *= steps[0]
            change2 *= steps[1]
            first = before[2 * i] + change1
            second = before[2 * i + 1] + change2
        if settings.cone_friction != 0:
            square = first * first + second * second
            if square > bound * bound:
                scale = scale_to_circle(square, bound)
                change1 = first * scale - before[2 * i]
                change2 = second * scale - before[2 * i + 1]
        elif bound > 0.0:
            change1 = within_bounds(first, -bound, bound) - before[2 * i]
            second -= change1 * delassus[2 * i, 2 * i + 1]
            change2 = within_bounds(second, -bound, bound) - before[2 * i + 1]
        else:
            change1, change2 = real(0.0), real(0.0)
        change[2 * i] = change1
        change[2 * i + 1] = change2
        wanted -= change1 * delassus[2 * i] + change2 * delassus[2 * i + 1]
    pair_rows.manifold_block[world, manifold_block].friction_impulse = before + change
    return change


@func
def friction_residual(
    settings: Settings,
    pair_rows: PairRows,
    world: Int32,
    manifold_block: Int32,
    change: Vector8,
    before: real,
) -> real:
    """Residual of a sweep after a change of friction impulses; see `residual_of_block`.

    The change of a contact is the sum of those of its two rows; if friction is isotropic, their length, and
    rows along which nothing can move are left out.
    """
    velocity = wp.cw_mul(change, pair_rows.manifold_block[world, manifold_block].friction_inverse_mass)
    if settings.cone_friction == ISOTROPIC:
        most = real(0.0)
        for i in range(4):
            first, second = velocity[2 * i], velocity[2 * i + 1]
            most = maximum(most, first * first + second * second)
        return later_maximum(before, most)
    stuck = pair_rows.manifold_block[world, manifold_block].stuck >> 4
    if stuck != 0 and settings.cone_friction == 0:
        # Without a cone, rows without a normal impulse are not relaxed.
        for i in range(4):
            if pair_rows.manifold_block[world, manifold_block].normal_impulse[i] <= 0.0:
                stuck = stuck & ~(1 << i)
    sums = Vector4(
        velocity[0] + velocity[1],
        velocity[2] + velocity[3],
        velocity[4] + velocity[5],
        velocity[6] + velocity[7],
    )
    return residual_of_block(pair_rows, world, manifold_block, sums, stuck, before)


@func
def relax_rigid_normals(
    scratch: Scratch, pair_rows: PairRows, world: Int32, manifold_block: Int32, before: real
) -> real:
    """Relax the normal rows of a rigid manifold block; returns as `normal_residual`."""
    place = pair_rows.manifold_block[world, manifold_block].place
    pair_rows.manifold_block[world, manifold_block].normal_wanted = normals_alone(
        pair_rows, world, manifold_block
    )
    for body in range(2):
        if place[2 * body + 1] > 0:
            weighted = pair_rows.side[world, 2 * manifold_block + body].normal_weighted
            moved = combination(weighted, body_change(scratch, world, place[2 * body]))
            pair_rows.manifold_block[world, manifold_block].normal_wanted -= moved
    change = bounded_normals(pair_rows, world, manifold_block)
    for body in range(2):
        if place[2 * body + 1] > 0:
            response = pair_rows.side[world, 2 * manifold_block + body].normal_response
            add_change(scratch, world, place[2 * body], push_of_normals(response, change))
    return normal_residual(pair_rows, world, manifold_block, change, before)


@func
def relax_rigid_friction(
    settings: Settings,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    manifold_block: Int32,
    before: real,
) -> real:
    """Relax the friction rows of a manifold block of rigid bodies; returns as `friction_residual`."""
    place = pair_rows.manifold_block[world, manifold_block].place
    pair_rows.manifold_block[world, manifold_block].friction_wanted = friction_alone(
        pair_rows, world, manifold_block
    )
    for body in range(2):
        if place[2 * body + 1] > 0:
            weighted = pair_rows.side[world, 2 * manifold_block + body].friction_weighted
            moved = combination(weighted, body_change(scratch, world, place[2 * body]))
            pair_rows.manifold_block[world, manifold_block].friction_wanted -= moved
    change = bounded_friction(settings, pair_rows, world, manifold_block)
    for body in range(2):
        if place[2 * body + 1] > 0:
            response = pair_rows.side[world, 2 * manifold_block + body].friction_response
            add_change(scratch, world, place[2 * body], combination(response, change))
    return friction_residual(settings, pair_rows, world, manifold_block, change, before)
