"""One sweep of projected Gauss-Seidel over the rows of an island, group by group."""

import warp as wp

from carom.kernels.maths.extremes import greater
from carom.kernels.solver.couplings import relax_coupling, relax_in_circle, relax_within
from carom.kernels.solver.joint_solver import relax_row
from carom.kernels.solver.long_patches import relax_long_friction, relax_long_normals
from carom.kernels.solver.patches import relax_rigid_friction, relax_rigid_normals
from carom.kernels.structs import Couplings, Scratch, Settings
from carom.kernels.types import Index4, Int32, func, real
from carom.layouts.codes import LATERAL_ROW, NORMAL_ROW, ROW_FRICTION, ROW_IMPULSE, SPINNING_ROW


@func
def visit_sweep(
    settings: Settings, scratch: Scratch, couplings: Couplings, world: Int32, count: Int32, sweep: Int32
) -> real:
    """Relax motors, limits and user constraints once; returns the greatest change squared."""
    residual = real(0.0)
    inner = Int32(0)
    while inner < settings.inner_iterations:
        inner += 1
        residual = real(0.0)
        place = Int32(0)
        stride = Int32(1)
        if sweep % 2 == 0:
            place = count - 1
            stride = Int32(-1)
        while place >= 0 and place < count:
            row = couplings.visit_row[world, place]
            place += stride
            change = real(0.0)
            if row >= 0:
                change = relax_row(scratch, world, row)
            else:
                change = relax_coupling(scratch, couplings, world, -1 - row)
            if change * change > residual:
                residual = change * change
        if residual == 0.0:
            # Nothing has changed, so nothing ever will.
            inner = settings.inner_iterations
    return residual


@func
def relax_normals(scratch: Scratch, couplings: Couplings, world: Int32, patch: Int32) -> real:
    """Relax the normal rows of a patch; returns the greatest change of velocity squared."""
    if couplings.patch[world, patch].run < 0:
        return relax_rigid_normals(scratch, couplings, world, patch)
    return relax_long_normals(scratch, couplings, world, patch)


@func
def relax_friction(
    settings: Settings, scratch: Scratch, couplings: Couplings, world: Int32, patch: Int32
) -> real:
    """Relax the friction rows of a patch; returns as `relax_normals`."""
    if couplings.patch[world, patch].run < 0:
        return relax_rigid_friction(settings, scratch, couplings, world, patch)
    return relax_long_friction(settings, scratch, couplings, world, patch)


@func
def normal_sweep(scratch: Scratch, couplings: Couplings, world: Int32, units: Int32) -> real:
    """Relax the normal rows of an island's contacts once; returns the greatest change squared."""
    residual = real(0.0)
    for unit in range(units):
        code = couplings.unit_code[world, unit]
        if code < 0:
            residual = greater(residual, relax_normals(scratch, couplings, world, -1 - code))
        else:
            change = relax_coupling(
                scratch, couplings, world, couplings.contact_rows[world, code][NORMAL_ROW]
            )
            residual = greater(residual, change * change)
    return residual


@func
def friction_bound(couplings: Couplings, world: Int32, row: Int32) -> real:
    """Greatest impulse of a friction row: its coefficient times the normal impulse."""
    normal = couplings.coupling_bound[world, row]
    return (
        couplings.coupling_terms[world, row][ROW_FRICTION]
        * couplings.coupling_terms[world, normal][ROW_IMPULSE]
    )


@func
def relax_contact_friction(
    settings: Settings, scratch: Scratch, couplings: Couplings, world: Int32, contact: Int32, kind: Int32
) -> real:
    """Relax the spinning, rolling or lateral rows of a contact; returns the greatest change squared."""
    row = couplings.contact_rows[world, contact][kind]
    change = real(0.0)
    if row >= 0:
        bound = friction_bound(couplings, world, row)
        in_circle = settings.cone_friction != 0 and kind != SPINNING_ROW
        if in_circle and (bound > 0.0 or kind == LATERAL_ROW):
            change = relax_in_circle(scratch, couplings, world, row, bound)
        elif not in_circle and bound > 0.0:
            last = row + 1
            if kind == SPINNING_ROW:
                last = row + 0
            while row <= last:
                change = greater(
                    wp.abs(change),
                    wp.abs(relax_within(scratch, couplings, world, row, -bound, bound)),
                )
                row += 1
    return change * change


@func
def friction_sweep(
    settings: Settings, scratch: Scratch, couplings: Couplings, world: Int32, units: Int32, kind: Int32
) -> real:
    """Relax the spinning, rolling or lateral rows of an island's contacts; returns as `normal_sweep`."""
    residual = real(0.0)
    for unit in range(units):
        code = couplings.unit_code[world, unit]
        if code >= 0:
            residual = greater(
                residual, relax_contact_friction(settings, scratch, couplings, world, code, kind)
            )
        elif kind == LATERAL_ROW:
            residual = greater(residual, relax_friction(settings, scratch, couplings, world, -1 - code))
    return residual


@func
def contact_sweep(
    settings: Settings, scratch: Scratch, couplings: Couplings, world: Int32, units: Index4
) -> real:
    """Relax all rows of an island's contacts: normal, then spinning, rolling and lateral friction.

    `units` is what `units.write_units` returns.
    """
    residual = normal_sweep(scratch, couplings, world, units[0])
    kind = Int32(LATERAL_ROW)
    if units[2] != 0:
        kind = Int32(SPINNING_ROW)
    while kind >= LATERAL_ROW:
        residual = greater(residual, friction_sweep(settings, scratch, couplings, world, units[0], kind))
        kind -= 1
    return residual


@func
def calm_sweep(
    settings: Settings, scratch: Scratch, couplings: Couplings, world: Int32, patches: Int32
) -> real:
    """Relax all rows of a calm island's patches once; returns the greatest change squared.

    Patch by patch, friction right after the normals, first to last and last to first in turn: a load
    passes through a whole stack in a sweep, whichever way it has to go.
    """
    residual = real(0.0)
    patch = Int32(0)
    while patch < patches:
        residual = greater(residual, relax_rigid_normals(scratch, couplings, world, patch))
        residual = greater(residual, relax_rigid_friction(settings, scratch, couplings, world, patch))
        patch += 1
    return residual
