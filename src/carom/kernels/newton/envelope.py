"""Symmetric matrices over the dofs of an island, in blocks of 4 x 4, by the envelope of their upper triangle.

Written in C++, as `maths.blocks` and for the same reason. A row of blocks goes from its diagonal to the last
block that may not be 0. Elimination begins at the last dof, so from leaves to roots in each tree: a branch
fills in nothing beside another one, and the factor has the same envelope. A block is stored by columns: the
product of one with the transpose of another is a sum of multiples of columns.
"""

import warp as wp

from carom.kernels.structs import NewtonRows
from carom.kernels.types import Int32, IntRows, RealRows, Vector4Rows

__all__ = [
    "clear_entries",
    "copy_entries",
    "factorise_envelope",
    "fit_envelope",
    "multiply_mass",
    "solve_envelope",
]


@wp.func_native("""
    auto* ends = &wp::index(last, world, 0);
    auto* place = &wp::index(start, world, 0);
    const auto* rows = &wp::index(row, world, 0);
    const auto* blocks = jacobian.shape[1] > 0 ? &wp::index(jacobian, world, 0) : nullptr;
    const auto is_empty = [&](int block) {
        const auto& part = blocks[block];
        return part[0] == 0.0 && part[1] == 0.0 && part[2] == 0.0 && part[3] == 0.0;
    };
    for (int r = 0; r < count; ++r) {
        const auto& own = rows[r];
        // A contact with the world acts on the dofs from a link to the root, which couples nothing else.
        if (own.start < 0 || (own.origin >= 2 && (own.blocks_a == 0 || own.blocks_b == 0)))
            continue;
        if (r > 0 && own.blocks_a == 2 && own.blocks_b == 2 && rows[r - 1].start >= 0 &&
            rows[r - 1].place_a == own.place_a && rows[r - 1].place_b == own.place_b &&
            rows[r - 1].blocks_a == 2 && rows[r - 1].blocks_b == 2)
            continue;
        // Trees of two blocks are bodies of one link, as a rule.
        int end = -1;
        for (int b = 0; b < own.blocks_a; ++b)
            if (own.place_a + b > end && (own.blocks_a <= 2 || !is_empty(own.start + b)))
                end = own.place_a + b;
        for (int b = 0; b < own.blocks_b; ++b)
            if (own.place_b + b > end && (own.blocks_b <= 2 || !is_empty(own.start + own.blocks_a + b)))
                end = own.place_b + b;
        for (int b = 0; b < own.blocks_a; ++b)
            if (ends[own.place_a + b] < end && (own.blocks_a <= 2 || !is_empty(own.start + b)))
                ends[own.place_a + b] = end;
        for (int b = 0; b < own.blocks_b; ++b)
            if (ends[own.place_b + b] < end && (own.blocks_b <= 2 || !is_empty(own.start + own.blocks_a + b)))
                ends[own.place_b + b] = end;
    }
    int used = 0;
    for (int i = 0; i < places; ++i) {
        place[i] = used - i;
        used += ends[i] - i + 1;
        if (used > room / 16)
            return -1;
    }
    return 16 * used;
""")
def fit_envelope(
    last: IntRows,
    start: IntRows,
    row: NewtonRows,
    jacobian: Vector4Rows,
    world: Int32,
    count: Int32,
    places: Int32,
    room: Int32,
) -> Int32:
    """Widen the envelope for all rows that couple branches or trees, and place its rows of blocks.

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
    auto* to = &wp::index(target, world, 0);
    for (int i = 0; i < count; ++i)
        to[i] = 0.0;
""")
def clear_entries(target: RealRows, world: Int32, count: Int32):
    """Set the first entries to zero."""
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    four* entries = (four*)&wp::index(matrix, world, 0);
    const auto* ends = &wp::index(last, world, 0);
    const auto* starts = &wp::index(start, world, 0);
    for (int i = places - 1; i >= 0; --i) {
        four* line = entries + 4 * starts[i];
        for (int j = ends[i]; j > i; --j) {
            const four* other = entries + 4 * starts[j];
            four* own = line + 4 * j;
            four c0 = own[0], c1 = own[1], c2 = own[2], c3 = own[3];
            const int end = ends[i] < ends[j] ? ends[i] : ends[j];
            // Two sums each, so that the processor need not wait for one before it adds to it.
            four d0 = four(), d1 = four(), d2 = four(), d3 = four();
            #pragma clang loop vectorize(disable)
            for (int k = 4 * (j + 1); k < 4 * (end + 1); k += 2) {
                const four a = line[k], e = line[k + 1];
                const four &b = other[k], &f = other[k + 1];
                c0 = wp::sub(c0, wp::mul(a, b[0]));
                c1 = wp::sub(c1, wp::mul(a, b[1]));
                c2 = wp::sub(c2, wp::mul(a, b[2]));
                c3 = wp::sub(c3, wp::mul(a, b[3]));
                d0 = wp::add(d0, wp::mul(e, f[0]));
                d1 = wp::add(d1, wp::mul(e, f[1]));
                d2 = wp::add(d2, wp::mul(e, f[2]));
                d3 = wp::add(d3, wp::mul(e, f[3]));
            }
            c0 = wp::sub(c0, d0);
            c1 = wp::sub(c1, d1);
            c2 = wp::sub(c2, d2);
            c3 = wp::sub(c3, d3);
            const four* unit = other + 4 * j;
            c2 = wp::sub(c2, wp::mul(c3, unit[3][2]));
            c1 = wp::sub(wp::sub(c1, wp::mul(c3, unit[3][1])), wp::mul(c2, unit[2][1]));
            c0 = wp::sub(c0, wp::mul(c3, unit[3][0]));
            c0 = wp::sub(wp::sub(c0, wp::mul(c2, unit[2][0])), wp::mul(c1, unit[1][0]));
            own[0] = c0;
            own[1] = c1;
            own[2] = c2;
            own[3] = c3;
        }
        four* own = line + 4 * i;
        four c0 = own[0], c1 = own[1], c2 = own[2], c3 = own[3];
        for (int j = i + 1; j <= ends[i]; ++j) {
            const four* pivots = entries + 4 * (starts[j] + j);
            for (int q = 0; q < 4; ++q) {
                const four b = line[4 * j + q];
                const four a = wp::mul(b, pivots[q][q]);
                c0 = wp::sub(c0, wp::mul(a, b[0]));
                c1 = wp::sub(c1, wp::mul(a, b[1]));
                c2 = wp::sub(c2, wp::mul(a, b[2]));
                c3 = wp::sub(c3, wp::mul(a, b[3]));
                line[4 * j + q] = a;
            }
        }
        // The block on the diagonal: inverse pivots, and above them U.
        if (!(c3[3] > 0.0))
            return 0;
        const double d3 = 1.0 / c3[3];
        const double u23 = c3[2] * d3, u13 = c3[1] * d3, u03 = c3[0] * d3;
        const double h22 = c2[2] - u23 * c3[2];
        const double h12 = c2[1] - u13 * c3[2], h02 = c2[0] - u03 * c3[2];
        if (!(h22 > 0.0))
            return 0;
        const double d2 = 1.0 / h22;
        const double u12 = h12 * d2, u02 = h02 * d2;
        const double h11 = c1[1] - u13 * c3[1] - u12 * h12;
        const double h01 = c1[0] - u03 * c3[1] - u02 * h12;
        if (!(h11 > 0.0))
            return 0;
        const double d1 = 1.0 / h11;
        const double u01 = h01 * d1;
        const double h00 = c0[0] - u03 * c3[0] - u02 * h02 - u01 * h01;
        if (!(h00 > 0.0))
            return 0;
        own[0] = four(1.0 / h00, 0.0, 0.0, 0.0);
        own[1] = four(u01, d1, 0.0, 0.0);
        own[2] = four(u02, u12, d2, 0.0);
        own[3] = four(u03, u13, u23, d3);
    }
    return 1;
""")
def factorise_envelope(matrix: RealRows, last: IntRows, start: IntRows, world: Int32, places: Int32) -> Int32:
    """Replace a matrix by its factors: U D Uᵀ, U with unit diagonal, D inverted in the place of that.

    Returns 0 if the matrix is not positive definite, or not finite.
    """
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    const four* entries = (const four*)&wp::index(matrix, world, 0);
    const auto* ends = &wp::index(last, world, 0);
    const auto* starts = &wp::index(start, world, 0);
    four* x = (four*)&wp::index(vector, world, 0);
    for (int i = places - 1; i >= 0; --i) {
        const four* line = entries + 4 * starts[i];
        four sum = x[i];
        #pragma clang loop vectorize(disable)
        for (int k = i + 1; k <= ends[i]; ++k) {
            const four* block = line + 4 * k;
            const four& with = x[k];
            sum = wp::sub(sum, wp::mul(block[0], with[0]));
            sum = wp::sub(sum, wp::mul(block[1], with[1]));
            sum = wp::sub(sum, wp::mul(block[2], with[2]));
            sum = wp::sub(sum, wp::mul(block[3], with[3]));
        }
        const four* own = line + 4 * i;
        const double x3 = sum[3];
        const double x2 = sum[2] - own[3][2] * x3;
        const double x1 = sum[1] - own[3][1] * x3 - own[2][1] * x2;
        const double x0 = sum[0] - own[3][0] * x3 - own[2][0] * x2 - own[1][0] * x1;
        // What follows needs these before they are divided by pivots.
        x[i] = four(x0, x1, x2, x3);
    }
    for (int i = 0; i < places; ++i) {
        const four* own = entries + 4 * (starts[i] + i);
        x[i] = wp::cw_mul(x[i], four(own[0][0], own[1][1], own[2][2], own[3][3]));
    }
    for (int i = 0; i < places; ++i) {
        const four* line = entries + 4 * starts[i];
        const four* own = line + 4 * i;
        const four sum = x[i];
        const double x0 = sum[0];
        const double x1 = sum[1] - own[1][0] * x0;
        const double x2 = sum[2] - own[2][0] * x0 - own[2][1] * x1;
        const double x3 = sum[3] - own[3][0] * x0 - own[3][1] * x1 - own[3][2] * x2;
        const four found = four(x0, x1, x2, x3);
        x[i] = found;
        #pragma clang loop vectorize(disable)
        for (int k = i + 1; k <= ends[i]; ++k) {
            const four* block = line + 4 * k;
            for (int q = 0; q < 4; ++q) {
                const four part = wp::cw_mul(block[q], found);
                x[k][q] -= (part[0] + part[2]) + (part[1] + part[3]);
            }
        }
    }
""")
def solve_envelope(
    matrix: RealRows, last: IntRows, start: IntRows, vector: RealRows, world: Int32, places: Int32
):
    """Replace a vector by the solution of the equations whose matrix has these factors."""
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    const four* entries = (const four*)&wp::index(matrix, world, 0);
    const auto* ends = &wp::index(own, world, 0);
    const auto* starts = &wp::index(start, world, 0);
    const four* x = (const four*)&wp::index(vector, world, 0);
    four* y = (four*)&wp::index(result, world, 0);
    for (int i = 0; i < places; ++i)
        y[i] = four();
    for (int i = 0; i < places; ++i) {
        const four* line = entries + 4 * starts[i];
        const four with = x[i];
        four sum = y[i];
        #pragma clang loop vectorize(disable)
        for (int k = i; k <= ends[i]; ++k) {
            const four* block = line + 4 * k;
            const four& along = x[k];
            sum = wp::add(sum, wp::mul(block[0], along[0]));
            sum = wp::add(sum, wp::mul(block[1], along[1]));
            sum = wp::add(sum, wp::mul(block[2], along[2]));
            sum = wp::add(sum, wp::mul(block[3], along[3]));
            if (k > i)
                for (int q = 0; q < 4; ++q) {
                    const four part = wp::cw_mul(block[q], with);
                    y[k][q] += (part[0] + part[2]) + (part[1] + part[3]);
                }
        }
        y[i] = sum;
    }
""")
def multiply_mass(
    matrix: RealRows,
    own: IntRows,
    start: IntRows,
    vector: RealRows,
    result: RealRows,
    world: Int32,
    places: Int32,
):
    """Write the product of M, which couples nothing beyond the `own` last blocks of rows, with a vector."""
    ...
