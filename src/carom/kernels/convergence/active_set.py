"""Solving the rows of an island whose contacts yield all at once, with the active set that sweeps found.

After a few sweeps most rows at a bound are the right ones, while the impulses of the others still creep
towards each other. These *free* rows are solved for directly: a step of Newton's method on the equations
whose fixed point the sweeps approach,

    free row                   m (A + γ) dλ = m (b − γ λ − J Δv)
    friction that slides       dλ_t = d(μ λ_n z / |z|),   z = λ_t + m (b − γ λ − J Δv)_t

while rows at their bounds stay there (M. Hintermüller, K. Ito, K. Kunisch, The primal-dual active set
strategy as a semismooth Newton method, SIAM Journal on Optimization 13, 2002). The sweep that follows brings
impulses back within their bounds, which corrects the set, and finds whether the island has converged. The
rows are those of one tree: its contacts, and then those of `visit_row`.
"""

import warp as wp

from carom.kernels.convergence.active_blocks import count_free, write_block_change
from carom.kernels.convergence.active_rows import (
    add_impulse,
    add_impulse_of_pair,
    apart_of_pair,
    apart_of_row,
    is_visit_free,
    share_of_row,
)
from carom.kernels.convergence.active_system import rows_of_single, write_system
from carom.kernels.convergence.equations import add_row, eliminate, let_slide
from carom.kernels.maths.blocks import combine4, combine8
from carom.kernels.solver.articulated_manifolds import matrix_parts, push_articulated
from carom.kernels.solver.rigid_manifolds import friction_alone, normals_alone
from carom.kernels.solver.single_contacts import SINGLES
from carom.kernels.solver.warm_starting import slides
from carom.kernels.structs import Model, PairRows, Scratch
from carom.kernels.types import Index4, Int32, Vector4, Vector8, func, real
from carom.layouts.codes import LATERAL_ROW, NORMAL_ROW

# How many sweeps there are before the free rows are solved for, first and then; each time one more, because
# sets that come back again and again need more sweeps to settle.
FIRST_SWEEPS = 3
SWEEPS_BETWEEN = 1


@func
def impulses_of_contact(pair_rows: PairRows, world: Int32, code: Int32, contact: Int32) -> Vector4:
    """Impulses of a contact of a unit along its normal and both directions of friction; its coefficient."""
    if code < 0:
        block = -1 - code
        return Vector4(
            pair_rows.manifold_block[world, block].normal_impulse[contact],
            pair_rows.manifold_block[world, block].friction_impulse[2 * contact],
            pair_rows.manifold_block[world, block].friction_impulse[2 * contact + 1],
            pair_rows.manifold_block[world, block].friction[contact],
        )
    rows = pair_rows.contact_rows[world, code]
    lateral = rows[LATERAL_ROW]
    return Vector4(
        pair_rows.row_terms[world, rows[NORMAL_ROW]].impulse,
        pair_rows.row_terms[world, lateral].impulse,
        pair_rows.row_terms[world, lateral + 1].impulse,
        pair_rows.row_terms[world, lateral].friction,
    )


@func
def free_rows_of_unit(pair_rows: PairRows, world: Int32, code: Int32) -> Int32:
    """How many free rows a unit has: those of a contact that slides are counted, too."""
    if code < 0:
        return count_free(pair_rows.manifold_block, world, -1 - code)
    return rows_of_single(pair_rows, world, code)


@func
def is_over(place: Index4, delta: Int32) -> bool:
    """Whether a row is over the tree whose delta velocities begin at `delta`, and no other that can move."""
    return (place[1] == 0 or place[0] == delta) and (place[3] == 0 or place[2] == delta)


@func
def unit_is_over(pair_rows: PairRows, world: Int32, code: Int32, delta: Int32) -> bool:
    """As `is_over`, for a unit of contacts, which has to be articulated."""
    if code >= SINGLES:
        return False
    if code >= 0:
        return is_over(pair_rows.row_place[world, pair_rows.contact_rows[world, code][NORMAL_ROW]], delta)
    block = -1 - code
    if pair_rows.manifold_block[world, block].matrices < 0:
        return False
    return is_over(pair_rows.manifold_block[world, block].place, delta)


@func
def list_free_visits(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    listed: Int32,
    visits: Int32,
    delta: Int32,
    most: Int32,
) -> Int32:
    """List the free rows of `visit_row` from entry `listed` on.

    Returns how many there are; `most + 1` if there are more than `most`, or some are of other trees.
    """
    count = Int32(0)
    for visit in range(visits):
        row = pair_rows.visit_row[world, visit]
        if row >= 0:
            if scratch.row[world, row].delta != delta:
                return most + 1
        elif not is_over(pair_rows.row_place[world, -1 - row], delta):
            return most + 1
        if is_visit_free(scratch, pair_rows, world, row):
            if count == most:
                return most + 1
            scratch.entry_system[world, listed + count] = real(row)
            count += 1
    return count


@func
def count_free_contact_rows(
    pair_rows: PairRows, world: Int32, units: Int32, delta: Int32, most: Int32
) -> Int32:
    """Count the free rows of an island's contacts; `most + 1` if some are of other trees or rigid bodies."""
    count = Int32(0)
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        if not unit_is_over(pair_rows, world, code, delta):
            return most + 1
        count += free_rows_of_unit(pair_rows, world, code)
    return count


@func
def want_impulses(scratch: Scratch, pair_rows: PairRows, world: Int32, block: Int32):
    """Write the changes of impulses without bounds into a manifold block."""
    place = pair_rows.manifold_block[world, block].place
    part = matrix_parts(pair_rows.manifold_block[world, block].matrices, place)
    normals = normals_alone(pair_rows, world, block)
    friction = friction_alone(pair_rows, world, block)
    for side in range(2):
        if place[2 * side + 1] > 0:
            normals -= combine4(
                pair_rows.matrix_block, part[0] + 4 * place[1] * side, 1, scratch.delta_velocity,
                place[2 * side], world, place[2 * side + 1],
            )  # fmt: skip
            friction -= combine8(
                pair_rows.matrix_block, part[1] + 8 * place[1] * side, scratch.delta_velocity,
                place[2 * side], world, place[2 * side + 1],
            )  # fmt: skip
    pair_rows.manifold_block[world, block].normal_wanted = normals
    pair_rows.manifold_block[world, block].friction_wanted = friction


@func
def write_right_sides(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    listed: Int32,
    visits: Int32,
    units: Int32,
    side: Int32,
    width: Int32,
):
    """Write the right sides of all equations, and the masses of rows, but for those of manifold blocks.

    Blocks remember what their impulses want. Contacts come before the `visits` listed rows.
    """
    row = Int32(0)
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        count = free_rows_of_unit(pair_rows, world, code)
        if code < 0:
            if count > 0:
                want_impulses(scratch, pair_rows, world, -1 - code)
        else:
            first = pair_rows.contact_rows[world, code][NORMAL_ROW]
            for i in range(count):
                wanted = apart_of_pair(scratch, pair_rows, world, first + i)
                mass = pair_rows.row_terms[world, first + i].effective_mass
                add_row(scratch.entry_system, world, side, width, row + i, wanted, mass)
        row += count
    for visit in range(visits):
        own = Int32(scratch.entry_system[world, listed + visit])
        if own >= 0:
            mass = scratch.row[world, own].effective_mass * share_of_row(scratch, world, own)
            wanted = apart_of_row(scratch, world, own)
            add_row(scratch.entry_system, world, side, width, row, wanted, mass)
        else:
            mass = pair_rows.row_terms[world, -1 - own].effective_mass
            wanted = apart_of_pair(scratch, pair_rows, world, -1 - own)
            add_row(scratch.entry_system, world, side, width, row, wanted, mass)
        row += 1


@func
def let_contacts_slide(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    units: Int32,
    start: Int32,
    side: Int32,
    width: Int32,
    count: Int32,
):
    """Replace the equations of friction that slides."""
    row = Int32(0)
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        contacts = Int32(1)
        if code < 0:
            contacts = pair_rows.manifold_block[world, -1 - code].count
        for contact in range(contacts):
            impulse = impulses_of_contact(pair_rows, world, code, contact)
            if impulse[0] > 0.0:
                if impulse[3] > 0.0:
                    if slides(impulse[0], impulse[1], impulse[2], impulse[3]):
                        let_slide(scratch.entry_system, world, start, width, side, row, count, impulse)
                    row += 2
                row += 1


@func
def push_block(scratch: Scratch, pair_rows: PairRows, world: Int32, block: Int32, entry: Int32):
    """Add the solution, from `entry` of `entry_system` on, to the impulses of a manifold block."""
    change = write_block_change(pair_rows.manifold_block, world, block, scratch.entry_system, entry)
    normals = Vector4(change[0], change[1], change[2], change[3])
    friction = Vector8(
        change[4], change[5], change[6], change[7], change[8], change[9], change[10], change[11]
    )
    push_articulated(scratch, pair_rows, world, block, normals, friction)


@func
def apply_solution(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    listed: Int32,
    visits: Int32,
    units: Int32,
    entry: Int32,
):
    """Add the solution, from `entry` of `entry_system` on, to the impulses of the free rows."""
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        # Free rows are counted before their impulses change.
        count = free_rows_of_unit(pair_rows, world, code)
        if code < 0:
            if count > 0:
                push_block(scratch, pair_rows, world, -1 - code, entry)
        else:
            first = pair_rows.contact_rows[world, code][NORMAL_ROW]
            for i in range(count):
                change = scratch.entry_system[world, entry + i]
                add_impulse_of_pair(scratch, pair_rows, world, first + i, change)
        entry += count
    for visit in range(visits):
        row = Int32(scratch.entry_system[world, listed + visit])
        if row >= 0:
            add_impulse(scratch, world, row, scratch.entry_system[world, entry])
        else:
            add_impulse_of_pair(scratch, pair_rows, world, -1 - row, scratch.entry_system[world, entry])
        entry += 1


@func
def solve_free_rows(
    model: Model,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
    visits: Int32,
    units: Int32,
) -> Int32:
    """Solve for the free rows of an island that consists of one tree.

    Nothing happens if there are other trees, rows for which there is no room, or no solution. The equations,
    see `equations`, are in `equation_block`, where a tree has twice as much room as a matrix over its dofs
    needs; behind them is a list of the free ones among `visit_row`.

    Returns:
        1 if it can be tried again after further sweeps.
    """
    dofs = model.tree[tree].dof_count
    delta = model.tree[tree].first_delta
    blocks = (dofs + 3) // 4
    width_in_blocks = 5 * blocks // 4
    width = 4 * width_in_blocks
    start = 8 * model.tree[tree].first_block
    # The right sides, two vectors of masses, and the list take as much room as four equations.
    most = wp.min(2 * dofs * blocks // width_in_blocks - 4, width)
    if most < 1 or start + 8 * dofs * blocks > scratch.entry_system.shape[1]:
        return Int32(0)
    side = start + most * width
    listed = side + 3 * width
    free_visits = list_free_visits(scratch, pair_rows, world, listed, visits, delta, most)
    count = free_visits + count_free_contact_rows(pair_rows, world, units, delta, most)
    if count > most:
        return Int32(0)
    if count == 0:
        return Int32(1)
    write_right_sides(scratch, pair_rows, world, listed, free_visits, units, side, width)
    write_system(scratch, pair_rows, world, listed, free_visits, units, delta, blocks, start, side, width)
    let_contacts_slide(scratch, pair_rows, world, units, start, side, width, count)
    solved = eliminate(
        scratch.equation_block, scratch.entry_system, world, start // 4, width_in_blocks, side, count
    )
    if solved == 1:
        apply_solution(scratch, pair_rows, world, listed, free_visits, units, side)
    return Int32(1)
