"""Symmetric matrices over the dofs of an island, by the envelope of their lower triangle.

Written in C++, as `maths.blocks` and for the same reason. A row begins at a multiple of four, and Cholesky's
factor has the same envelope: no entry before the first one of its row is ever filled in.
"""

import warp as wp

from carom.kernels.structs import DofRows, NewtonRows
from carom.kernels.types import Int32, IntRows, RealRows, Vector4Rows, real

__all__ = [
    "add_row_squares",
    "copy_entries",
    "factorise_envelope",
    "fit_envelope",
    "mass_of_factor",
    "multiply_envelope",
    "solve_envelope",
]


@wp.func_native("""
    auto* begin = &wp::index(first, world, 0);
    auto* place = &wp::index(start, world, 0);
    const auto* rows = &wp::index(row, world, 0);
    for (int r = 0; r < count; ++r) {
        const auto& own = rows[r];
        if (own.blocks_a > 0 && own.blocks_b > 0 && own.place_a != own.place_b) {
            const bool is_a = own.place_a > own.place_b;
            const int high = is_a ? own.place_a : own.place_b, low = is_a ? own.place_b : own.place_a;
            const int blocks = is_a ? own.blocks_a : own.blocks_b;
            for (int i = 4 * high; i < 4 * (high + blocks); ++i)
                if (begin[i] > 4 * low)
                    begin[i] = 4 * low;
        }
    }
    long long end = 0;
    for (int i = 0; i < size; ++i) {
        place[i] = (int)(end - begin[i]);
        end += 4 * (i / 4 + 1) - begin[i];
        if (end > room)
            return -1;
    }
    return (int)end;
""")
def fit_envelope(
    first: IntRows, start: IntRows, row: NewtonRows, world: Int32, count: Int32, size: Int32, room: Int32
) -> Int32:
    """Widen the envelope for all rows over two trees, and place its rows one after the other.

    Returns the number of entries, -1 if these are more than there is `room` for.
    """
    ...


@wp.func_native("""
    auto* to = &wp::index(target, world, 0);
    const auto* from = &wp::index(source, world, 0);
    for (int i = 0; i < count; ++i)
        to[i] = from[i];
""")
def copy_entries(target: RealRows, source: RealRows, world: Int32, count: Int32):
    """Copy the first entries."""
    ...


@wp.func_native("""
    const int blocks = (count + 3) / 4;
    auto* entries = &wp::index(matrix, world, 0);
    const auto* starts = &wp::index(start, world, 0);
    const auto* rows = &wp::index(factor, world, block);
    const auto* dof = &wp::index(dofs, world, first_dof);
    for (int k = 0; k < count; ++k) {
        const auto* row = rows[k * blocks].c;
        const auto inverse = dof[k].inverse_pivot;
        const auto pivot = inverse > 0.0 ? 1.0 / inverse : immovable;
        for (int i = 0; i <= k; ++i) {
            const auto weighted = i == k ? pivot : row[i] * pivot;
            if (weighted != 0.0) {
                auto* target = entries + starts[4 * place + i] + 4 * place;
                for (int j = 0; j <= i; ++j)
                    target[j] += weighted * (j == k ? 1.0 : row[j]);
            }
        }
    }
    for (int i = count; i < 4 * blocks; ++i)
        entries[starts[4 * place + i] + 4 * place + i] = 1.0;
""")
def mass_of_factor(
    matrix: RealRows,
    start: IntRows,
    factor: Vector4Rows,
    block: Int32,
    dofs: DofRows,
    first_dof: Int32,
    world: Int32,
    place: Int32,
    count: Int32,
    immovable: real,
):
    """Add M = Lᵀ D L of a tree, from its factor, at `place`; dofs without inertia get an `immovable` one."""
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    auto* entries = &wp::index(matrix, world, 0);
    const auto* starts = &wp::index(start, world, 0);
    const auto* all = &wp::index(row, world, 0);
    const int width = jacobian.shape[1];
    const auto* blocks = width > 0 ? &wp::index(jacobian, world, 0) : nullptr;
    for (int r = 0; r < count; ++r) {
        const auto& own = all[r];
        if (own.kind == 0 || own.kind == 3)
            continue;
        if (own.start < 0) {
            if (own.slope != 0.0)
                entries[starts[own.place_a] + own.place_a] += own.slope;
            continue;
        }
        const int length = own.blocks_a + own.blocks_b;
        // A disc that sticks has two such terms; one that slides has one, across its direction. Contacts that
        // yield have one for each row, over it and those after it.
        const bool is_contact = own.kind >= 4;
        const bool slides = own.kind == 2 && own.state == 1;
        const int terms = is_contact ? own.size : own.kind == 2 && !slides ? 2 : 1;
        for (int term = 0; term < terms; ++term) {
            const auto slope = is_contact ? all[r + term].slope : own.slope;
            if (slope == 0.0)
                continue;
            const four* one = blocks + own.start + term * length;
            const int extent = slides ? 2 : is_contact ? own.size - term : 1;
            double c[6] = {slides ? -all[r + 1].direction : 1.0, slides ? own.direction : 0.0};
            if (is_contact)
                for (int k = 1; k < extent; ++k)
                    c[k] = all[r + term].couplings[k - 1];
            for (int side = 0; side < 2; ++side) {
                const int place = side == 0 ? own.place_a : own.place_b;
                const int size = side == 0 ? own.blocks_a : own.blocks_b;
                const int offset = side == 0 ? 0 : own.blocks_a;
                for (int i = 0; i < 4 * size; ++i) {
                    double share = 0.0;
                    for (int k = 0; k < extent; ++k)
                        share += c[k] * one[k * length + offset + i / 4][i % 4];
                    share *= slope;
                    if (share == 0.0)
                        continue;
                    const int at = 4 * place + i;
                    for (int other = 0; other < 2; ++other) {
                        const int there = other == 0 ? own.place_a : own.place_b;
                        const int columns = other == 0 ? own.blocks_a : own.blocks_b;
                        const int from = other == 0 ? 0 : own.blocks_a;
                        if (columns == 0 || there > at / 4)
                            continue;
                        auto* target = (four*)(entries + starts[at] + 4 * there);
                        // The entries behind the diagonal, in its own block, are never used.
                        const int end = columns < at / 4 - there + 1 ? columns : at / 4 - there + 1;
                        for (int k = 0; k < extent; ++k) {
                            const four* along = one + k * length + from;
                            #pragma clang loop vectorize(disable)
                            for (int b = 0; b < end; ++b)
                                target[b] = wp::add(target[b], wp::mul(share * c[k], along[b]));
                        }
                    }
                }
            }
        }
    }
""")
def add_row_squares(
    matrix: RealRows,
    start: IntRows,
    row: NewtonRows,
    jacobian: Vector4Rows,
    world: Int32,
    count: Int32,
):
    """Add Jᵀ S J, where S has the slopes of all rows."""
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    auto* entries = &wp::index(matrix, world, 0);
    const auto* begins = &wp::index(first, world, 0);
    const auto* starts = &wp::index(start, world, 0);
    for (int i = 0; i < size; ++i) {
        auto* row = entries + starts[i];
        const int begin = begins[i];
        auto square = 0.0 * row[i];
        for (int j = begin; j <= i; ++j) {
            const auto* other = entries + starts[j];
            int k = begin > begins[j] ? begin : begins[j];
            auto sum = row[j];
            if (k + 4 <= j) {
                four part = wp::cw_mul(*(const four*)(row + k), *(const four*)(other + k));
                #pragma clang loop vectorize(disable)
                for (k += 4; k + 4 <= j; k += 4)
                    part = wp::add(part, wp::cw_mul(*(const four*)(row + k), *(const four*)(other + k)));
                sum -= (part[0] + part[2]) + (part[1] + part[3]);
            }
            for (; k < j; ++k)
                sum -= row[k] * other[k];
            if (j < i)
                row[j] = sum / other[j];
            else if (sum > 0.0)
                row[i] = wp::sqrt(sum);
            else
                return 0;
        }
    }
    return 1;
""")
def factorise_envelope(matrix: RealRows, first: IntRows, start: IntRows, world: Int32, size: Int32) -> Int32:
    """Replace a matrix by its Cholesky factor; 0 if it is not positive definite, or not finite."""
    ...


@wp.func_native("""
    const auto* entries = &wp::index(matrix, world, 0);
    const auto* begins = &wp::index(first, world, 0);
    const auto* starts = &wp::index(start, world, 0);
    auto* x = &wp::index(vector, world, 0);
    for (int i = 0; i < size; ++i) {
        const auto* row = entries + starts[i];
        auto sum = x[i];
        for (int k = begins[i]; k < i; ++k)
            sum -= row[k] * x[k];
        x[i] = sum / row[i];
    }
    for (int i = size - 1; i >= 0; --i) {
        const auto* row = entries + starts[i];
        x[i] = x[i] / row[i];
        const auto value = x[i];
        for (int k = begins[i]; k < i; ++k)
            x[k] -= row[k] * value;
    }
""")
def solve_envelope(
    matrix: RealRows, first: IntRows, start: IntRows, vector: RealRows, world: Int32, size: Int32
):
    """Replace a vector by the solution of the equations whose matrix has this factor."""
    ...


@wp.func_native("""
    const auto* entries = &wp::index(matrix, world, 0);
    const auto* begins = &wp::index(first, world, 0);
    const auto* starts = &wp::index(start, world, 0);
    const auto* x = &wp::index(vector, world, 0);
    auto* y = &wp::index(result, world, 0);
    for (int i = 0; i < size; ++i) {
        const auto* row = entries + starts[i];
        auto sum = row[i] * x[i];
        for (int k = begins[i]; k < i; ++k) {
            sum += row[k] * x[k];
            y[k] += row[k] * x[i];
        }
        y[i] = sum;
    }
""")
def multiply_envelope(
    matrix: RealRows,
    first: IntRows,
    start: IntRows,
    vector: RealRows,
    result: RealRows,
    world: Int32,
    size: Int32,
):
    """Write the product of a matrix, not its factor, with a vector."""
    ...
