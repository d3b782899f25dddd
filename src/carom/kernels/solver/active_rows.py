"""Rows that are solved for at once, one by one, and their equations; see `active_set`."""

import warp as wp

from carom.kernels.maths.blocks import add_multiple, dot_product, fill_zero, write_multiple
from carom.kernels.solver.articulated_manifolds import matrix_parts
from carom.kernels.solver.pair_rows import push_row, wanted_impulse
from carom.kernels.structs import PairRows, Scratch
from carom.kernels.types import Int32, RealRows, Vector4, Vector4Rows, func, real

__all__ = [
    "add_every",
    "add_impulse",
    "add_impulse_of_pair",
    "apart_of_pair",
    "apart_of_row",
    "eliminate",
    "is_free",
    "let_slide",
    "product_with_pair",
    "set_column",
    "set_column_of_block",
    "set_column_of_pair",
]


@func
def is_free(impulse: real, lower: real, upper: real) -> bool:
    """Whether an impulse is within its bounds, so that the equation of its row holds."""
    return impulse > lower and impulse < upper


@func
def set_column(scratch: Scratch, world: Int32, row: Int32):
    """Write the response to a unit impulse along a row over one tree into `delta_column`."""
    own = scratch.row[world, row]
    write_multiple(
        scratch.delta_column, own.delta, 1.0 / own.effective_mass, scratch.block_response, own.response,
        world, own.blocks,
    )  # fmt: skip


@func
def set_column_of_pair(
    scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32, delta: Int32, blocks: Int32
):
    """As `set_column`, for a row over two trees, of which only one can move."""
    place = pair_rows.row_place[world, row]
    start = pair_rows.row_start[world, row]
    fill_zero(scratch.delta_column, delta, world, blocks)
    for side in range(2):
        if place[2 * side + 1] > 0:
            add_multiple(
                scratch.delta_column, delta, real(1.0), pair_rows.jacobian_response, start + place[1] * side,
                world, place[2 * side + 1],
            )  # fmt: skip


@wp.func_native("""
    const auto* x = &wp::index(a, world, start);
    auto* y = &wp::index(b, world, first);
    #pragma clang loop vectorize(disable)
    for (int i = 0; i < count; ++i)
        y[i] = wp::add(y[i], x[i * width]);
""")
def add_every(
    b: Vector4Rows, first: Int32, a: Vector4Rows, start: Int32, width: Int32, world: Int32, count: Int32
):
    """Add the first of every `width` blocks of `a` to `count` blocks of `b`."""
    ...


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
    """As `set_column`, for row `i` of a contact of a manifold block: the normal, or 1 or 2 for friction."""
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
def apart_of_pair(scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32):
    """Change of the impulse of a row over two trees, without bounds; the share by which the row yields."""
    terms = pair_rows.row_terms[world, row]
    place = pair_rows.row_place[world, row]
    start = pair_rows.row_start[world, row]
    wanted = wanted_impulse(scratch, pair_rows, world, place, start, terms)
    return wanted - terms.impulse, terms.softness


@func
def apart_of_row(scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32):
    """As `apart_of_pair`, for a row of `visit_row`."""
    if row < 0:
        return apart_of_pair(scratch, pair_rows, world, -1 - row)
    own = scratch.row[world, row]
    change = own.change - scratch.entry_delta_velocity[world, own.entry]
    softness = real(0.0)
    if own.soft != 0:
        softness = scratch.row_softness[world, row]
        change = change * scratch.row_share[world, row] - softness * own.impulse
    return change * own.effective_mass, softness * own.effective_mass


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


@wp.func_native("""
    auto* first = &wp::index(system, world, start + (row + 1) * width);
    auto* second = first + width;
    auto* right = &wp::index(system, world, side + row + 1);
    const auto z1 = impulse[1] + right[0], z2 = impulse[2] + right[1];
    const auto length = wp::sqrt(z1 * z1 + z2 * z2);
    if (!(length > 0.0))
        return;
    const auto n1 = z1 / length, n2 = z2 / length;
    const auto bound = impulse[3] * impulse[0];
    const auto scale = bound < length ? bound / length : 1.0;
    for (int i = 0; i < count; ++i) {
        // What turns the direction of z is across it.
        const auto own1 = i == row + 1 ? 1.0 : 0.0, own2 = i == row + 2 ? 1.0 : 0.0;
        const auto across = scale * (n1 * (own2 - second[i]) - n2 * (own1 - first[i]));
        const auto along = i == row ? impulse[3] : 0.0;
        first[i] = own1 + n2 * across - n1 * along;
        second[i] = own2 - n1 * across - n2 * along;
    }
    right[0] = bound * n1 - impulse[1];
    right[1] = bound * n2 - impulse[2];
""")
def let_slide(
    system: RealRows,
    world: Int32,
    start: Int32,
    width: Int32,
    side: Int32,
    row: Int32,
    count: Int32,
    impulse: Vector4,
):
    """Replace the equations of two friction rows that stick by those of rows that slide.

    Their length is then the coefficient times the impulse of the normal, `row`, and they are along z.
    `impulse` has the impulses of the three rows, and the coefficient.
    """
    ...


@wp.func_native("""
    auto* rows = &wp::index(system, world, start);
    auto* x = &wp::index(entries, world, side);
    const int used = (count + 3) / 4;
    for (int k = 0; k < count; ++k) {
        const auto* own = rows + k * blocks;
        const auto pivot = own[k / 4][k % 4];
        // Effective masses make the diagonal about 1; that of friction that slides may be negative.
        if (!(pivot > 1e-8 || pivot < -1e-8))
            return 0;
        const auto inverse = 1.0 / pivot;
        for (int i = k + 1; i < count; ++i) {
            auto* other = rows + i * blocks;
            const auto factor = other[k / 4][k % 4] * inverse;
            x[i] -= factor * x[k];
            #pragma clang loop vectorize(disable)
            for (int block = (k + 1) / 4; block < used; ++block)
                other[block] = wp::sub(other[block], wp::mul(factor, own[block]));
        }
    }
    for (int k = count - 1; k >= 0; --k) {
        const auto* own = rows + k * blocks;
        auto sum = x[k];
        for (int j = k + 1; j < count; ++j)
            sum -= own[j / 4][j % 4] * x[j];
        x[k] = sum / own[k / 4][k % 4];
        if (!(x[k] - x[k] == 0.0))
            return 0;
    }
    return 1;
""")
def eliminate(
    system: Vector4Rows,
    entries: RealRows,
    world: Int32,
    start: Int32,
    blocks: Int32,
    side: Int32,
    count: Int32,
) -> Int32:
    """Solve `count` equations, whose rows are `blocks` blocks apart.

    The solution takes the place of the right side, from `side` of the same numbers, `entries`, on.

    Returns 0 if they have no solution, or one that is not finite; 1 otherwise.
    """
    ...
