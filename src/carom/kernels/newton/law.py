"""The impulses of an island's rows, as functions of their residuals, and what a search needs of them.

Written in C++, as `envelope`. Kinds and states of rows are those of `layouts.newton`.
"""

import warp as wp

from carom.kernels.structs import NewtonRows
from carom.kernels.types import Int32, RealRows, Vector2, Vector4Rows, real

__all__ = ["apply_law", "push_by_impulses", "row_product", "row_products", "search_derivatives"]


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    auto* all = &wp::index(row, world, 0);
    const auto* x = &wp::index(vector, world, 0);
    const auto* blocks = jacobian.shape[1] > 0 ? &wp::index(jacobian, world, 0) : nullptr;
    for (int r = 0; r < count; ++r) {
        auto& own = all[r];
        auto sum = 0.0 * own.target;
        if (own.start < 0)
            sum = x[own.place_a];
        else {
            const four* part = blocks + own.start;
            const four* with = (const four*)(x + 4 * own.place_a);
            four total = {};
            for (int b = 0; b < own.blocks_a; ++b)
                total = wp::add(total, wp::cw_mul(part[b], with[b]));
            part += own.blocks_a;
            with = (const four*)(x + 4 * own.place_b);
            for (int b = 0; b < own.blocks_b; ++b)
                total = wp::add(total, wp::cw_mul(part[b], with[b]));
            sum = (total[0] + total[2]) + (total[1] + total[3]);
        }
        if (along == 1)
            own.along = sum;
        else
            own.rate = sum - own.target;
    }
""")
def row_products(
    row: NewtonRows, jacobian: Vector4Rows, vector: RealRows, world: Int32, count: Int32, along: Int32
):
    """Write `along` = J vector of all rows, if `along` is 1, else their residuals: J vector − b."""
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    const auto& own = wp::index(row, world, number);
    const auto* x = &wp::index(vector, world, 0);
    if (own.start < 0)
        return x[own.place_a];
    const four* part = &wp::index(jacobian, world, own.start);
    const four* with = (const four*)(x + 4 * own.place_a);
    four total = {};
    for (int b = 0; b < own.blocks_a; ++b)
        total = wp::add(total, wp::cw_mul(part[b], with[b]));
    part += own.blocks_a;
    with = (const four*)(x + 4 * own.place_b);
    for (int b = 0; b < own.blocks_b; ++b)
        total = wp::add(total, wp::cw_mul(part[b], with[b]));
    return (total[0] + total[2]) + (total[1] + total[3]);
""")
def row_product(
    row: NewtonRows, jacobian: Vector4Rows, vector: RealRows, world: Int32, number: Int32
) -> real:
    """J vector of one row."""
    ...


@wp.func_native("""
    auto* all = &wp::index(row, world, 0);
    for (int r = 0; r < count; ++r) {
        auto& own = all[r];
        if (own.kind == 1) {
            const auto force = -own.rate / own.regular;
            const bool below = force <= own.lower, above = force >= own.upper;
            own.impulse = below ? own.lower : above ? own.upper : force;
            own.state = below || above ? 1 : 0;
            own.slope = below || above ? 0.0 : 1.0 / own.regular;
        } else if (own.kind == 2) {
            auto& second = all[r + 1];
            const auto length = wp::sqrt(own.rate * own.rate + second.rate * second.rate);
            const bool slides = length > own.regular * own.upper;
            const auto stiffness = slides ? own.upper / length : 1.0 / own.regular;
            own.impulse = -stiffness * own.rate;
            second.impulse = -stiffness * second.rate;
            own.state = second.state = slides ? 1 : 0;
            own.slope = second.slope = stiffness;
            own.direction = slides ? own.rate / length : 0.0;
            second.direction = slides ? second.rate / length : 0.0;
        } else if (own.kind == 0)
            own.impulse = own.slope = 0.0;
    }
""")
def apply_law(row: NewtonRows, world: Int32, count: Int32):
    """Write impulses, states and slopes of all rows for their residuals."""
    ...


@wp.func_native("""
    const auto* all = &wp::index(row, world, 0);
    wp::float64 slope = 0.0, curvature = 0.0;
    for (int r = 0; r < count; ++r) {
        const auto& own = all[r];
        if (own.kind == 1) {
            const auto force = -(own.rate + step * own.along) / own.regular;
            const bool below = force <= own.lower, above = force >= own.upper;
            slope -= (below ? own.lower : above ? own.upper : force) * own.along;
            if (!below && !above)
                curvature += own.along * own.along / own.regular;
        } else if (own.kind == 2) {
            const auto& second = all[r + 1];
            const auto x = own.rate + step * own.along, y = second.rate + step * second.along;
            const auto length = wp::sqrt(x * x + y * y);
            const bool slides = length > own.regular * own.upper;
            const auto stiffness = slides ? own.upper / length : 1.0 / own.regular;
            slope += stiffness * (x * own.along + y * second.along);
            auto square = own.along * own.along + second.along * second.along;
            if (slides) {
                const auto across = (x * second.along - y * own.along) / length;
                square = across * across;
            }
            curvature += stiffness * square;
        }
    }
    return wp::vec_t<2, wp::float64>(slope, curvature);
""")
def search_derivatives(row: NewtonRows, world: Int32, count: Int32, step: real) -> Vector2:
    """First and second derivative of the potential of all rows along the search, after a `step`."""
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    const auto* all = &wp::index(row, world, 0);
    auto* x = &wp::index(vector, world, 0);
    const auto* blocks = jacobian.shape[1] > 0 ? &wp::index(jacobian, world, 0) : nullptr;
    for (int r = 0; r < count; ++r) {
        const auto& own = all[r];
        const auto amount = factor * (kind == 0 ? own.impulse : own.first);
        if (amount == 0.0 || own.kind == 0)
            continue;
        if (own.start < 0) {
            x[own.place_a] += amount;
            continue;
        }
        const four* part = blocks + own.start;
        four* with = (four*)(x + 4 * own.place_a);
        for (int b = 0; b < own.blocks_a; ++b)
            with[b] = wp::add(with[b], wp::mul(amount, part[b]));
        part += own.blocks_a;
        with = (four*)(x + 4 * own.place_b);
        for (int b = 0; b < own.blocks_b; ++b)
            with[b] = wp::add(with[b], wp::mul(amount, part[b]));
    }
""")
def push_by_impulses(
    row: NewtonRows,
    jacobian: Vector4Rows,
    vector: RealRows,
    world: Int32,
    count: Int32,
    factor: real,
    kind: Int32,
):
    """Add `factor` Jᵀ times the impulses of all rows to a vector; if `kind` is 1, those of `first`."""
    ...
