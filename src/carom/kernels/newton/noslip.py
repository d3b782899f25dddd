"""Passes after which friction no longer yields, as MuJoCo's `noslip_iterations`.

Contacts that yield by MuJoCo's law also yield along their faces, so what friction holds creeps. Each pass
goes through the rows of friction once, by the method of Gauss and Seidel without their softness R: a contact
gets the friction with which its faces least miss the velocity that they ask for, within the bound that its
solved normal impulse gives. Normal impulses stay.
"""

import warp as wp

from carom.kernels.newton.envelope import clear_entries, multiply_mass
from carom.kernels.newton.equations import add_vector, factorise_hessian, solve_hessian
from carom.kernels.newton.law import push_by_row, row_product
from carom.kernels.structs import Model, NewtonRows, NewtonWork, PairRows, Scratch, Settings
from carom.kernels.types import Int32, called_func, func, real
from carom.layouts.codes import FRICTION
from carom.layouts.newton import CONE, OF_JOINT, PLACES, PYRAMID, ROWS

# The decrease of the cost of accelerations at which passes end, per unit of mass.
_TOLERANCE = real(1e-12)
_LEAST = real(1e-15)


@wp.func_native("""
    auto* all = &wp::index(row, world, 0);
    for (int r = 0; r < count; ++r) {
        auto& own = all[r];
        own.slope = 0.0;
        if (own.kind == 5)
            for (int i = 1; i < own.size; ++i) {
                const auto side = all[r + i].friction * all[r + i].rate;
                const auto plus = own.rate + side, minus = own.rate - side;
                const auto edges = (plus < 0.0 ? -plus : 0.0) + (minus < 0.0 ? -minus : 0.0);
                all[r + i].upper = all[r + i].friction * edges / own.regular;
            }
        else if (own.kind == 4)
            own.upper = own.impulse;
    }
""")
def bound_friction(row: NewtonRows, world: Int32, count: Int32):
    """Keep the bounds that solved normals give: of each row of a pyramid, or the impulse of a cone's normal.

    No row has a slope any more, so that M alone is factorised.
    """
    ...


@wp.func_native("""
    auto* own = &wp::index(row, world, number);
    const int n = own->size - 1;
    double a[5][5], old[5], found[5], x[5];
    for (int i = 0; i < n; ++i) {
        old[i] = own[1 + i].impulse;
        x[i] = own[1 + i].rate;
        for (int j = 0; j < n; ++j)
            a[i][j] = own[1 + i].couplings[j];
    }
    if (own->kind == 5) {
        // One row after the other, each between its two edges.
        for (int i = 0; i < n; ++i) {
            double residual = x[i];
            for (int j = 0; j < i; ++j)
                residual += a[i][j] * (found[j] - old[j]);
            const double bound = own[1 + i].upper;
            found[i] = a[i][i] > 1e-15 ? old[i] - residual / a[i][i] : old[i];
            found[i] = wp::max(-bound, wp::min(found[i], bound));
        }
    } else {
        // In units of the coefficients the bound is a ball: min ½ gᵀ A g + cᵀ g, |g| <= the normal impulse.
        double s[5][5], c[5], g[5];
        const double most = own->upper;
        for (int i = 0; i < n; ++i) {
            c[i] = x[i];
            for (int j = 0; j < n; ++j)
                c[i] -= a[i][j] * old[j];
            c[i] *= own[1 + i].friction;
            for (int j = 0; j < n; ++j)
                s[i][j] = own[1 + i].friction * a[i][j] * own[1 + j].friction;
        }
        double least = 0.0;
        for (int i = 0; i < n; ++i)
            least = wp::max(least, s[i][i]);
        // |g(shift)| of (A + shift) g = -c falls with the shift, which is 0 within the bound.
        double shift = 1e-12 * least, length = 0.0;
        bool is_inside = false;
        for (int round = 0; round < 30; ++round) {
            double l[5][5], pivot[5], y[5], slope = 0.0;
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j <= i; ++j) {
                    double sum = s[i][j] + (i == j ? shift : 0.0);
                    for (int k = 0; k < j; ++k)
                        sum -= l[i][k] * l[j][k] * pivot[k];
                    if (i == j)
                        pivot[i] = sum > 1e-300 ? sum : 1e-300;
                    else
                        l[i][j] = sum / pivot[j];
                }
                y[i] = -c[i];
                for (int k = 0; k < i; ++k)
                    y[i] -= l[i][k] * y[k];
            }
            for (int i = 0; i < n; ++i)
                g[i] = y[i] / pivot[i];
            for (int i = n - 1; i >= 0; --i)
                for (int k = i + 1; k < n; ++k)
                    g[i] -= l[k][i] * g[k];
            length = 0.0;
            for (int i = 0; i < n; ++i)
                length += g[i] * g[i];
            length = wp::sqrt(length);
            if (length <= most * (1.0 + 1e-12)) {
                is_inside = round == 0;
                break;
            }
            // d|g|/dshift = -gᵀ (A + shift)⁻¹ g / |g|; Newton's method on 1/|g|, which is nearly linear.
            for (int i = 0; i < n; ++i) {
                y[i] = g[i];
                for (int k = 0; k < i; ++k)
                    y[i] -= l[i][k] * y[k];
                slope += y[i] * y[i] / pivot[i];
            }
            const double step = (length - most) / wp::max(most, 1e-300) * length * length / slope;
            if (!(step > 1e-14 * shift))
                break;
            shift += step;
        }
        const double scale = is_inside || length <= 0.0 ? 1.0 : most / length;
        for (int i = 0; i < n; ++i)
            found[i] = own[1 + i].friction * g[i] * scale;
    }
    double gained = 0.0;
    for (int i = 0; i < n; ++i) {
        double square = 0.0;
        for (int j = 0; j < n; ++j)
            square += a[i][j] * (found[j] - old[j]);
        gained -= (found[i] - old[i]) * (x[i] + 0.5 * square);
        own[1 + i].first = found[i] - old[i];
        own[1 + i].impulse = found[i];
    }
    return gained;
""")
def hold_contact(row: NewtonRows, world: Int32, number: Int32) -> real:
    """Give a contact the friction that holds best, for residuals in `rate` and inverse masses in `couplings`.

    Changes of impulses are in `first`. Returns by how much the cost falls.
    """
    ...


@func
def hold_joint(work: NewtonWork, pair_rows: PairRows, world: Int32, row: Int32, size: Int32) -> real:
    """Give the dry friction of a joint the impulse that holds best; returns by how much the cost falls."""
    clear_entries(work.vector_temporary, world, size)
    push_by_row(work.newton_row, pair_rows.jacobian_row, work.vector_temporary, world, row, 1.0)
    solve_hessian(work, work.vector_temporary, world, size)
    mass = row_product(work.newton_row, pair_rows.jacobian_row, work.vector_temporary, world, row)
    rate = row_product(work.newton_row, pair_rows.jacobian_row, work.vector_change, world, row)
    rate -= work.newton_row[world, row].target
    if mass <= _LEAST:
        return real(0.0)
    old = work.newton_row[world, row].impulse + 0.0
    found = wp.clamp(old - rate / mass, work.newton_row[world, row].lower, work.newton_row[world, row].upper)
    change = found - old
    work.newton_row[world, row].impulse = found
    add_vector(work.vector_change, change, work.vector_temporary, world, size)
    return -change * (rate + 0.5 * change * mass)


@func
def hold_faces(work: NewtonWork, pair_rows: PairRows, world: Int32, row: Int32, size: Int32) -> real:
    """Give a contact that yields the friction that holds best; returns by how much the cost falls."""
    count = work.newton_row[world, row].size
    for j in range(1, count):
        clear_entries(work.vector_temporary, world, size)
        push_by_row(work.newton_row, pair_rows.jacobian_row, work.vector_temporary, world, row + j, 1.0)
        solve_hessian(work, work.vector_temporary, world, size)
        for i in range(1, count):
            work.newton_row[world, row + i].couplings[j - 1] = row_product(
                work.newton_row, pair_rows.jacobian_row, work.vector_temporary, world, row + i
            )
        rate = row_product(work.newton_row, pair_rows.jacobian_row, work.vector_change, world, row + j)
        work.newton_row[world, row + j].rate = rate - work.newton_row[world, row + j].target
    gained = hold_contact(work.newton_row, world, row)
    clear_entries(work.vector_temporary, world, size)
    for j in range(1, count):
        amount = work.newton_row[world, row + j].first
        push_by_row(work.newton_row, pair_rows.jacobian_row, work.vector_temporary, world, row + j, amount)
    solve_hessian(work, work.vector_temporary, world, size)
    add_vector(work.vector_change, 1.0, work.vector_temporary, world, size)
    return gained


@func
def is_dry_friction(model: Model, scratch: Scratch, work: NewtonWork, world: Int32, row: Int32) -> bool:
    """Whether a row is the dry friction of a joint, on which something acts."""
    if work.newton_row[world, row].origin != OF_JOINT or work.newton_row[world, row].kind == 0:
        return False
    constraint = scratch.row[world, work.newton_row[world, row].source].constraint
    return model.constraint[constraint].kind == FRICTION


@called_func
def hold_by_friction(
    model: Model,
    settings: Settings,
    scratch: Scratch,
    work: NewtonWork,
    pair_rows: PairRows,
    world: Int32,
    entries: Int32,
    passes: Int32,
):
    """Make at most so many passes over the friction of a solved island; changes its Δv and impulses."""
    rows = work.count_newton[world, ROWS]
    size = 4 * work.count_newton[world, PLACES]
    bound_friction(work.newton_row, world, rows)
    if factorise_hessian(work, pair_rows, world, entries) == 0:
        return
    mass = real(0.0)
    for i in range(size):
        mass += 1.0 / (work.vector_scale[world, i] * work.vector_scale[world, i])
    # Sweeps that go on until nothing changes, as those of a step that is linearised, have the passes do so.
    enough = wp.min(_TOLERANCE, settings.residual_threshold) * mass * settings.time_step * settings.time_step
    done = Int32(0)
    while done < passes:
        gained = real(0.0)
        for row in range(rows):
            if is_dry_friction(model, scratch, work, world, row):
                gained += hold_joint(work, pair_rows, world, row, size)
        for row in range(rows):
            kind = work.newton_row[world, row].kind
            if kind == CONE or kind == PYRAMID:
                gained += hold_faces(work, pair_rows, world, row, size)
        done += 1
        if done > 1 and gained < enough:
            done = passes + 0
    multiply_mass(
        work.matrix_mass, work.vector_own, work.vector_start, work.vector_change, work.vector_push, world,
        size // 4,
    )  # fmt: skip
