"""Linear equations for the impulses of the free rows, see `active_set`.

Each is in a row of `width` numbers, from entry `start` of `entry_system` on. Behind them, from entry `side`
on, are the right sides, which become the solution, the effective masses of the rows, and their inverses:
each takes `width` numbers, too. Equations are multiplied by effective masses, so the diagonal is about 1.
"""

import warp as wp

from carom.kernels.types import Int32, RealRows, Vector4, Vector4Rows, func, real

__all__ = ["add_row", "eliminate", "let_slide", "put_both"]


@func
def add_row(
    system: RealRows,
    world: Int32,
    side: Int32,
    width: Int32,
    row: Int32,
    wanted: real,
    mass: real,
):
    """Write the right side of an equation, and the effective mass of its row."""
    system[world, side + row] = wanted
    system[world, side + width + row] = mass
    system[world, side + 2 * width + row] = 1.0 / mass


@wp.func_native("""
    auto* equations = &wp::index(system, world, start);
    const auto* mass = &wp::index(system, world, side + width);
    const auto* inverse = mass + width;
    equations[row * width + column] = change;
    equations[column * width + row] = change * inverse[row] * mass[column];
""")
def put_both(
    system: RealRows,
    world: Int32,
    start: Int32,
    side: Int32,
    width: Int32,
    row: Int32,
    column: Int32,
    change: real,
):
    """Write how a unit impulse along one row changes what another wants, and the reverse.

    Before the multiplication by effective masses the matrix is symmetric.
    """
    ...


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
    auto* numbers = &rows[0][0];
    const int width = 4 * blocks, used = (count + 3) / 4;
    auto* inverses = x + width;
    auto pivot = numbers[0];
    for (int k = 0; k < count; ++k) {
        // Effective masses make the diagonal about 1; that of friction that slides may be negative.
        if (!(pivot > 1e-8 || pivot < -1e-8))
            return 0;
        const auto inverse = 1.0 / pivot, right = x[k];
        inverses[k] = inverse;
        // Each pivot waits for the one before: the next is computed before the row that it is in.
        const auto* diagonal = numbers + k * (width + 1);
        if (k + 1 < count)
            pivot = diagonal[width + 1] - diagonal[width] * inverse * diagonal[1];
        const int first = (k + 1) / 4;
        const auto* own = rows + k * blocks + first;
        auto for_each_below = [&](auto reduce) {
            for (int i = k + 1; i < count; ++i) {
                const auto factor = numbers[i * width + k] * inverse;
                x[i] -= factor * right;
                reduce(rows + i * blocks + first, factor);
            }
        };
        // By a number of blocks that the compiler knows, which are kept in registers.
        auto reduce_by = [&](auto... block) {
            const wp::vec_t<4, wp::float64> kept[] = {block...};
            for_each_below([&](auto* other, auto factor) {
                #pragma clang loop unroll(full)
                for (unsigned i = 0; i < sizeof...(block); ++i)
                    other[i] = wp::sub(other[i], wp::mul(factor, kept[i]));
            });
        };
        switch (used - first) {
        case 0: break;
        case 1: reduce_by(own[0]); break;
        case 2: reduce_by(own[0], own[1]); break;
        case 3: reduce_by(own[0], own[1], own[2]); break;
        case 4: reduce_by(own[0], own[1], own[2], own[3]); break;
        case 5: reduce_by(own[0], own[1], own[2], own[3], own[4]); break;
        default:
            for_each_below([&](auto* other, auto factor) {
                #pragma clang loop vectorize(disable)
                for (int i = 0; i < used - first; ++i)
                    other[i] = wp::sub(other[i], wp::mul(factor, own[i]));
            });
        }
    }
    auto rest = x[count - 1];
    for (int k = count - 1; k >= 0; --k) {
        const auto value = rest * inverses[k];
        if (!(value - value == 0.0))
            return 0;
        x[k] = value;
        if (k > 0)
            rest = x[k - 1] - numbers[(k - 1) * width + k] * value;
        #pragma clang loop vectorize(disable)
        for (int i = 0; i < k; ++i)
            x[i] -= numbers[i * width + k] * value;
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

    The solution takes the place of the right side, from `side` of the same numbers, `entries`, on, and the
    inverses of the pivots that of the effective masses. Among the equations, they would be stored right
    before the vectors around them are read, which has to wait for that.

    Returns 0 if they have no solution, or one that is not finite; 1 otherwise.
    """
    ...
