"""Writing the rows of manifold blocks of articulated bodies; see `articulated_manifolds`."""

from carom.kernels.maths.blocks import combine4, combine8, fill_zero
from carom.kernels.solver.articulated_manifolds import VECTORS_PER_BLOCK, matrix_parts
from carom.kernels.solver.pair_rows import write_jacobians
from carom.kernels.solver.rigid_manifold_rows import row_direction, write_row_numbers
from carom.kernels.structs import ContactTerms, Model, PairRows, Scratch, Settings, Shapes, State
from carom.kernels.types import Index4, Int32, func, real


@func
def clear_matrices(pair_rows: PairRows, world: Int32, manifold_block: Int32):
    """Set the matrices of a manifold block to zero."""
    place = pair_rows.manifold_block[world, manifold_block].place
    fill_zero(
        pair_rows.matrix_block,
        pair_rows.manifold_block[world, manifold_block].matrices,
        world,
        VECTORS_PER_BLOCK * (place[1] + place[3]),
    )


@func
def write_matrices(
    pair_rows: PairRows,
    world: Int32,
    weighted: Int32,
    responses: Int32,
    width: Int32,
    blocks: Int32,
    row: Int32,
    mass: real,
    start: Int32,
):
    """Copy a row's Jacobian (times `mass`) and response, at block `start`, to the matrices.

    These begin at the blocks `weighted` and `responses`, and have `width` times four rows; this is `row`.
    """
    for block in range(blocks):
        jacobian = pair_rows.jacobian_row[world, start + block]
        for i in range(4):
            entry = 4 * (weighted + width * (4 * block + i)) + row
            pair_rows.entry_matrix[world, entry] = mass * jacobian[i]
        response = pair_rows.jacobian_response[world, start + block]
        pair_rows.matrix_block[world, responses + 4 * width * block + row] = response


@func
def write_normal_delassus(
    pair_rows: PairRows, world: Int32, manifold_block: Int32, contact: Int32, mass: real, start: Int32
):
    """Write a column of the Delassus matrix: the effect of the rows written so far on this normal row.

    It is computed from the response to this row, whose effective mass is `mass`: the matrix is symmetric
    before the multiplication by effective masses.
    """
    place = pair_rows.manifold_block[world, manifold_block].place
    part = matrix_parts(pair_rows.manifold_block[world, manifold_block].matrices, place)
    lowered = pair_rows.manifold_block[world, manifold_block].normal_share * real(0.0)
    for side in range(2):
        if place[2 * side + 1] > 0:
            lowered += combine4(
                pair_rows.matrix_block, part[0] + 4 * place[1] * side, pair_rows.jacobian_response,
                start + place[1] * side, world, place[2 * side + 1],
            )  # fmt: skip
    for i in range(4):
        inverse_mass = pair_rows.manifold_block[world, manifold_block].normal_inverse_mass[i]
        entry = lowered[i] * inverse_mass * mass
        pair_rows.manifold_block[world, manifold_block].normal_delassus[i, contact] = entry


@func
def write_friction_delassus(
    pair_rows: PairRows, world: Int32, manifold_block: Int32, row: Int32, mass: real, start: Int32
):
    """As `write_normal_delassus`, for friction row `row` of eight."""
    place = pair_rows.manifold_block[world, manifold_block].place
    part = matrix_parts(pair_rows.manifold_block[world, manifold_block].matrices, place)
    lowered = pair_rows.manifold_block[world, manifold_block].friction_share * real(0.0)
    for side in range(2):
        if place[2 * side + 1] > 0:
            lowered += combine8(
                pair_rows.matrix_block, part[1] + 8 * place[1] * side, pair_rows.jacobian_response,
                start + place[1] * side, world, place[2 * side + 1],
            )  # fmt: skip
    for i in range(8):
        inverse_mass = pair_rows.manifold_block[world, manifold_block].friction_inverse_mass[i]
        entry = lowered[i] * inverse_mass * mass
        pair_rows.manifold_block[world, manifold_block].friction_delassus[i, row] = entry


@func
def write_articulated_contact(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pair_rows: PairRows,
    terms: ContactTerms,
    world: Int32,
    manifold_block: Int32,
    contact: Int32,
    start: Int32,
):
    """Write the three rows of a contact; blocks from `start` on, for rows over two trees, are workspace."""
    place = pair_rows.manifold_block[world, manifold_block].place
    part = matrix_parts(pair_rows.manifold_block[world, manifold_block].matrices, place)
    row = Int32(0)
    while row < 3:
        direction = row_direction(terms, row)
        inverse_mass, velocity = write_jacobians(
            model, state, scratch, pair_rows, world, terms.ends, terms.point_a, terms.point_b, direction,
            0.0 * direction, start,
        )  # fmt: skip
        mass = write_row_numbers(
            settings, shapes, pair_rows, terms, world, manifold_block, contact, row, velocity, inverse_mass
        )
        line = 2 * contact + row - 1
        for side in range(2):
            # The parts of body b come after those of body a.
            own = part + Index4(4 * place[1], 8 * place[1], 4 * place[1], 8 * place[1]) * side
            jacobian = start + place[1] * side
            blocks = place[2 * side + 1]
            if row == 0:
                write_matrices(pair_rows, world, own[0], own[2], 1, blocks, contact, mass, jacobian)
            else:
                write_matrices(pair_rows, world, own[1], own[3], 2, blocks, line, mass, jacobian)
        if row == 0:
            write_normal_delassus(pair_rows, world, manifold_block, contact, mass, start)
        else:
            write_friction_delassus(pair_rows, world, manifold_block, line, mass, start)
        row += 1
