"""Single rows among those that are solved for at once; see `active_set`."""

from carom.kernels.convergence.equations import put_both
from carom.kernels.maths.blocks import add_multiple, dot_product, fill_zero
from carom.kernels.solver.pair_rows import push_row, wanted_impulse
from carom.kernels.structs import PairRows, Scratch
from carom.kernels.types import Int32, func, real


@func
def is_free(impulse: real, lower: real, upper: real) -> bool:
    """Whether an impulse is within its bounds, so that the equation of its row holds."""
    return impulse > lower and impulse < upper


@func
def is_visit_free(scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32) -> bool:
    """Whether a row of `visit_row` is within its bounds."""
    if row >= 0:
        own = scratch.row[world, row]
        return is_free(own.impulse, own.lower, own.upper)
    terms = pair_rows.row_terms[world, -1 - row]
    return is_free(terms.impulse, terms.lower, terms.upper)


@func
def set_column_of_pair(
    scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32, delta: Int32, blocks: Int32
):
    """Write the response to a unit impulse along a row over two trees into `delta_column`.

    Only one of the trees can move: its delta velocities, `blocks` blocks of them, begin at `delta`.
    """
    place = pair_rows.row_place[world, row]
    start = pair_rows.row_start[world, row]
    fill_zero(scratch.delta_column, delta, world, blocks)
    for side in range(2):
        if place[2 * side + 1] > 0:
            add_multiple(
                scratch.delta_column, delta, real(1.0), pair_rows.jacobian_response, start + place[1] * side,
                world, place[2 * side + 1],
            )  # fmt: skip


@func
def response_of_pair(pair_rows: PairRows, world: Int32, row: Int32, dof: Int32) -> real:
    """Change of the rate of a dof of the tree by a unit impulse along a row over two trees."""
    place = pair_rows.row_place[world, row]
    total = real(0.0)
    for side in range(2):
        if place[2 * side + 1] > 0:
            block = pair_rows.row_start[world, row] + place[1] * side + dof // 4
            total += pair_rows.jacobian_response[world, block][dof % 4]
    return total


@func
def product_with_pair(scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32) -> real:
    """Effect of the response in `delta_column` on the wanted impulse of a row over two trees."""
    place = pair_rows.row_place[world, row]
    start = pair_rows.row_start[world, row]
    total = real(0.0)
    for side in range(2):
        if place[2 * side + 1] > 0:
            total += dot_product(
                pair_rows.jacobian_row, start + place[1] * side, scratch.delta_column, place[2 * side], world,
                place[2 * side + 1],
            )  # fmt: skip
    return total * pair_rows.row_terms[world, row].effective_mass


@func
def apart_of_pair(scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32) -> real:
    """Change of the impulse of a row over two trees, without bounds."""
    terms = pair_rows.row_terms[world, row]
    place = pair_rows.row_place[world, row]
    start = pair_rows.row_start[world, row]
    return wanted_impulse(scratch, pair_rows, world, place, start, terms) - terms.impulse


@func
def share_of_row(scratch: Scratch, world: Int32, row: Int32) -> real:
    """Share of its rate that a row over one tree corrects at once: 1 unless it is soft."""
    if scratch.row[world, row].soft != 0:
        return scratch.row_share[world, row]
    return real(1.0)


@func
def softness_of_row(scratch: Scratch, world: Int32, row: Int32) -> real:
    """Share of its impulse by which a row over one tree yields."""
    if scratch.row[world, row].soft != 0:
        return scratch.row_softness[world, row] * scratch.row[world, row].effective_mass
    return real(0.0)


@func
def apart_of_row(scratch: Scratch, world: Int32, row: Int32) -> real:
    """As `apart_of_pair`, for a row over one tree."""
    own = scratch.row[world, row]
    rate = scratch.entry_delta_velocity[world, own.entry]
    change = (own.change - rate) * share_of_row(scratch, world, row) * own.effective_mass
    return change - softness_of_row(scratch, world, row) * own.impulse


@func
def write_joint_column(
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    listed: Int32,
    visit: Int32,
    start: Int32,
    side: Int32,
    width: Int32,
    first: Int32,
):
    """Write the equation and the column of a row over one tree, entry `visit` of the list, with those before.

    `first` is the row of the equations that the list begins with.
    """
    row = Int32(scratch.entry_system[world, listed + visit])
    own = scratch.row[world, row]
    dof = own.entry - 4 * own.delta
    weight = own.effective_mass * share_of_row(scratch, world, row)
    for other in range(visit):
        before = Int32(scratch.entry_system[world, listed + other])
        response = real(0.0)
        if before >= 0:
            place = scratch.row[world, before].response + dof // 4
            response = scratch.block_response[world, place][dof % 4]
            response = response / scratch.row[world, before].effective_mass
        else:
            response = response_of_pair(pair_rows, world, -1 - before, dof)
        put_both(
            scratch.entry_system, world, start, side, width, first + visit, first + other, weight * response
        )
    diagonal = share_of_row(scratch, world, row) + softness_of_row(scratch, world, row)
    scratch.entry_system[world, start + (first + visit) * (width + 1)] = diagonal


@func
def add_impulse(scratch: Scratch, world: Int32, row: Int32, change: real):
    """Change the impulse of a row over one tree."""
    own = scratch.row[world, row]
    scratch.row[world, row].impulse = own.impulse + change
    add_multiple(
        scratch.delta_velocity, own.delta, change / own.effective_mass, scratch.block_response, own.response,
        world, own.blocks,
    )  # fmt: skip


@func
def add_impulse_of_pair(scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32, change: real):
    """As `add_impulse`, for a row over two trees."""
    pair_rows.row_terms[world, row].impulse += change
    place = pair_rows.row_place[world, row]
    push_row(scratch, pair_rows, world, place, pair_rows.row_start[world, row], change)
