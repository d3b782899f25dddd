"""Solving the rows of an island whose contacts yield all at once, with the active set that sweeps found.

After a few sweeps most rows at a bound are the right ones, while the impulses of the others still creep
towards each other. These *free* rows are solved for directly: a step of Newton's method on the equations
whose fixed point the sweeps approach,

    free row                   m (A + γ) dλ = m (b − γ λ − J Δv)
    friction that slides       dλ_t = d(μ λ_n z / |z|),   z = λ_t + m (b − γ λ − J Δv)_t

while rows at their bounds stay there (M. Hintermüller, K. Ito, K. Kunisch, The primal-dual active set
strategy as a semismooth Newton method, SIAM Journal on Optimization 13, 2002). The sweep that follows brings
impulses back within their bounds, which corrects the set, and finds whether the island has converged. The
rows are those of one tree; they are visited in the order of the sweeps.
"""

import warp as wp

from carom.kernels.maths.blocks import add_combination4, add_combination8, combine4, combine8
from carom.kernels.solver.active_rows import (
    add_impulse,
    add_impulse_of_pair,
    apart_of_pair,
    apart_of_row,
    eliminate,
    is_free,
    let_slide,
    product_with_pair,
    set_column,
    set_column_of_block,
    set_column_of_pair,
)
from carom.kernels.solver.articulated_manifolds import matrix_parts
from carom.kernels.solver.rigid_manifolds import friction_alone, normals_alone
from carom.kernels.solver.single_contacts import SINGLES
from carom.kernels.solver.warm_starting import slides
from carom.kernels.structs import Model, PairRows, Scratch
from carom.kernels.types import Index4, Int32, Vector4, Vector8, func, real
from carom.layouts.codes import LATERAL_ROW, NORMAL_ROW

# How many sweeps there are before the free rows are solved for, each time.
SWEEPS_BETWEEN = 4


@func
def is_visit_free(scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32) -> bool:
    """Whether a row of `visit_row` is within its bounds."""
    if row >= 0:
        own = scratch.row[world, row]
        return is_free(own.impulse, own.lower, own.upper)
    terms = pair_rows.row_terms[world, -1 - row]
    return is_free(terms.impulse, terms.lower, terms.upper)


@func
def contacts_of_unit(pair_rows: PairRows, world: Int32, code: Int32) -> Int32:
    """Number of contacts of a unit."""
    if code < 0:
        return pair_rows.manifold_block[world, -1 - code].count
    return Int32(1)


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
def free_rows(impulse: Vector4) -> Int32:
    """How many free rows a contact has: those of one that slides are counted, too."""
    if not impulse[0] > 0.0:
        return Int32(0)
    return Int32(3) if impulse[3] > 0.0 else Int32(1)


@func
def is_over(place: Index4, delta: Int32) -> bool:
    """Whether a row is over the tree whose delta velocities begin at `delta`, and no other that can move."""
    return (place[1] == 0 or place[0] == delta) and (place[3] == 0 or place[2] == delta)


@func
def count_free_rows(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    listed: Int32,
    visits: Int32,
    units: Int32,
    delta: Int32,
    most: Int32,
):
    """Count the free rows of an island, and list those of `visit_row` from entry `listed` on.

    Returns:
        The number of listed rows; the number of all, 0 if there are more than `most`, or some are of other
        trees or rigid bodies.
    """
    count = Int32(0)
    for visit in range(visits):
        row = pair_rows.visit_row[world, visit]
        if row >= 0:
            if scratch.row[world, row].delta != delta:
                return Int32(0), Int32(0)
        elif not is_over(pair_rows.row_place[world, -1 - row], delta):
            return Int32(0), Int32(0)
        if is_visit_free(scratch, pair_rows, world, row):
            if count == most:
                return count, Int32(0)
            scratch.entry_system[world, listed + count] = real(row)
            count += 1
    free_visits = count + 0
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        if code >= SINGLES:
            return Int32(0), Int32(0)
        if code < 0:
            if pair_rows.manifold_block[world, -1 - code].matrices < 0:
                return Int32(0), Int32(0)
            if not is_over(pair_rows.manifold_block[world, -1 - code].place, delta):
                return Int32(0), Int32(0)
        elif not is_over(pair_rows.row_place[world, pair_rows.contact_rows[world, code][NORMAL_ROW]], delta):
            return Int32(0), Int32(0)
        for contact in range(contacts_of_unit(pair_rows, world, code)):
            count += free_rows(impulses_of_contact(pair_rows, world, code, contact))
    return free_visits, wp.where(count > most, Int32(0), count)


@func
def want_impulses(scratch: Scratch, pair_rows: PairRows, world: Int32, units: Int32):
    """Write the changes of impulses without bounds into all manifold blocks."""
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        if code < 0:
            block = -1 - code
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
def write_column(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    listed: Int32,
    visits: Int32,
    units: Int32,
    delta: Int32,
    width: Int32,
    entry: Int32,
):
    """Write a column of mA: the effect of the response in `delta_column` on all free rows.

    Rows of the matrix are `width` numbers apart, and `entry` is the first of the column.
    """
    for visit in range(visits):
        row = Int32(scratch.entry_system[world, listed + visit])
        change = real(0.0)
        if row >= 0:
            mass = scratch.row[world, row].effective_mass
            if scratch.row[world, row].soft != 0:
                mass = mass * scratch.row_share[world, row]
            change = mass * scratch.entry_column[world, scratch.row[world, row].entry]
        else:
            change = product_with_pair(scratch, pair_rows, world, -1 - row)
        scratch.entry_system[world, entry] = change
        entry += width
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        if code < 0:
            block = -1 - code
            at = pair_rows.manifold_block[world, block].place
            part = matrix_parts(pair_rows.manifold_block[world, block].matrices, at)
            normals, friction = Vector4(0.0, 0.0, 0.0, 0.0), Vector8(0.0)
            for side in range(2):
                if at[2 * side + 1] > 0:
                    normals += combine4(
                        pair_rows.matrix_block, part[0] + 4 * at[1] * side, 1, scratch.delta_column, delta,
                        world, at[2 * side + 1],
                    )  # fmt: skip
                    friction += combine8(
                        pair_rows.matrix_block, part[1] + 8 * at[1] * side, scratch.delta_column, delta,
                        world, at[2 * side + 1],
                    )  # fmt: skip
            for contact in range(pair_rows.manifold_block[world, block].count):
                count = free_rows(impulses_of_contact(pair_rows, world, code, contact))
                if count > 0:
                    scratch.entry_system[world, entry] = normals[contact]
                if count > 1:
                    scratch.entry_system[world, entry + width] = friction[2 * contact]
                    scratch.entry_system[world, entry + 2 * width] = friction[2 * contact + 1]
                entry += count * width
        else:
            rows = pair_rows.contact_rows[world, code]
            for i in range(free_rows(impulses_of_contact(pair_rows, world, code, 0))):
                scratch.entry_system[world, entry] = product_with_pair(
                    scratch, pair_rows, world, rows[NORMAL_ROW] + i
                )
                entry += width


@func
def write_system(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    listed: Int32,
    visits: Int32,
    units: Int32,
    delta: Int32,
    blocks: Int32,
    width: Int32,
    start: Int32,
):
    """Write mA of all free rows, row by row, from entry `start` of `entry_system` on."""
    entry = start + 0
    for visit in range(visits):
        row = Int32(scratch.entry_system[world, listed + visit])
        if row >= 0:
            set_column(scratch, world, row)
        else:
            set_column_of_pair(scratch, pair_rows, world, -1 - row, delta, blocks)
        write_column(scratch, pair_rows, world, listed, visits, units, delta, width, entry)
        entry += 1
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        for contact in range(contacts_of_unit(pair_rows, world, code)):
            for i in range(free_rows(impulses_of_contact(pair_rows, world, code, contact))):
                if code < 0:
                    set_column_of_block(scratch, pair_rows, world, -1 - code, contact, i, delta, blocks)
                else:
                    row = pair_rows.contact_rows[world, code][NORMAL_ROW] + i
                    set_column_of_pair(scratch, pair_rows, world, row, delta, blocks)
                write_column(scratch, pair_rows, world, listed, visits, units, delta, width, entry)
                entry += 1


@func
def row_of_contact(
    scratch: Scratch, pair_rows: PairRows, world: Int32, code: Int32, contact: Int32, i: Int32
):
    """Change of the impulse of a row of a contact, without bounds; the share by which the row yields."""
    if code < 0:
        block = -1 - code
        if i == 0:
            return (
                pair_rows.manifold_block[world, block].normal_wanted[contact],
                pair_rows.manifold_block[world, block].normal_softness[contact],
            )
        k = 2 * contact + i - 1
        return (
            pair_rows.manifold_block[world, block].friction_wanted[k],
            pair_rows.manifold_block[world, block].friction_softness[k],
        )
    return apart_of_pair(scratch, pair_rows, world, pair_rows.contact_rows[world, code][NORMAL_ROW] + i)


@func
def complete_system(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    listed: Int32,
    visits: Int32,
    units: Int32,
    width: Int32,
    start: Int32,
    side: Int32,
    count: Int32,
):
    """Add softness to the matrix of the `count` free rows, write the right side, and let friction slide."""
    i = Int32(0)
    for visit in range(visits):
        row = Int32(scratch.entry_system[world, listed + visit])
        wanted, softness = apart_of_row(scratch, pair_rows, world, row)
        scratch.entry_system[world, side + i] = wanted
        scratch.entry_system[world, start + i * (width + 1)] += softness
        i += 1
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        for contact in range(contacts_of_unit(pair_rows, world, code)):
            impulse = impulses_of_contact(pair_rows, world, code, contact)
            rows = free_rows(impulse)
            for k in range(rows):
                wanted, softness = row_of_contact(scratch, pair_rows, world, code, contact, k)
                scratch.entry_system[world, side + i + k] = wanted
                scratch.entry_system[world, start + (i + k) * (width + 1)] += softness
            if rows == 3 and slides(impulse[0], impulse[1], impulse[2], impulse[3]):
                let_slide(scratch.entry_system, world, start, width, side, i, count, impulse)
            i += rows


@func
def apply_solution(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    listed: Int32,
    visits: Int32,
    units: Int32,
    delta: Int32,
    entry: Int32,
):
    """Add the solution, from `entry` of `entry_system` on, to the impulses of the free rows.

    Free rows are counted before their impulses change.
    """
    for visit in range(visits):
        row = Int32(scratch.entry_system[world, listed + visit])
        if row >= 0:
            add_impulse(scratch, world, row, scratch.entry_system[world, entry])
        else:
            add_impulse_of_pair(scratch, pair_rows, world, -1 - row, scratch.entry_system[world, entry])
        entry += 1
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        if code < 0:
            block = -1 - code
            normals, friction = Vector4(0.0, 0.0, 0.0, 0.0), Vector8(0.0)
            for contact in range(pair_rows.manifold_block[world, block].count):
                count = free_rows(impulses_of_contact(pair_rows, world, code, contact))
                if count > 0:
                    normals[contact] = scratch.entry_system[world, entry]
                if count > 1:
                    friction[2 * contact] = scratch.entry_system[world, entry + 1]
                    friction[2 * contact + 1] = scratch.entry_system[world, entry + 2]
                entry += count
            pair_rows.manifold_block[world, block].normal_impulse += normals
            pair_rows.manifold_block[world, block].friction_impulse += friction
            place = pair_rows.manifold_block[world, block].place
            part = matrix_parts(pair_rows.manifold_block[world, block].matrices, place)
            for side in range(2):
                if place[2 * side + 1] > 0:
                    add_combination4(
                        scratch.delta_velocity, delta, normals, pair_rows.matrix_block,
                        part[2] + 4 * place[1] * side, 1, world, place[2 * side + 1],
                    )  # fmt: skip
                    add_combination8(
                        scratch.delta_velocity, delta, friction, pair_rows.matrix_block,
                        part[3] + 8 * place[1] * side, world, place[2 * side + 1],
                    )  # fmt: skip
        else:
            first = pair_rows.contact_rows[world, code][NORMAL_ROW]
            for i in range(free_rows(impulses_of_contact(pair_rows, world, code, 0))):
                # The count was found before the first of these impulses changes.
                add_impulse_of_pair(scratch, pair_rows, world, first + i, scratch.entry_system[world, entry])
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
):
    """Solve for the free rows of an island that consists of one tree.

    Nothing happens if there are other trees, rows for which there is no room, or no solution. The equations
    are in `equation_block`: each in a row of twice as many numbers as a vector over the dofs has, and after
    all of these the right sides, which become the solution, and which rows of `visit_row` are free.
    """
    dofs = model.tree[tree].dof_count
    delta = model.tree[tree].first_delta
    blocks = (dofs + 3) // 4
    width = 8 * blocks
    start = 16 * model.tree[tree].first_block
    most = 2 * dofs - 2
    side = start + most * width
    listed = side + width
    free_visits, count = count_free_rows(scratch, pair_rows, world, listed, visits, units, delta, most)
    if count == 0:
        return
    want_impulses(scratch, pair_rows, world, units)
    write_system(scratch, pair_rows, world, listed, free_visits, units, delta, blocks, width, start)
    complete_system(scratch, pair_rows, world, listed, free_visits, units, width, start, side, count)
    if (
        eliminate(scratch.equation_block, scratch.entry_system, world, start // 4, width // 4, side, count)
        == 1
    ):
        apply_solution(scratch, pair_rows, world, listed, free_visits, units, delta, side)
