"""Bounds of friction that follow the normal impulses, by Newton's method around the convex problem.

Coulomb's bound of a disc that slides is μ λ_n, and λ_n changes with the impulse of the disc itself. With the
Hessian H of the problem of given bounds, ∂λ_n/∂bound = (1/R_n) J_n H⁻¹ J_tᵀ û, û the direction of sliding.
"""

import warp as wp

from carom.kernels.newton.equations import PRECISION, converge, factorise_hessian, solve_hessian
from carom.kernels.newton.law import row_product
from carom.kernels.structs import NewtonWork, PairRows
from carom.kernels.types import Int32, RealRows, func, real
from carom.layouts.newton import BOUNDED, DISC, PLACES, ROWS, SHORT

# Rounds of a substep, and the change of bounds at which they end, relative to the greatest normal impulse.
_MOST_ROUNDS = 12
_PRECISION = real(1e-8)
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
def add_direction(work: NewtonWork, pair_rows: PairRows, world: Int32, row: Int32):
    """Write Jᵀ û of a row that slides into `vector_temporary`."""
    for i in range(4 * work.count_newton[world, PLACES]):
        work.vector_temporary[world, i] = real(0.0)
    rows = Int32(1)
    if work.newton_row[world, row].kind == DISC:
        rows = Int32(2)
    for k in range(rows):
        amount = work.newton_row[world, row + k].direction
        if rows == 1:
            amount = wp.where(work.newton_row[world, row].rate > 0.0, real(1.0), real(-1.0))
        start = 4 * work.newton_row[world, row + k].start
        place = 4 * work.newton_row[world, row + k].place_a
        length = 4 * work.newton_row[world, row + k].blocks_a
        for i in range(length):
            work.vector_temporary[world, place + i] += amount * pair_rows.entry_row[world, start + i]
        start += length
        place = 4 * work.newton_row[world, row + k].place_b
        for i in range(4 * work.newton_row[world, row + k].blocks_b):
            work.vector_temporary[world, place + i] += amount * pair_rows.entry_row[world, start + i]


@func
def improve_bounds(
    work: NewtonWork, pair_rows: PairRows, world: Int32, entries: Int32, may_stick: bool
) -> Int32:
    """Set all bounds by a step of Newton's method; returns the number of factorisations.

    Where a larger bound lets the normal press by more than that (a jam), Newton's method points away from the
    solution, in which the row sticks: it gets no bound if it `may_stick`, else that of its normal.
    """
    count = list_sliding(work, world)
    if count * (count + 1) > work.system_entry.shape[1]:
        work.count_newton[world, SHORT] = 1
        count = Int32(0)
    solved = Int32(0)
    if count > 0:
        solved = factorise_hessian(work, pair_rows, world, entries)
    size = 4 * work.count_newton[world, PLACES]
    width = count + 1
    if solved == 1:
        for j in range(count):
            add_direction(work, pair_rows, world, work.sliding_row[world, j])
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
            work.system_entry[world, i * width + count] = (
                bound_by_normal(work, world, row) - work.newton_row[world, row].upper
            )
        solved = eliminate_system(work.system_entry, world, count, width)
    for row in range(work.count_newton[world, ROWS]):
        # Those that slide come below, from the bounds before.
        if follows_normal(work, world, row):
            work.newton_row[world, row].first = bound_by_normal(work, world, row)
    if solved == 1:
        for i in range(count):
            row = work.sliding_row[world, i]
            present, wanted = work.newton_row[world, row].upper, bound_by_normal(work, world, row)
            change = work.system_entry[world, i * width + count]
            if wanted > present and change <= 0.0:
                work.newton_row[world, row].first = wp.where(may_stick, _ANY, wanted)
            else:
                work.newton_row[world, row].first = wp.max(present + change, 0.0)
    for row in range(work.count_newton[world, ROWS]):
        if follows_normal(work, world, row):
            set_bound(work, world, row, work.newton_row[world, row].first)
    return Int32(1) if count > 0 else Int32(0)


@func
def solve_with_bounds(work: NewtonWork, pair_rows: PairRows, world: Int32, entries: Int32) -> Int32:
    """Solve an island, from the residuals and bounds in its rows; returns as `converge`."""
    iterations = converge(work, pair_rows, world, entries, Int32(1), PRECISION)
    rounds = Int32(1)
    while iterations >= 0 and rounds < _MOST_ROUNDS and bound_error(work, world) > _PRECISION:
        rounds += 1
        iterations += improve_bounds(work, pair_rows, world, entries, rounds <= _MOST_STICKING)
        more = converge(work, pair_rows, world, entries, Int32(0), PRECISION)
        iterations = wp.where(more < 0, more, iterations + more)
    return iterations
