"""One sweep of projected Gauss-Seidel over the rows of an island, by kinds of rows."""

import warp as wp

from carom.kernels.maths.min_max import later_maximum
from carom.kernels.solver.articulated_manifolds import relax_articulated_friction, relax_articulated_normals
from carom.kernels.solver.joint_solver import relax_rows, row_sweep
from carom.kernels.solver.pair_rows import relax_in_circle, relax_pair_row, relax_within
from carom.kernels.solver.rigid_manifolds import relax_rigid_friction, relax_rigid_normals
from carom.kernels.solver.single_contacts import (
    SINGLES,
    TWISTING,
    relax_single_friction,
    relax_single_normal,
    relax_single_torsion,
    single_of,
)
from carom.kernels.solver.units import TWISTED
from carom.kernels.structs import PairRows, Scratch, Settings
from carom.kernels.types import Int32, func, real
from carom.layouts.codes import LATERAL_ROW, NORMAL_ROW, ROLLING_ROW, SPINNING_ROW


@func
def sweep_over_visits(
    scratch: Scratch, pair_rows: PairRows, world: Int32, visits: Int32, sweep: Int32
) -> real:
    """Relax the rows in `visit_row` once; returns as `visit_sweep`.

    Rows of motors and limits that follow each other are relaxed in one go.
    """
    residual = real(0.0)
    place = Int32(0)
    stride = Int32(1)
    if sweep % 2 == 0:
        place = visits - 1
        stride = Int32(-1)
    while place >= 0 and place < visits:
        row = pair_rows.visit_row[world, place]
        place += stride
        if row >= 0:
            count = Int32(1)
            following = row + stride
            # Before row 0 is none: -1 stands for a row of a user constraint.
            while (
                following >= 0
                and place >= 0
                and place < visits
                and pair_rows.visit_row[world, place] == following
            ):
                count += 1
                following += stride
                place += stride
            residual = relax_rows(
                scratch.row, scratch.row_share, scratch.row_softness, scratch.delta_velocity,
                scratch.block_response, world, row, count, stride, residual,
            )  # fmt: skip
        else:
            change = relax_pair_row(scratch, pair_rows, world, -1 - row)
            residual = later_maximum(residual, change * change)
    return residual


@func
def has_stuck_visits(scratch: Scratch, pair_rows: PairRows, world: Int32, visits: Int32) -> bool:
    """Whether nothing can move along some row in `visit_row`."""
    for place in range(visits):
        row = pair_rows.visit_row[world, place]
        mass = real(0.0)
        if row >= 0:
            mass = scratch.row[world, row].effective_mass
        else:
            mass = pair_rows.row_terms[world, -1 - row].effective_mass
        if mass == 0.0:
            return True
    return False


@func
def has_settled(scratch: Scratch, world: Int32, row: Int32) -> bool:
    """Whether the impulse of a row over one tree has the only value that its bounds leave."""
    impulse = scratch.row[world, row].impulse
    return impulse == scratch.row[world, row].lower and impulse == scratch.row[world, row].upper


@func
def leave_out_settled(scratch: Scratch, pair_rows: PairRows, world: Int32, visits: Int32) -> Int32:
    """Take rows out of `visit_row` that no further sweep can change; returns how many are left.

    The impulse of such a row has the only value that its bounds leave, as that of a motor with a given
    torque. After a row along which nothing can move they still count, as they hide its change, 0/0.
    """
    if has_stuck_visits(scratch, pair_rows, world, visits):
        return visits
    left = Int32(0)
    for place in range(visits):
        row = pair_rows.visit_row[world, place]
        if row < 0 or not has_settled(scratch, world, row):
            pair_rows.visit_row[world, left] = row
            left += 1
    return left


@func
def visit_sweep(
    settings: Settings,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    rows: Int32,
    visits: Int32,
    sweep: Int32,
) -> real:
    """Relax motors, limits and user constraints once; returns the maximum change squared.

    `visits` is the number of rows in `visit_row`, `rows` that of all over one tree; if both are equal, these
    are relaxed in their order. As in Bullet, the change of a row along which nothing can move is 0/0, so the
    maximum is that of the rows after it, and NaN if none follows. This also holds for all rows of contacts.
    """
    residual = real(0.0)
    if visits == 0:
        return residual
    if visits == rows:
        return row_sweep(settings, scratch, world, rows, sweep)
    inner = Int32(0)
    while inner < settings.inner_iterations:
        inner += 1
        residual = sweep_over_visits(scratch, pair_rows, world, visits, sweep)
        if residual == 0.0 and not has_stuck_visits(scratch, pair_rows, world, visits):
            # No row has changed, so further inner sweeps would not change any.
            inner = settings.inner_iterations
    return residual


@func
def relax_normals(
    scratch: Scratch, pair_rows: PairRows, world: Int32, manifold_block: Int32, before: real
) -> real:
    """Relax the normal rows of a manifold block; returns the residual after it, from that `before`."""
    if pair_rows.manifold_block[world, manifold_block].matrices < 0:
        return relax_rigid_normals(scratch, pair_rows, world, manifold_block, before)
    return relax_articulated_normals(scratch, pair_rows, world, manifold_block, before)


@func
def relax_friction(
    settings: Settings,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    manifold_block: Int32,
    before: real,
) -> real:
    """Relax the friction rows of a manifold block; returns as `relax_normals`."""
    if pair_rows.manifold_block[world, manifold_block].matrices < 0:
        return relax_rigid_friction(settings, scratch, pair_rows, world, manifold_block, before)
    return relax_articulated_friction(settings, scratch, pair_rows, world, manifold_block, before)


@func
def normal_sweep(scratch: Scratch, pair_rows: PairRows, world: Int32, units: Int32, before: real) -> real:
    """Relax the normal rows of an island's contacts once; returns the residual after them."""
    residual = before + 0.0
    unit = Int32(0)
    while unit < units:
        code = pair_rows.unit_code[world, unit]
        unit += 1
        if code < 0:
            residual = relax_normals(scratch, pair_rows, world, -1 - code, residual)
        elif code >= SINGLES:
            change = relax_single_normal(scratch, pair_rows, world, single_of(code))
            residual = later_maximum(residual, change * change)
        else:
            change = relax_pair_row(
                scratch, pair_rows, world, pair_rows.contact_rows[world, code][NORMAL_ROW]
            )
            residual = later_maximum(residual, change * change)
    return residual


@func
def friction_bound(pair_rows: PairRows, world: Int32, row: Int32) -> real:
    """Maximum impulse of a friction row: its coefficient times the normal impulse."""
    normal = pair_rows.row_bound[world, row]
    return pair_rows.row_terms[world, row].friction * pair_rows.row_terms[world, normal].impulse


@func
def relax_contact_friction(
    settings: Settings, scratch: Scratch, pair_rows: PairRows, world: Int32, contact: Int32, kind: Int32
) -> real:
    """Relax the spinning, rolling or lateral rows of a contact; returns the maximum change squared."""
    row = pair_rows.contact_rows[world, contact][kind]
    change = real(0.0)
    if row >= 0:
        bound = friction_bound(pair_rows, world, row)
        in_circle = settings.cone_friction != 0 and kind != SPINNING_ROW
        if in_circle and (bound > 0.0 or kind == LATERAL_ROW):
            change = relax_in_circle(settings, scratch, pair_rows, world, row, bound)
        elif not in_circle and bound > 0.0:
            last = row + 0 if kind == SPINNING_ROW else row + 1
            while row <= last:
                change = later_maximum(
                    wp.abs(change), wp.abs(relax_within(scratch, pair_rows, world, row, -bound, bound))
                )
                row += 1
    return change * change


@func
def relax_unit_friction(
    settings: Settings,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    code: Int32,
    kind: Int32,
    before: real,
) -> real:
    """Relax the spinning, rolling or lateral rows of a unit; returns as `relax_normals`."""
    residual = before + 0.0
    if code >= SINGLES:
        if kind == LATERAL_ROW:
            change = relax_single_friction(settings, scratch, pair_rows, world, single_of(code))
            residual = later_maximum(residual, change * change)
        elif code >= SINGLES + TWISTING:
            change = relax_single_torsion(settings, scratch, pair_rows, world, single_of(code), kind)
            residual = later_maximum(residual, change * change)
    elif code >= 0:
        residual = later_maximum(
            residual, relax_contact_friction(settings, scratch, pair_rows, world, code, kind)
        )
    elif kind == LATERAL_ROW:
        residual = relax_friction(settings, scratch, pair_rows, world, -1 - code, residual)
    return residual


@func
def friction_sweep(
    settings: Settings,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    units: Int32,
    first: Int32,
    last: Int32,
    before: real,
) -> real:
    """Relax the friction rows of an island's contacts, one after the other; returns as `normal_sweep`.

    Of each contact those from the first kind to the last are relaxed: spinning, rolling, lateral.
    """
    residual = before + 0.0
    unit = Int32(0)
    kind = first + 0
    # One loop over both: before an inner one, compilers compute addresses for all kinds of units.
    while unit < units:
        code = pair_rows.unit_code[world, unit]
        residual = relax_unit_friction(settings, scratch, pair_rows, world, code, kind, residual)
        kind -= 1
        if kind < last:
            kind = first + 0
            unit += 1
    return residual


@func
def contact_sweep(
    settings: Settings,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    units: Int32,
    character: Int32,
    before: real,
) -> real:
    """Relax all rows of an island's contacts: normal, then spinning, rolling and lateral friction.

    `units` and `character` are returned by `units.write_units`. Returns the residual after them. As in Bullet
    spinning friction has no effect without a cone, and the rolling friction of each contact then comes right
    before its lateral friction.
    """
    residual = normal_sweep(scratch, pair_rows, world, units, before)
    kind = Int32(LATERAL_ROW)
    if character == TWISTED:
        if settings.cone_friction != 0:
            kind = Int32(SPINNING_ROW)
            while kind > LATERAL_ROW:
                residual = friction_sweep(settings, scratch, pair_rows, world, units, kind, kind, residual)
                kind -= 1
        else:
            kind = Int32(ROLLING_ROW)
    return friction_sweep(settings, scratch, pair_rows, world, units, kind, Int32(LATERAL_ROW), residual)


@func
def resting_sweep(
    settings: Settings, scratch: Scratch, pair_rows: PairRows, world: Int32, manifold_blocks: Int32
) -> real:
    """Relax all rows of a resting island's manifold blocks once; returns the maximum change squared.

    The friction rows of each block are relaxed right after its normal rows.
    """
    residual = real(0.0)
    manifold_block = Int32(0)
    while manifold_block < manifold_blocks:
        residual = relax_rigid_normals(scratch, pair_rows, world, manifold_block, residual)
        residual = relax_rigid_friction(settings, scratch, pair_rows, world, manifold_block, residual)
        manifold_block += 1
    return residual
