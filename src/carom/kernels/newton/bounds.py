"""Bounds of friction that follow the normal impulses, by Newton's method around the convex problem.

Coulomb's bound of a disc that slides is μ λ_n, and λ_n changes with the impulse of the disc itself. With the
Hessian H of the problem of given bounds, ∂λ_n/∂bound = (1/R_n) J_n H⁻¹ J_tᵀ û, û the direction of sliding.
"""

import warp as wp

from carom.kernels.newton.envelope import clear_entries, copy_entries
from carom.kernels.newton.equations import (
    PRECISION,
    add_vector,
    converge,
    factorise_hessian,
    gradient_size,
    solve_hessian,
)
from carom.kernels.newton.law import row_product
from carom.kernels.structs import NewtonWork, PairRows
from carom.kernels.types import Int32, RealRows, func, real
from carom.layouts.newton import BOUNDED, DISC, PLACES, ROWS, SHORT

# Rounds of a substep, and the change of bounds at which they end, relative to the greatest normal impulse.
_MOST_ROUNDS = 12
_PRECISION = real(1e-8)
# With bounds that are not right, the gradient is lowered to this share of their error, at most to this size.
_SHARE = real(0.01)
_LOOSE = real(1e-3)
# From this error on the factor of the round before is good enough, every other time.
_NEAR = real(1e-4)
_AT_BOUND = real(0.999999)
# Up to this round, what cannot slide is taken to stick.
_MOST_STICKING = 3
_ANY = real(1e300)


@wp.func_native("""
    auto* a = &wp::index(system, world, 0);
    for (int k = 0; k < count; ++k) {
        int pivot = k;
        for (int i = k + 1; i < count; ++i)
            if (wp::abs(a[i * width + k]) > wp::abs(a[pivot * width + k]))
                pivot = i;
        if (!(wp::abs(a[pivot * width + k]) > 1e-12))
            return 0;
        for (int j = k; j < width; ++j) {
            const auto kept = a[k * width + j];
            a[k * width + j] = a[pivot * width + j];
            a[pivot * width + j] = kept;
        }
        for (int i = k + 1; i < count; ++i) {
            const auto factor = a[i * width + k] / a[k * width + k];
            if (factor != 0.0)
                for (int j = k; j < width; ++j)
                    a[i * width + j] -= factor * a[k * width + j];
        }
    }
    for (int k = count - 1; k >= 0; --k) {
        auto sum = a[k * width + count];
        for (int j = k + 1; j < count; ++j)
            sum -= a[k * width + j] * a[j * width + count];
        a[k * width + count] = sum / a[k * width + k];
    }
    return 1;
""")
def eliminate_system(system: RealRows, world: Int32, count: Int32, width: Int32) -> Int32:
    """Solve equations whose rows have the right side behind; it becomes the solution. 0 if there is none."""
    ...


@func
def follows_normal(work: NewtonWork, world: Int32, row: Int32) -> bool:
    """Whether the bound of a row is that of friction."""
    kind = work.newton_row[world, row].kind
    return work.newton_row[world, row].bounded_by >= 0 and (kind == DISC or kind == BOUNDED)


@func
def bound_by_normal(work: NewtonWork, world: Int32, row: Int32) -> real:
    """The bound of a friction row by the present impulse of its normal, that of impacts included."""
    normal = work.newton_row[world, row].bounded_by
    impulse = work.newton_row[world, normal].impulse + work.newton_row[world, normal].impact
    return work.newton_row[world, row].friction * wp.max(impulse, 0.0)


@func
def set_bound(work: NewtonWork, world: Int32, row: Int32, bound: real):
    """Set the bound of a friction row."""
    work.newton_row[world, row].upper = bound
    if work.newton_row[world, row].kind == BOUNDED:
        work.newton_row[world, row].lower = -bound


@func
def bound_error(work: NewtonWork, world: Int32) -> real:
    """The largest error of a bound that matters, relative to the largest impulse of a normal."""
    worst, greatest = real(0.0), real(1e-12)
    for row in range(work.count_newton[world, ROWS]):
        if follows_normal(work, world, row):
            wanted = bound_by_normal(work, world, row)
            bound = work.newton_row[world, row].upper
            length = wp.abs(work.newton_row[world, row].impulse)
            if work.newton_row[world, row].kind == DISC:
                other = work.newton_row[world, row + 1].impulse
                length = wp.sqrt(length * length + other * other)
            friction = work.newton_row[world, row].friction
            if friction > 0.0:
                greatest = wp.max(greatest, wanted / friction)
            if length >= _AT_BOUND * wp.min(wanted, bound):
                worst = wp.max(worst, wp.abs(wanted - bound))
    return worst / greatest


@func
def list_sliding(work: NewtonWork, world: Int32) -> Int32:
    """List the rows that slide under normals that press; returns how many there are."""
    count = Int32(0)
    for row in range(work.count_newton[world, ROWS]):
        if follows_normal(work, world, row) and work.newton_row[world, row].state == 1:
            normal = work.newton_row[world, row].bounded_by
            if work.newton_row[world, normal].state == 0 and work.newton_row[world, normal].slope > 0.0:
                work.sliding_row[world, count] = row
                count += 1
    return count


@func
def add_direction(
    work: NewtonWork, pair_rows: PairRows, vector: RealRows, factor: real, world: Int32, row: Int32
):
    """Add `factor` Jᵀ û of a row that slides to a vector."""
    rows = Int32(1)
    if work.newton_row[world, row].kind == DISC:
        rows = Int32(2)
    for k in range(rows):
        amount = work.newton_row[world, row + k].direction
        if rows == 1:
            amount = wp.where(work.newton_row[world, row].rate > 0.0, real(1.0), real(-1.0))
        amount = factor * amount
        start = 4 * work.newton_row[world, row + k].start
        place = 4 * work.newton_row[world, row + k].place_a
        length = 4 * work.newton_row[world, row + k].blocks_a
        for i in range(length):
            vector[world, place + i] += amount * pair_rows.entry_row[world, start + i]
        start += length
        place = 4 * work.newton_row[world, row + k].place_b
        for i in range(4 * work.newton_row[world, row + k].blocks_b):
            vector[world, place + i] += amount * pair_rows.entry_row[world, start + i]


@func
def improve_bounds(
    work: NewtonWork, pair_rows: PairRows, world: Int32, entries: Int32, may_stick: bool, is_near: bool
) -> Int32:
    """Step to the solution with all bounds, by Newton's method; returns the number of factorisations.

    If it `is_near`, the present factor of H is good enough.

    Where a larger bound lets the normal press by more than that (a jam), Newton's method points away from the
    solution, in which the row sticks: it gets no bound if it `may_stick`, else that of its normal.
    """
    count = list_sliding(work, world)
    if count * (count + 1) > work.system_entry.shape[1]:
        work.count_newton[world, SHORT] = 1
        count = Int32(0)
    solved = Int32(0)
    factorised = Int32(0)
    if count > 0:
        solved = Int32(1)
        if not is_near:
            factorised = Int32(1)
            solved = factorise_hessian(work, pair_rows, world, entries)
    size = 4 * work.count_newton[world, PLACES]
    width = count + 1
    if solved == 1:
        # What is left of the gradient counts as well.
        copy_entries(work.vector_search, work.vector_gradient, world, size)
        solve_hessian(work, work.vector_search, world, size)
        for j in range(count):
            clear_entries(work.vector_temporary, world, size)
            add_direction(work, pair_rows, work.vector_temporary, 1.0, world, work.sliding_row[world, j])
            solve_hessian(work, work.vector_temporary, world, size)
            for i in range(count):
                row = work.sliding_row[world, i]
                normal = work.newton_row[world, row].bounded_by
                share = row_product(
                    work.newton_row, pair_rows.jacobian_row, work.vector_temporary, world, normal
                )
                share *= work.newton_row[world, row].friction * work.newton_row[world, normal].slope
                work.system_entry[world, i * width + j] = wp.where(i == j, real(1.0), real(0.0)) - share
        for i in range(count):
            row = work.sliding_row[world, i]
            normal = work.newton_row[world, row].bounded_by
            share = row_product(work.newton_row, pair_rows.jacobian_row, work.vector_search, world, normal)
            share *= work.newton_row[world, row].friction * work.newton_row[world, normal].slope
            wanted = bound_by_normal(work, world, row) + share
            wanted -= work.newton_row[world, row].upper
            work.newton_row[world, row].along = wanted
            work.system_entry[world, i * width + count] = wanted
        solved = eliminate_system(work.system_entry, world, count, width)
    for row in range(work.count_newton[world, ROWS]):
        # Those that slide come below, from the bounds before.
        if follows_normal(work, world, row):
            work.newton_row[world, row].first = bound_by_normal(work, world, row)
    if solved == 1:
        copy_entries(work.vector_search, work.vector_gradient, world, size)
        for i in range(count):
            row = work.sliding_row[world, i]
            present, wanted = work.newton_row[world, row].upper, bound_by_normal(work, world, row)
            change = work.system_entry[world, i * width + count]
            if work.newton_row[world, row].along > 0.0 and change <= 0.0:
                work.newton_row[world, row].first = wp.where(may_stick, _ANY, wanted)
            else:
                bound = wp.max(present + change, 0.0)
                work.newton_row[world, row].first = bound
                add_direction(work, pair_rows, work.vector_search, bound - present, world, row)
        solve_hessian(work, work.vector_search, world, size)
        add_vector(work.vector_change, -1.0, work.vector_search, world, size)
    for row in range(work.count_newton[world, ROWS]):
        if follows_normal(work, world, row):
            set_bound(work, world, row, work.newton_row[world, row].first)
    return factorised


@func
def has_bounds(work: NewtonWork, world: Int32) -> bool:
    """Whether a row of the island is bounded by a normal."""
    found = Int32(0)
    for row in range(work.count_newton[world, ROWS]):
        if follows_normal(work, world, row):
            found = Int32(1)
    return found == 1


@func
def is_solved(work: NewtonWork, world: Int32) -> bool:
    """Whether the gradient is as small as it has to be."""
    sizes = gradient_size(
        work.vector_gradient, work.vector_push, work.vector_scale, world,
        4 * work.count_newton[world, PLACES],
    )  # fmt: skip
    return sizes[0] <= PRECISION * sizes[1]


@func
def solve_with_bounds(work: NewtonWork, pair_rows: PairRows, world: Int32, entries: Int32) -> Int32:
    """Solve an island, from the residuals and bounds in its rows; returns as `converge`."""
    if not has_bounds(work, world):
        return converge(work, pair_rows, world, entries, Int32(1), PRECISION)
    iterations = converge(work, pair_rows, world, entries, Int32(1), _LOOSE)
    rounds = Int32(1)
    is_exact, is_factored = Int32(0), Int32(0)
    going = Int32(1)
    while going == 1 and iterations >= 0:
        error = bound_error(work, world)
        precision = PRECISION + 0.0
        if error > _PRECISION and rounds < _MOST_ROUNDS:
            rounds += 1
            precision = wp.max(PRECISION, wp.min(_LOOSE, _SHARE * error))
            is_near = error < _NEAR and is_factored == 1
            is_factored = improve_bounds(work, pair_rows, world, entries, rounds <= _MOST_STICKING, is_near)
            iterations += is_factored
            is_exact = Int32(0)
        elif is_exact == 1 or is_solved(work, world):
            going = Int32(0)
        else:
            is_exact = Int32(1)
            # Bounds are looked at again, unless there have been too many rounds.
            rounds += 1
        if going == 1:
            more = converge(work, pair_rows, world, entries, Int32(0), precision)
            iterations = wp.where(more < 0, more, iterations + more)
    return iterations
