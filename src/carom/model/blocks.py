"""Runs of four-wide blocks: products and sums that the solver spends its time on.

Kernels see one element of an array at a time, and finding it costs more than the arithmetic. These
two functions find a run once; they are written in what Warp compiles kernels to, on CPU and GPU alike.
"""

import warp as wp

from carom.model.real import Int32, Vector4Rows, real

__all__ = ["add_multiple", "dot_product"]


@wp.func_native("""
    const auto* x = &wp::index(a, world, start_a);
    const auto* y = &wp::index(b, world, start_b);
    auto sum = wp::cw_mul(x[0], y[0]);
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
    for (int i = 0; i < count; ++i)
        y[i] = wp::add(y[i], wp::mul(factor, x[i]));
""")
def add_multiple(
    b: Vector4Rows, start_b: Int32, factor: real, a: Vector4Rows, start_a: Int32, world: Int32, count: Int32
):
    """Add `factor` times `count` blocks of `a` to those of `b`."""
    ...
