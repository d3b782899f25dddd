"""Products and sums over runs of blocks of four numbers, where the solver spends most of its time.

In a kernel every access to an array element computes its address, which costs more than the arithmetic.
These functions compute the address of a run once. They are written in C++, the language to which Warp
translates kernels, for CPU and GPU alike. A block is as wide as a vector instruction. So compilers are told
not to vectorise across blocks, which would need shuffles.
"""

import warp as wp

from carom.kernels.types import Int32, Vector3, Vector4, Vector4Rows, Vector8, real

__all__ = [
    "add_combination4",
    "add_combination8",
    "add_every",
    "add_multiple",
    "add_multiples",
    "combine4",
    "combine8",
    "dot_product",
    "fill_zero",
    "write_multiple",
]


@wp.func_native("""
    const auto* x = &wp::index(a, world, start_a);
    const auto* y = &wp::index(b, world, start_b);
    auto sum = wp::cw_mul(x[0], y[0]);
    #pragma clang loop vectorize(disable)
    for (int i = 1; i < count; ++i)
        sum = wp::add(sum, wp::cw_mul(x[i], y[i]));
    return (sum[0] + sum[2]) + (sum[1] + sum[3]);
""")
def dot_product(
    a: Vector4Rows, start_a: Int32, b: Vector4Rows, start_b: Int32, world: Int32, count: Int32
) -> real:
    """Dot product of `count` blocks, at least one, of two arrays."""
    ...


@wp.func_native("""
    const auto* x = &wp::index(a, world, start_a);
    auto* y = &wp::index(b, world, start_b);
    #pragma clang loop vectorize(disable)
    for (int i = 0; i < count; ++i)
        y[i] = wp::add(y[i], wp::mul(factor, x[i]));
""")
def add_multiple(
    b: Vector4Rows, start_b: Int32, factor: real, a: Vector4Rows, start_a: Int32, world: Int32, count: Int32
):
    """Add `factor` times `count` blocks of `a` to those of `b`."""
    ...


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


@wp.func_native("""
    const auto* x = &wp::index(a, world, start_a);
    auto* y = &wp::index(b, world, start_b);
    #pragma clang loop vectorize(disable)
    for (int i = 0; i < count; ++i) {
        const auto own = x[i];
        y[i] = wp::add(y[i], wp::mul(factors[0], own));
        y[i + distance] = wp::add(y[i + distance], wp::mul(factors[1], own));
        y[i + 2 * distance] = wp::add(y[i + 2 * distance], wp::mul(factors[2], own));
    }
""")
def add_multiples(
    b: Vector4Rows,
    start_b: Int32,
    distance: Int32,
    factors: Vector3,
    a: Vector4Rows,
    start_a: Int32,
    world: Int32,
    count: Int32,
):
    """As `add_multiple`, to three runs of `b` that begin `distance` blocks apart, each with its factor."""
    ...


@wp.func_native("""
    const auto* x = &wp::index(a, world, start_a);
    auto* y = &wp::index(b, world, start_b);
    #pragma clang loop vectorize(disable)
    for (int i = 0; i < count; ++i)
        y[i] = wp::mul(factor, x[i]);
""")
def write_multiple(
    b: Vector4Rows, start_b: Int32, factor: real, a: Vector4Rows, start_a: Int32, world: Int32, count: Int32
):
    """Set `count` blocks of `b` to `factor` times those of `a`, which may be the same blocks."""
    ...


@wp.func_native("""
    auto* x = &wp::index(a, world, start);
    #pragma clang loop vectorize(disable)
    for (int i = 0; i < count; ++i)
        x[i] = {};
""")
def fill_zero(a: Vector4Rows, start: Int32, world: Int32, count: Int32):
    """Set `count` blocks to zero."""
    ...


@wp.func_native("""
    const auto* x = &wp::index(a, world, start_a);
    const auto* y = &wp::index(b, world, start_b);
    auto s0 = wp::mul(y[0][0], x[0]);
    auto s1 = wp::mul(y[0][1], x[width]);
    auto s2 = wp::mul(y[0][2], x[2 * width]);
    auto s3 = wp::mul(y[0][3], x[3 * width]);
    #pragma clang loop vectorize(disable)
    for (int i = 1; i < count; ++i) {
        x += 4 * width;
        s0 = wp::add(s0, wp::mul(y[i][0], x[0]));
        s1 = wp::add(s1, wp::mul(y[i][1], x[width]));
        s2 = wp::add(s2, wp::mul(y[i][2], x[2 * width]));
        s3 = wp::add(s3, wp::mul(y[i][3], x[3 * width]));
    }
    return wp::add(wp::add(s0, s1), wp::add(s2, s3));
""")
def combine4(
    a: Vector4Rows, start_a: Int32, width: Int32, b: Vector4Rows, start_b: Int32, world: Int32, count: Int32
) -> Vector4:
    """Linear combination of vectors of `a`, with the entries of `count` blocks (at least 1) of `b`.

    The vectors are the first of every `width` blocks.
    """
    ...


@wp.func_native("""
    const auto* x = &wp::index(a, world, start_a);
    const auto* y = &wp::index(b, world, start_b);
    auto s0 = wp::mul(y[0][0], x[0]);
    auto t0 = wp::mul(y[0][0], x[1]);
    auto s1 = wp::mul(y[0][1], x[2]);
    auto t1 = wp::mul(y[0][1], x[3]);
    auto s2 = wp::mul(y[0][2], x[4]);
    auto t2 = wp::mul(y[0][2], x[5]);
    auto s3 = wp::mul(y[0][3], x[6]);
    auto t3 = wp::mul(y[0][3], x[7]);
    #pragma clang loop vectorize(disable)
    for (int i = 1; i < count; ++i) {
        x += 8;
        s0 = wp::add(s0, wp::mul(y[i][0], x[0]));
        t0 = wp::add(t0, wp::mul(y[i][0], x[1]));
        s1 = wp::add(s1, wp::mul(y[i][1], x[2]));
        t1 = wp::add(t1, wp::mul(y[i][1], x[3]));
        s2 = wp::add(s2, wp::mul(y[i][2], x[4]));
        t2 = wp::add(t2, wp::mul(y[i][2], x[5]));
        s3 = wp::add(s3, wp::mul(y[i][3], x[6]));
        t3 = wp::add(t3, wp::mul(y[i][3], x[7]));
    }
    s0 = wp::add(wp::add(s0, s1), wp::add(s2, s3));
    t0 = wp::add(wp::add(t0, t1), wp::add(t2, t3));
    return {{s0[0], s0[1], s0[2], s0[3], t0[0], t0[1], t0[2], t0[3]}};
""")
def combine8(
    a: Vector4Rows, start_a: Int32, b: Vector4Rows, start_b: Int32, world: Int32, count: Int32
) -> Vector8:
    """As `combine4`, for vectors of eight numbers, each in two consecutive blocks of `a`."""
    ...


@wp.func_native("""
    const auto* x = &wp::index(a, world, start_a);
    auto* y = &wp::index(b, world, start_b);
    #pragma clang loop vectorize(disable)
    for (int i = 0; i < count; ++i) {
        y[i] = wp::add(y[i], wp::add(
            wp::add(wp::mul(factors[0], x[0]), wp::mul(factors[1], x[1])),
            wp::add(wp::mul(factors[2], x[2]), wp::mul(factors[3], x[3]))));
        x += 4 * width;
    }
""")
def add_combination4(
    b: Vector4Rows,
    start_b: Int32,
    factors: Vector4,
    a: Vector4Rows,
    start_a: Int32,
    width: Int32,
    world: Int32,
    count: Int32,
):
    """Add to each of `count` blocks of `b` the first four of the next 4 `width` of `a`, times its factors."""
    ...


@wp.func_native("""
    const auto* x = &wp::index(a, world, start_a);
    auto* y = &wp::index(b, world, start_b);
    #pragma clang loop vectorize(disable)
    for (int i = 0; i < count; ++i) {
        y[i] = wp::add(y[i], wp::add(
            wp::add(
                wp::add(wp::mul(factors[0], x[0]), wp::mul(factors[1], x[1])),
                wp::add(wp::mul(factors[2], x[2]), wp::mul(factors[3], x[3]))),
            wp::add(
                wp::add(wp::mul(factors[4], x[4]), wp::mul(factors[5], x[5])),
                wp::add(wp::mul(factors[6], x[6]), wp::mul(factors[7], x[7])))));
        x += 8;
    }
""")
def add_combination8(
    b: Vector4Rows,
    start_b: Int32,
    factors: Vector8,
    a: Vector4Rows,
    start_a: Int32,
    world: Int32,
    count: Int32,
):
    """As `add_combination4`, with eight blocks of `a` for each of `b`."""
    ...
