"""Newton's method on the rows of an island whose bounds are given: a convex problem.

Δv minimises ½ Δvᵀ M Δv + Σ s(J Δv − b), where the impulse of a row is −ds/dx. Its Hessian is M + Jᵀ S J.
"""

import math

import warp as wp

from carom.kernels.newton.assembly import add_row_squares
from carom.kernels.newton.envelope import (
    clear_entries,
    copy_entries,
    factorise_envelope,
    multiply_mass,
    solve_envelope,
)
from carom.kernels.newton.law import apply_law, push_by_impulses, row_products, search_derivatives
from carom.kernels.structs import NewtonRows, NewtonWork, PairRows
from carom.kernels.types import Int32, RealRows, Vector2, called_func, func, real
from carom.layouts.newton import PLACES, ROWS

# The gradient at which an island is solved, relative to the impulses, both over the roots of masses.
PRECISION = real(1e-10)
# A change of velocities as small as this is none [m/s].
_STILL = real(1e-14)
MOST_ITERATIONS = 60
# A step of full length is taken if it lowers the slope to this share; else a better one is searched for.
_ENOUGH = real(0.3)
_MOST_TRIALS = 30
# A factor is used again if the last step has lowered the gradient to this share at most.
_OF_CHORDS = real(0.1)
_INDEFINITE = real(math.nan)


@wp.func_native("""
    auto* all = &wp::index(row, world, 0);
    for (int r = 0; r < count; ++r) {
        auto& own = all[r];
        if (own.kind >= 4) {
            for (int i = 0; i < own.size; ++i)
                all[r + i].first = all[r + i].impulse;
            for (int i = 0; i < own.size; ++i) {
                const auto& one = all[r + i];
                auto change = one.rate + one.target;
                for (int j = i + 1; j < own.size; ++j)
                    change += one.couplings[j - i - 1] * (all[r + j].rate + all[r + j].target);
                change *= one.slope;
                all[r + i].first += change;
                for (int j = i + 1; j < own.size; ++j)
                    all[r + j].first += one.couplings[j - i - 1] * change;
            }
        } else if (own.kind == 1)
            own.first = own.impulse + own.slope * (own.rate + own.target);
        else if (own.kind == 2) {
            auto& second = all[r + 1];
            if (own.state == 0) {
                own.first = own.impulse + own.slope * (own.rate + own.target);
                second.first = second.impulse + own.slope * (second.rate + second.target);
            } else {
                const auto across = own.direction * second.target - second.direction * own.target;
                own.first = own.impulse - own.slope * across * second.direction;
                second.first = second.impulse + own.slope * across * own.direction;
            }
        }
    }
""")
def prepare_first(row: NewtonRows, world: Int32, count: Int32):
    """Write what the equations at assumed residuals have on their right side, as impulses of rows."""
    ...


@wp.func_native("""
    const auto* g = &wp::index(gradient, world, 0);
    const auto* p = &wp::index(push, world, 0);
    const auto* s = &wp::index(scale, world, 0);
    wp::float64 left = 0.0, pushes = 0.0, impulses = 0.0;
    for (int i = 0; i < size; ++i) {
        const auto a = s[i] * g[i], b = s[i] * p[i], c = s[i] * (p[i] - g[i]);
        left += a * a;
        pushes += b * b;
        impulses += c * c;
    }
    return wp::vec_t<2, wp::float64>(wp::sqrt(left), wp::sqrt(pushes > impulses ? pushes : impulses));
""")
def gradient_size(gradient: RealRows, push: RealRows, scale: RealRows, world: Int32, size: Int32) -> Vector2:
    """Lengths of the gradient, and of the larger of M Δv and the impulses, over the roots of masses."""
    ...


@wp.func_native("""
    const auto* x = &wp::index(a, world, 0);
    const auto* y = &wp::index(b, world, 0);
    auto sum = 0.0 * x[0];
    for (int i = 0; i < size; ++i)
        sum += x[i] * y[i];
    return sum;
""")
def product(a: RealRows, b: RealRows, world: Int32, size: Int32) -> real:
    """Dot product of the first entries of two vectors."""
    ...


@wp.func_native("""
    auto* to = &wp::index(target, world, 0);
    const auto* from = &wp::index(source, world, 0);
    for (int i = 0; i < size; ++i)
        to[i] += factor * from[i];
""")
def add_vector(target: RealRows, factor: real, source: RealRows, world: Int32, size: Int32):
    """Add `factor` times a vector to another."""
    ...


@func
def factorise_hessian(work: NewtonWork, pair_rows: PairRows, world: Int32, entries: Int32) -> Int32:
    """Write the factor of M + Jᵀ S J for the present slopes; 0 if numbers are not finite."""
    copy_entries(work.matrix_hessian, work.matrix_mass, world, entries)
    add_row_squares(
        work.matrix_hessian, work.vector_start, work.newton_row, pair_rows.jacobian_row, world,
        work.count_newton[world, ROWS],
    )  # fmt: skip
    return factorise_envelope(
        work.matrix_hessian, work.vector_last, work.vector_start, world, work.count_newton[world, PLACES]
    )


@func
def is_small(sizes: Vector2, precision: real) -> bool:
    """Whether a gradient of these sizes is that of a solution."""
    return sizes[0] <= precision * sizes[1] or sizes[0] <= _STILL


@func
def is_enough(sizes: Vector2, last: real, precision: real) -> bool:
    """Whether at most two more steps with the present factor will end at a solution: chord steps.

    Each of them lowers the gradient by a share that is taken to be that of the last step.
    """
    share = sizes[0] / wp.min(last, sizes[1])
    return share <= _OF_CHORDS and share * share * sizes[0] <= precision * sizes[1]


@func
def solve_hessian(work: NewtonWork, vector: RealRows, world: Int32, size: Int32):
    """Replace a vector by H⁻¹ times it."""
    solve_envelope(work.matrix_hessian, work.vector_last, work.vector_start, vector, world, size // 4)


@called_func
def evaluate(work: NewtonWork, pair_rows: PairRows, world: Int32, rows: Int32, size: Int32) -> Vector2:
    """Write residuals, impulses and the gradient at `vector_change`; returns as `gradient_size`."""
    row_products(work.newton_row, pair_rows.jacobian_row, work.vector_change, world, rows, Int32(0))
    apply_law(work.newton_row, world, rows)
    multiply_mass(
        work.matrix_mass, work.vector_own, work.vector_start, work.vector_change, work.vector_push, world,
        size // 4,
    )  # fmt: skip
    copy_entries(work.vector_gradient, work.vector_push, world, size)
    push_by_impulses(
        work.newton_row, pair_rows.jacobian_row, work.vector_gradient, world, rows, -1.0, Int32(0)
    )
    return gradient_size(work.vector_gradient, work.vector_push, work.vector_scale, world, size)


@called_func
def search_step(work: NewtonWork, pair_rows: PairRows, world: Int32, rows: Int32, size: Int32):
    """Replace the last step, of full length, by a better one along `vector_search`."""
    add_vector(work.vector_change, -1.0, work.vector_search, world, size)
    row_products(work.newton_row, pair_rows.jacobian_row, work.vector_change, world, rows, Int32(0))
    row_products(work.newton_row, pair_rows.jacobian_row, work.vector_search, world, rows, Int32(1))
    multiply_mass(
        work.matrix_mass, work.vector_own, work.vector_start, work.vector_change, work.vector_push, world,
        size // 4,
    )  # fmt: skip
    multiply_mass(
        work.matrix_mass, work.vector_own, work.vector_start, work.vector_search, work.vector_temporary,
        world, size // 4,
    )  # fmt: skip
    linear = product(work.vector_push, work.vector_search, world, size)
    square = product(work.vector_temporary, work.vector_search, world, size)
    start = linear + search_derivatives(work.newton_row, world, rows, 0.0)[0]
    step = real(1.0)
    low, high = real(0.0), real(-1.0)
    trials = Int32(0)
    while trials < _MOST_TRIALS:
        trials += 1
        derivatives = search_derivatives(work.newton_row, world, rows, step)
        slope = linear + step * square + derivatives[0]
        if wp.abs(slope) <= _ENOUGH * wp.abs(start):
            trials = Int32(_MOST_TRIALS)
        else:
            if slope < 0.0:
                low = step + 0.0
            else:
                high = step + 0.0
            better = step - slope / (square + derivatives[1])
            if high < 0.0:
                step = wp.where(better > low, better, 2.0 * low)
            else:
                step = wp.where(better > low and better < high, better, 0.5 * (low + high))
    add_vector(work.vector_change, step, work.vector_search, world, size)


@called_func
def converge(
    work: NewtonWork, pair_rows: PairRows, world: Int32, entries: Int32, is_fresh: Int32, precision: real
) -> Int32:
    """Solve for `vector_change`, from its present value, or, if `is_fresh`, from residuals in `rate` of rows.

    Leaves impulses, states and slopes of the rows for it, and M times it in `vector_push`.

    Returns:
        Number of factorisations; `MOST_ITERATIONS` if it has not converged, negative if numbers are not
        finite.
    """
    rows = work.count_newton[world, ROWS]
    size = 4 * work.count_newton[world, PLACES]
    iterations = Int32(0)
    if is_fresh == 1:
        apply_law(work.newton_row, world, rows)
        prepare_first(work.newton_row, world, rows)
        if factorise_hessian(work, pair_rows, world, entries) == 0:
            work.vector_change[world, 0] = real(0.0) + _INDEFINITE
            return Int32(-1)
        clear_entries(work.vector_change, world, size)
        push_by_impulses(
            work.newton_row, pair_rows.jacobian_row, work.vector_change, world, rows, 1.0, Int32(1)
        )
        solve_hessian(work, work.vector_change, world, size)
        iterations += 1
    last = real(1e300)
    has_factor = is_fresh + 0
    # Slope of the objective along the last step, where that began; 0 for none.
    start = real(0.0)
    going = Int32(1)
    while going == 1:
        sizes = evaluate(work, pair_rows, world, rows, size)
        if start < 0.0 and not is_small(sizes, precision):
            slope = product(work.vector_gradient, work.vector_search, world, size)
            # Also where it is not a number.
            if not wp.abs(slope) <= -_ENOUGH * start:
                search_step(work, pair_rows, world, rows, size)
                sizes = evaluate(work, pair_rows, world, rows, size)
        if (
            is_small(sizes, precision)
            or iterations >= MOST_ITERATIONS
            or (sizes[0] >= 0.5 * last and sizes[0] <= 1e-8 * sizes[1])
        ):
            going = Int32(0)
        else:
            if has_factor == 0 or not is_enough(sizes, last, precision):
                if factorise_hessian(work, pair_rows, world, entries) == 0:
                    work.vector_change[world, 0] = real(0.0) + _INDEFINITE
                    return Int32(-1)
                iterations += 1
                has_factor = Int32(1)
            last = sizes[0]
            copy_entries(work.vector_search, work.vector_gradient, world, size)
            solve_hessian(work, work.vector_search, world, size)
            for i in range(size):
                work.vector_search[world, i] = -work.vector_search[world, i]
            start = product(work.vector_gradient, work.vector_search, world, size)
            add_vector(work.vector_change, 1.0, work.vector_search, world, size)
    return iterations
