"""The impulses of an island's rows, as functions of their residuals, and what a search needs of them.

Written in C++, as `envelope`. Kinds and states of rows are those of `layouts.newton`.
"""

import warp as wp

from carom.kernels.structs import NewtonRows
from carom.kernels.types import Int32, RealRows, Vector2, Vector4Rows, real

# Impulses f of a contact that yields, and the matrix S = −df/dx, for residuals x of its rows.
CONTACT_LAW = """
    const auto yield = [](const auto* rows, const double* x, double* f, double (*s)[6]) {
        const int size = rows->size;
        for (int i = 0; i < size; ++i) {
            f[i] = 0.0;
            for (int j = 0; j < size; ++j)
                s[i][j] = 0.0;
        }
        if (rows->kind == 5) {
            for (int edge = 0; edge < 2 * (size - 1); ++edge) {
                const int i = 1 + edge / 2;
                const double side = edge % 2 == 0 ? rows[i].friction : -rows[i].friction;
                const double y = x[0] + side * x[i];
                if (y < 0.0) {
                    const double d = 1.0 / rows->regular;
                    f[0] -= d * y;
                    f[i] -= side * d * y;
                    s[0][0] += d;
                    s[0][i] += side * d;
                    s[i][i] += side * side * d;
                }
            }
            for (int i = 1; i < size; ++i)
                s[i][0] = s[0][i];
            return 0;
        }
        // The cone is round in scaled residuals.
        const double scaled = rows->friction * wp::sqrt(rows[1].regular / rows->regular);
        double u[6], square = 0.0;
        for (int i = 1; i < size; ++i) {
            u[i] = rows[i].friction * x[i];
            square += u[i] * u[i];
        }
        const double N = scaled * x[0], T = wp::sqrt(square);
        if (N >= scaled * T)
            return 0;
        if (scaled * N + T <= 0.0) {
            for (int i = 0; i < size; ++i) {
                s[i][i] = 1.0 / rows[i].regular;
                f[i] = -s[i][i] * x[i];
            }
            return 0;
        }
        const double d = 1.0 / (rows->regular * scaled * scaled * (1.0 + scaled * scaled));
        const double rho = N - scaled * T, c = -d * scaled * rho / T;
        double g[6] = {scaled};
        for (int i = 1; i < size; ++i) {
            u[i] /= T;
            g[i] = -scaled * u[i] * rows[i].friction;
        }
        for (int i = 0; i < size; ++i) {
            f[i] = -d * rho * g[i];
            for (int j = 0; j < size; ++j)
                s[i][j] = d * g[i] * g[j];
        }
        for (int i = 1; i < size; ++i)
            for (int j = 1; j < size; ++j)
                s[i][j] += c * rows[i].friction * rows[j].friction * ((i == j ? 1.0 : 0.0) - u[i] * u[j]);
        return 0;
    };
"""

__all__ = [
    "apply_law",
    "push_by_impulses",
    "push_by_row",
    "row_product",
    "row_products",
    "search_derivatives",
]


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
    typedef wp::vec_t<4, wp::float64> four;
    const auto& own = wp::index(row, world, number);
    auto* x = &wp::index(vector, world, 0);
    if (own.start < 0) {
        x[own.place_a] += amount;
        return;
    }
    const four* part = &wp::index(jacobian, world, own.start);
    four* with = (four*)(x + 4 * own.place_a);
    for (int b = 0; b < own.blocks_a; ++b)
        with[b] = wp::add(with[b], wp::mul(amount, part[b]));
    part += own.blocks_a;
    with = (four*)(x + 4 * own.place_b);
    for (int b = 0; b < own.blocks_b; ++b)
        with[b] = wp::add(with[b], wp::mul(amount, part[b]));
""")
def push_by_row(
    row: NewtonRows, jacobian: Vector4Rows, vector: RealRows, world: Int32, number: Int32, amount: real
):
    """Add `amount` Jᵀ of one row to a vector."""
    ...


@wp.func_native(
    CONTACT_LAW
    + """
    auto* all = &wp::index(row, world, 0);
    for (int r = 0; r < count; ++r) {
        auto& own = all[r];
        if (own.kind >= 4) {
            const int size = own.size;
            double x[6], f[6], s[6][6], length[6];
            for (int i = 0; i < size; ++i)
                x[i] = all[r + i].rate;
            yield(&own, x, f, s);
            for (int i = 0; i < size; ++i) {
                all[r + i].impulse = f[i];
                length[i] = s[i][i];
                for (int j = 0; j < 6; ++j)
                    all[r + i].couplings[j] = 0.0;
            }
            for (int i = 0; i < size; ++i) {
                const double pivot = s[i][i] > 1e-12 * length[i] ? s[i][i] : 0.0;
                all[r + i].slope = pivot;
                if (pivot > 0.0) {
                    auto& l = all[r + i].couplings;
                    for (int j = i + 1; j < size; ++j)
                        l[j - i - 1] = s[i][j] / pivot;
                    for (int j = i + 1; j < size; ++j)
                        for (int k = j; k < size; ++k)
                            s[j][k] -= l[j - i - 1] * l[k - i - 1] * pivot;
                }
            }
        } else if (own.kind == 1) {
            const auto inverse = 1.0 / own.regular;
            const auto force = -own.rate * inverse;
            const bool below = force <= own.lower, above = force >= own.upper;
            own.impulse = below ? own.lower : above ? own.upper : force;
            own.state = below || above ? 1 : 0;
            own.slope = below || above ? 0.0 : inverse;
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
"""
)
def apply_law(row: NewtonRows, world: Int32, count: Int32):
    """Write impulses, states and slopes of all rows for their residuals."""
    ...


@wp.func_native(
    CONTACT_LAW
    + """
    const auto* all = &wp::index(row, world, 0);
    wp::float64 slope = 0.0, curvature = 0.0;
    for (int r = 0; r < count; ++r) {
        const auto& own = all[r];
        if (own.kind >= 4) {
            double x[6], f[6], s[6][6];
            for (int i = 0; i < own.size; ++i)
                x[i] = all[r + i].rate + step * all[r + i].along;
            yield(&own, x, f, s);
            for (int i = 0; i < own.size; ++i) {
                slope -= f[i] * all[r + i].along;
                for (int j = 0; j < own.size; ++j)
                    curvature += s[i][j] * all[r + i].along * all[r + j].along;
            }
        } else if (own.kind == 1) {
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
"""
)
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
