"""The matrix of the equations of all free rows; see `active_set`."""

from carom.kernels.convergence.active_blocks import (
    add_block_responses,
    count_free,
    write_block,
    write_block_column,
)
from carom.kernels.convergence.active_rows import (
    product_with_pair,
    response_of_pair,
    set_column_of_pair,
    write_joint_column,
)
from carom.kernels.convergence.equations import put_both
from carom.kernels.maths.blocks import add_every, combine4, combine8, fill_zero
from carom.kernels.solver.articulated_manifolds import matrix_parts
from carom.kernels.structs import PairRows, Scratch
from carom.kernels.types import Int32, Vector4, Vector8, func, real
from carom.layouts.codes import LATERAL_ROW, NORMAL_ROW


@func
def rows_of_single(pair_rows: PairRows, world: Int32, contact: Int32) -> Int32:
    """How many free rows a contact has that is a unit of its own."""
    rows = pair_rows.contact_rows[world, contact]
    if not pair_rows.row_terms[world, rows[NORMAL_ROW]].impulse > 0.0:
        return Int32(0)
    return Int32(3) if pair_rows.row_terms[world, rows[LATERAL_ROW]].friction > 0.0 else Int32(1)


@func
def set_column_of_block(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    manifold_block: Int32,
    contact: Int32,
    i: Int32,
    delta: Int32,
    blocks: Int32,
):
    """As `set_column_of_pair`, for row `i` of a contact of a manifold block: the normal, then friction."""
    place = pair_rows.manifold_block[world, manifold_block].place
    part = matrix_parts(pair_rows.manifold_block[world, manifold_block].matrices, place)
    fill_zero(scratch.delta_column, delta, world, blocks)
    for side in range(2):
        if place[2 * side + 1] > 0:
            start = part[2] + 4 * place[1] * side + contact
            width = Int32(4)
            if i > 0:
                start = part[3] + 8 * place[1] * side + 2 * contact + i - 1
                width = Int32(8)
            add_every(
                scratch.delta_column, delta, pair_rows.matrix_block, start, width, world, place[2 * side + 1]
            )


@func
def write_column(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    units: Int32,
    delta: Int32,
    start: Int32,
    side: Int32,
    width: Int32,
    column: Int32,
) -> Int32:
    """Write the effects of the response in `delta_column` on the first units, and the reverse.

    `column` is the row of that response. Returns the number of free rows of these units.
    """
    row = Int32(0)
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        if code < 0:
            block = -1 - code
            count = count_free(pair_rows.manifold_block, world, block)
            if count > 0:
                place = pair_rows.manifold_block[world, block].place
                part = matrix_parts(pair_rows.manifold_block[world, block].matrices, place)
                normals, friction = Vector4(0.0, 0.0, 0.0, 0.0), Vector8(0.0)
                for body in range(2):
                    if place[2 * body + 1] > 0:
                        normals += combine4(
                            pair_rows.matrix_block, part[0] + 4 * place[1] * body, 1, scratch.delta_column,
                            delta, world, place[2 * body + 1],
                        )  # fmt: skip
                        friction += combine8(
                            pair_rows.matrix_block, part[1] + 8 * place[1] * body, scratch.delta_column,
                            delta, world, place[2 * body + 1],
                        )  # fmt: skip
                write_block_column(
                    pair_rows.manifold_block, world, block, scratch.entry_system, start, side, width, row,
                    column, normals, friction,
                )  # fmt: skip
            row += count
        else:
            first = pair_rows.contact_rows[world, code][NORMAL_ROW]
            for i in range(rows_of_single(pair_rows, world, code)):
                change = product_with_pair(scratch, pair_rows, world, first + i)
                put_both(scratch.entry_system, world, start, side, width, row, column, change)
                row += 1
    return row


@func
def write_pair_equation(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    row: Int32,
    first: Int32,
    start: Int32,
    side: Int32,
    width: Int32,
    column: Int32,
):
    """Write the diagonal of a row over two trees, whose response is in `delta_column`.

    So are the effects on the rows before it from `first` on, which are those of the same contact.
    """
    before = column - first
    for i in range(before):
        change = product_with_pair(scratch, pair_rows, world, row - before + i)
        put_both(scratch.entry_system, world, start, side, width, first + i, column, change)
    diagonal = product_with_pair(scratch, pair_rows, world, row) + pair_rows.row_terms[world, row].softness
    scratch.entry_system[world, start + column * (width + 1)] = diagonal


@func
def write_block_equations(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    unit: Int32,
    block: Int32,
    delta: Int32,
    blocks: Int32,
    start: Int32,
    side: Int32,
    width: Int32,
    first: Int32,
) -> Int32:
    """Write the equations of a block's free rows, with the units before it; returns the row after them."""
    place = pair_rows.manifold_block[world, block].place
    part = matrix_parts(pair_rows.manifold_block[world, block].matrices, place)
    after = write_block(
        pair_rows.manifold_block, pair_rows.matrix_block, world, block, place, part, scratch.entry_system,
        start, side, width, first,
    )  # fmt: skip
    if first > 0:
        column = first + 0
        for contact in range(pair_rows.manifold_block[world, block].count):
            count = Int32(0)
            if pair_rows.manifold_block[world, block].normal_impulse[contact] > 0.0:
                count = Int32(1)
                if pair_rows.manifold_block[world, block].friction[contact] > 0.0:
                    count = Int32(3)
            for i in range(count):
                set_column_of_block(scratch, pair_rows, world, block, contact, i, delta, blocks)
                write_column(scratch, pair_rows, world, unit, delta, start, side, width, column)
                column += 1
    return after


@func
def write_responses(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    units: Int32,
    start: Int32,
    side: Int32,
    width: Int32,
    column: Int32,
    dof: Int32,
):
    """As `write_column`, for a row over one dof of the tree."""
    row = Int32(0)
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        if code < 0:
            block = -1 - code
            place = pair_rows.manifold_block[world, block].place
            part = matrix_parts(pair_rows.manifold_block[world, block].matrices, place)
            add_block_responses(
                pair_rows.manifold_block, pair_rows.matrix_block, world, block, place, part,
                scratch.entry_system, start, side, width, row, column, dof,
            )  # fmt: skip
            row += count_free(pair_rows.manifold_block, world, block)
        else:
            first = pair_rows.contact_rows[world, code][NORMAL_ROW]
            for i in range(rows_of_single(pair_rows, world, code)):
                weight = scratch.entry_system[world, side + width + column]
                change = weight * response_of_pair(pair_rows, world, first + i, dof)
                put_both(scratch.entry_system, world, start, side, width, column, row, change)
                row += 1


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
    start: Int32,
    side: Int32,
    width: Int32,
):
    """Write the matrix of the equations of all free rows: contacts, and the `visits` listed rows."""
    column = Int32(0)
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        if code < 0:
            column = write_block_equations(
                scratch, pair_rows, world, unit, -1 - code, delta, blocks, start, side, width, column
            )
        else:
            own = column + 0
            row = pair_rows.contact_rows[world, code][NORMAL_ROW]
            for i in range(rows_of_single(pair_rows, world, code)):
                set_column_of_pair(scratch, pair_rows, world, row + i, delta, blocks)
                write_column(scratch, pair_rows, world, unit, delta, start, side, width, column)
                write_pair_equation(scratch, pair_rows, world, row + i, own, start, side, width, column)
                column += 1
    for visit in range(visits):
        row = Int32(scratch.entry_system[world, listed + visit])
        own = column + visit
        if row >= 0:
            dof = scratch.row[world, row].entry - 4 * scratch.row[world, row].delta
            write_responses(scratch, pair_rows, world, units, start, side, width, own, dof)
            write_joint_column(scratch, pair_rows, world, listed, visit, start, side, width, column)
        else:
            set_column_of_pair(scratch, pair_rows, world, -1 - row, delta, blocks)
            write_column(scratch, pair_rows, world, units, delta, start, side, width, own)
            for other in range(visit):
                before = Int32(scratch.entry_system[world, listed + other])
                change = real(0.0)
                if before >= 0:
                    change = scratch.entry_system[world, side + width + column + other]
                    change *= scratch.entry_column[world, scratch.row[world, before].entry]
                else:
                    change = product_with_pair(scratch, pair_rows, world, -1 - before)
                put_both(scratch.entry_system, world, start, side, width, column + other, own, change)
            write_pair_equation(scratch, pair_rows, world, -1 - row, own, start, side, width, own)
