"""Copies, products and zeros over runs of numbers, in C++ for the reason given in `maths.blocks`."""

import warp as wp

from carom.kernels.types import Int32, RealRows

__all__ = ["clear_run", "copy_run", "subtract_products"]


@wp.func_native("""
    const auto* x = &wp::index(a, world, start);
    auto* y = &wp::index(b, world, start);
    for (int i = 0; i < count; ++i)
        y[i] = x[i];
""")
def copy_run(b: RealRows, a: RealRows, start: Int32, world: Int32, count: Int32):
    """Set `count` numbers of `b` to those of `a`."""
    ...


@wp.func_native("""
    auto* x = &wp::index(a, world, start);
    for (int i = 0; i < count; ++i)
        x[i] = 0.0;
""")
def clear_run(a: RealRows, start: Int32, world: Int32, count: Int32):
    """Set `count` numbers to zero."""
    ...


@wp.func_native("""
    const auto* x = &wp::index(a, world, start);
    const auto* y = &wp::index(b, world, start);
    auto* z = &wp::index(c, world, start);
    for (int i = 0; i < count; ++i)
        z[i] -= x[i] * y[i];
""")
def subtract_products(c: RealRows, a: RealRows, b: RealRows, start: Int32, world: Int32, count: Int32):
    """Subtract from `count` numbers of `c` the products of those of `a` and `b`."""
    ...
