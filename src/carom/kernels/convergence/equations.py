"""Linear equations for the impulses of the free rows, see `active_set`.

Each is in a row of `width` numbers, from entry `start` of `entry_system` on. Behind them, from entry `side`
on, are the right sides, which become the solution, the effective masses of the rows, and their inverses:
each takes `width` numbers, too. Equations are multiplied by effective masses, so the diagonal is about 1.
"""

import warp as wp

from carom.kernels.types import Int32, RealRows, Vector4, Vector4Rows, func, real

__all__ = ["add_row", "eliminate", "leave_out_slides", "note_slide", "put_both", "put_slides_back"]


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
    auto* right = &wp::index(system, world, side + row + 1);
    const auto z1 = impulse[1] + right[0], z2 = impulse[2] + right[1];
    const auto length = wp::sqrt(z1 * z1 + z2 * z2);
    if (!(length > 0.0))
        return 0;
    const auto n1 = z1 / length, n2 = z2 / length;
    const auto bound = impulse[3] * impulse[0];
    auto* slide = &wp::index(system, world, side + width) + 6 * number;
    slide[0] = row;
    slide[1] = n1;
    slide[2] = n2;
    slide[3] = impulse[3];
    slide[4] = bound - (n1 * impulse[1] + n2 * impulse[2]);
    slide[5] = bound < length ? bound / length : 1.0;
    right[0] = n2 * impulse[1] - n1 * impulse[2];
    return 1;
""")
def note_slide(
    system: RealRows,
    world: Int32,
    side: Int32,
    width: Int32,
    number: Int32,
    row: Int32,
    impulse: Vector4,
) -> Int32:
    """Note, as `number`, that the friction of the contact whose normal is `row` slides.

    `impulse` has the impulses of its three rows, and the coefficient. Notes take the place of the masses, six
    numbers each: the row, the direction of z, the coefficient, how far friction along z is below its bound,
    and the share of z that the bound leaves.

    Returns 1, or 0 if z has no direction, so that the rows stay as they are.
    """
    ...


@wp.func_native("""
    auto* equations = &wp::index(system, world, start);
    auto* x = &wp::index(system, world, side);
    const auto* slides = x + width;
    int done = 0;
    for (int row = 0; row < count; ++row) {
        const auto* next = slides + 6 * done;
        auto* from = equations + row * width;
        const bool across = done < number && row == (int)next[0] + 1;
        if (across) {
            // What turns the direction of z is across it.
            const auto first = next[5] * next[2], second = next[5] * next[1];
            for (int i = 0; i < count; ++i)
                from[i] = second * from[width + i] - first * from[i];
        } else if (done < number && row == (int)next[0] + 2) {
            ++done;
            continue;
        }
        auto* to = equations + (row - done) * width;
        auto right = x[row];
        int in = 0, out = 0;
        for (int i = 0; i < number; ++i) {
            const auto* slide = slides + 6 * i;
            const int normal = slide[0];
            #pragma clang loop vectorize(disable)
            while (in <= normal)
                to[out++] = from[in++];
            const auto first = from[in], second = from[in + 1];
            const auto along = slide[1] * first + slide[2] * second;
            to[out - 1] += slide[3] * along;
            right -= slide[4] * along;
            to[out++] = slide[1] * second - slide[2] * first;
            in += 2;
        }
        #pragma clang loop vectorize(disable)
        while (in < count)
            to[out++] = from[in++];
        if (across)
            to[row - done] += 1.0 - next[5];
        x[row - done] = right;
    }
""")
def leave_out_slides(
    system: RealRows, world: Int32, start: Int32, side: Int32, width: Int32, count: Int32, number: Int32
):
    """Leave the first `number` noted slides out of `count` equations, one row and one unknown of each.

    Friction that slides has the coefficient times the impulse of the normal along z. So what it has along z
    is not an unknown of its own; what it has across z is, and takes the place of both.
    """
    ...


@wp.func_native("""
    auto* x = &wp::index(system, world, side);
    const auto* slides = x + width;
    int left = number, in = count - number - 1;
    for (int row = count - 1; row >= 0; --row) {
        const auto* slide = slides + 6 * (left - 1);
        if (left > 0 && row == (int)slide[0] + 2) {
            const auto across = x[in--];
            const auto along = slide[3] * x[in] + slide[4];
            x[row] = slide[2] * along + slide[1] * across;
            x[--row] = slide[1] * along - slide[2] * across;
            --left;
        } else {
            x[row] = x[in--];
        }
    }
""")
def put_slides_back(system: RealRows, world: Int32, side: Int32, width: Int32, count: Int32, number: Int32):
    """Make a solution without the first `number` noted slides one of all `count` rows."""
    ...


@wp.func_native("""
    auto* rows = &wp::index(system, world, start);
    auto* x = &wp::index(entries, world, side);
    auto* numbers = &rows[0][0];
    const int width = 4 * blocks, used = (count + 3) / 4;
    for (int k = 0; k < count; ++k) {
        const auto* own = rows + k * blocks;
        const auto pivot = numbers[k * width + k];
        // Effective masses make the diagonal about 1; that of friction that slides may be negative.
        if (!(pivot > 1e-8 || pivot < -1e-8))
            return 0;
        const auto inverse = 1.0 / pivot, right = x[k];
        numbers[k * width + k] = inverse;
        for (int i = k + 1; i < count; ++i) {
            auto* other = rows + i * blocks;
            const auto factor = numbers[i * width + k] * inverse;
            x[i] -= factor * right;
            #pragma clang loop vectorize(disable)
            for (int block = (k + 1) / 4; block < used; ++block)
                other[block] = wp::sub(other[block], wp::mul(factor, own[block]));
        }
    }
    for (int k = count - 1; k >= 0; --k) {
        const auto value = x[k] * numbers[k * width + k];
        if (!(value - value == 0.0))
            return 0;
        x[k] = value;
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

    The solution takes the place of the right side, from `side` of the same numbers, `entries`, on.

    Returns 0 if they have no solution, or one that is not finite; 1 otherwise.
    """
    ...
