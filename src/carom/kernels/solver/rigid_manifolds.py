"""Manifold blocks: up to four consecutive contacts of the same two trees, relaxed together.

The effect of each row of a manifold block on the velocities of the rows after it is computed beforehand, as a
Delassus matrix. So the velocities of all rows are computed at once, then the impulses row by row, and the
delta velocities of the trees are updated once per block. These are the same Gauss-Seidel steps as with
single rows, with fewer reads and writes of memory.

Entries beyond the last contact of a manifold block have effective mass 0, and nothing changes them. This
module is for rigid bodies; `articulated_manifolds` does the same for articulated bodies.
"""

from typing import Any

import warp as wp

from carom.kernels.maths.equal_steps import equal_steps
from carom.kernels.maths.min_max import INDEFINITE, later_maximum, maximum
from carom.kernels.structs import PairRows, Scratch, Settings
from carom.kernels.types import Int32, Matrix48, Vector4, Vector8, func, real
from carom.kernels.warp_types import warp_type
from carom.layouts import pair_rows as layouts
from carom.layouts.codes import ISOTROPIC
from carom.layouts.types import Rows

ManifoldBlocks = warp_type(Rows[layouts.ManifoldBlock])
ManifoldSides = warp_type(Rows[layouts.ManifoldSide])


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


@wp.func_native("""
    auto& own = wp::index(rows, world, row);
    wp::float64 wanted[4];
    for (int i = 0; i < 4; ++i)
        wanted[i] = own.normal_wanted[i];
    wp::vec_t<4, wp::float64> change;
    #pragma clang loop unroll(full)
    for (int i = 0; i < 4; ++i) {
        if (i == own.count)
            break;
        const auto least = -own.normal_impulse[i];
        change[i] = wanted[i] < least ? least : wanted[i];
        for (int other = i + 1; other < 4; ++other)
            wanted[other] -= change[i] * own.normal_delassus.data[i][other];
    }
    own.normal_impulse = wp::add(own.normal_impulse, change);
    return change;
""")
def bounded_normals(rows: ManifoldBlocks, world: Int32, row: Int32) -> Vector4:
    """Update the normal impulses of a block by the wanted changes, clamped to >= 0; returns the changes.

    Each contact waits for those before it. So only the rows after a contact are told of its change, one by
    one, which takes less time than to put vectors together.
    """
    ...


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


@func
def steps_of_contacts(pair_rows: PairRows, world: Int32, manifold_block: Int32) -> Vector8:
    """Factors of `equal_steps` for the friction rows of a block."""
    inverse_mass = pair_rows.manifold_block[world, manifold_block].friction_inverse_mass
    steps = Vector8(0.0)
    for i in range(4):
        inverse1, inverse2 = inverse_mass[2 * i], inverse_mass[2 * i + 1]
        lowered = pair_rows.manifold_block[world, manifold_block].friction_delassus[2 * i, 2 * i + 1]
        both = equal_steps(inverse1, inverse2, lowered * inverse2)
        steps[2 * i] = both[0]
        steps[2 * i + 1] = both[1]
    return steps


@wp.func_native("""
    auto& own = wp::index(rows, world, row);
    const auto& lowered = own.friction_delassus.data;
    wp::float64 wanted[8];
    for (int i = 0; i < 8; ++i)
        wanted[i] = own.friction_wanted[i];
    wp::vec_t<8, wp::float64> change;
    #pragma clang loop unroll(full)
    for (int contact = 0; contact < 4; ++contact) {
        if (contact == own.count)
            break;
        const int i = 2 * contact, j = i + 1;
        const auto before1 = own.friction_impulse[i], before2 = own.friction_impulse[j];
        const auto bound = own.friction[contact] * own.normal_impulse[contact];
        auto change1 = wanted[i], change2 = wanted[j];
        if (equal != 0) {
            change1 *= steps[i];
            change2 *= steps[j];
        }
        const auto first = before1 + change1;
        auto second = before2 + change2;
        if (cone != 0) {
            const auto square = first * first + second * second;
            if (square > bound * bound) {
                const auto scale = bound == 0.0 ? 0.0 : bound / wp::sqrt(square);
                change1 = first * scale - before1;
                change2 = second * scale - before2;
            }
        } else if (bound > 0.0) {
            change1 = (first < -bound ? -bound : first > bound ? bound : first) - before1;
            second -= change1 * lowered[i][j];
            change2 = (second < -bound ? -bound : second > bound ? bound : second) - before2;
        } else {
            change1 = change2 = 0.0;
        }
        change[i] = change1;
        change[j] = change2;
        for (int other = j + 1; other < 8; ++other)
            wanted[other] -= change1 * lowered[i][other] + change2 * lowered[j][other];
    }
    own.friction_impulse = wp::add(own.friction_impulse, change);
    return change;
""")
def bounded_friction(
    rows: ManifoldBlocks, world: Int32, row: Int32, cone: Int32, equal: Int32, steps: Vector8
) -> Vector8:
    """Update the friction impulses of a block, within bounds by the normal impulses; returns the changes.

    If `equal` is not 0, the wanted changes of each contact are multiplied by its `steps`.
    """
    ...


@func
def relaxed_friction(settings: Settings, pair_rows: PairRows, world: Int32, manifold_block: Int32) -> Vector8:
    """As `bounded_friction`, bounded as the settings say."""
    equal, steps = Int32(0), Vector8(1.0)
    if settings.cone_friction == ISOTROPIC:
        equal = Int32(1)
        steps = steps_of_contacts(pair_rows, world, manifold_block)
    return bounded_friction(
        pair_rows.manifold_block, world, manifold_block, settings.cone_friction, equal, steps
    )


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
    change = bounded_normals(pair_rows.manifold_block, world, manifold_block)
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
    change = relaxed_friction(settings, pair_rows, world, manifold_block)
    for body in range(2):
        if place[2 * body + 1] > 0:
            response = pair_rows.side[world, 2 * manifold_block + body].friction_response
            add_change(scratch, world, place[2 * body], combination(response, change))
    return friction_residual(settings, pair_rows, world, manifold_block, change, before)
