"""Solution of linear equations with a symmetric matrix and added damping, by Cholesky decomposition.

Written in C++ for the reason given in `maths.blocks`.
"""

import warp as wp

from carom.kernels.types import Int32, Reals, real

__all__ = ["solve_damped"]


@wp.func_native("""
    const auto* kd = &wp::index(damping, 0);
    auto* factors = &wp::index(factor, 0);
    auto* x = &wp::index(solution, 0);
    for (int i = first; i < count; ++i) {
        auto* row = factors + i * count;
        const auto* given = &wp::index(matrix, i * count);
        const auto inertia = given[i] + time_step * kd[i];
        for (int k = first; k < i; ++k)
            row[k] = given[k];
        row[i] = inertia;
        auto value = wp::index(forces, i) - wp::index(bias, i);
        for (int k = first; k < i; ++k) {
            auto* __restrict__ upper = factors + k * count;
            const auto entry = row[k] * upper[k];
            upper[i] = entry;
            value -= entry * x[k];
            for (int j = k + 1; j <= i; ++j)
                row[j] -= entry * upper[j];
        }
        row[i] = inertia > 0.0 ? 1.0 / wp::sqrt(row[i]) : 0.0;
        x[i] = value * row[i];
    }
    for (int i = count - 1; i >= first; --i) {
        const auto* row = factors + i * count;
        auto value = x[i];
        for (int k = i + 1; k < count; ++k)
            value -= row[k] * x[k];
        x[i] = value * row[i];
    }
""")
def solve_damped(
    matrix: Reals,
    damping: Reals,
    time_step: real,
    forces: Reals,
    bias: Reals,
    factor: Reals,
    solution: Reals,
    first: Int32,
    count: Int32,
):
    """Solve (M + dt diag(damping)) x = forces - bias, with row-major `matrix`, for the rows from `first` on.

    `factor` becomes the upper triangle Lᵀ, with the reciprocals of its diagonal, 0 for dofs without inertia;
    its lower triangle is workspace.
    """
    ...
