"""Rows of the joint-space inertia matrix of a tree: entries, factorisation, solution and inverse.

Written in C++, as `maths.blocks` and for the same reason: otherwise computing addresses takes three quarters
of the time. A row is `blocks` blocks of four numbers. Only entries up to the diagonal have a meaning; the
others in the block of the diagonal are computed with them and never used.
"""

import warp as wp

from carom.kernels.structs import DofRows, Dofs
from carom.kernels.types import Int32, Vector3, Vector4Rows, real

__all__ = ["factorise_rows", "invert_rows", "keep_rows", "solve_rows", "write_full_rows", "write_row"]


@wp.func_native("""
    auto* row = &wp::index(matrix, world, start);
    for (int b = 0; b < blocks; ++b)
        row[b] = {};
    const auto* dof = &wp::index(dofs, world, 0);
    for (int i = last; i >= 0; i = wp::index(topology, i).parent)
        row->c[i - first] = wp::dot(dof[i].angular, spin) + wp::dot(dof[i].linear, push);
""")
def write_row(
    matrix: Vector4Rows,
    start: Int32,
    blocks: Int32,
    dofs: DofRows,
    topology: Dofs,
    first: Int32,
    last: Int32,
    world: Int32,
    spin: Vector3,
    push: Vector3,
):
    """Write a row of `blocks` blocks: the products of a momentum with the motion subspaces.

    Entry i is that of dof `first` + i: `last` and its ancestors; all other entries are 0.
    """
    ...


@wp.func_native("""
    const int blocks = count * ((count + 3) / 4);
    if (copy.shape[1] < start + blocks)
        return;
    const auto* from = &wp::index(matrix, world, start);
    auto* to = &wp::index(copy, world, start);
    for (int i = 0; i < blocks; ++i)
        to[i] = from[i];
""")
def keep_rows(copy: Vector4Rows, matrix: Vector4Rows, start: Int32, world: Int32, count: Int32):
    """Copy the matrix of `count` dofs if there is room for it."""
    ...


@wp.func_native("""
    const int blocks = (count + 3) / 4;
    const auto* from = &wp::index(half, world, start);
    auto* to = &wp::index(matrix, world, start);
    for (int i = 0; i < count; ++i)
        for (int j = 0; j <= i; ++j) {
            const auto entry = from[i * blocks + j / 4].c[j % 4];
            to[i * blocks + j / 4].c[j % 4] = entry;
            to[j * blocks + i / 4].c[i % 4] = entry;
        }
""")
def write_full_rows(matrix: Vector4Rows, half: Vector4Rows, start: Int32, world: Int32, count: Int32):
    """Write all entries of a symmetric matrix of which `half` has those up to the diagonal."""
    ...


@wp.func_native("""
    const int blocks = (count + 3) / 4;
    auto* rows = &wp::index(matrix, world, start);
    auto* dof = &wp::index(dofs, world, first);
    for (int k = count - 1; k >= 0; --k) {
        auto* row = rows + k * blocks;
        const auto* entries = row->c;
        decltype(least_pivot) inverse = 0.0;
        const auto is_sound = entries[k] >= least_pivot;
        if (is_sound)
            inverse = wp::where(is_sound, 1.0 / entries[k], inverse);
        dof[k].inverse_pivot = inverse;
        for (int i = 0; i < k; ++i)
            if (entries[i] != 0.0) {
                const auto is_linked = entries[i] != 0.0;
                const auto factor = -entries[i] * inverse;
                auto* target = rows + i * blocks;
                #pragma clang loop vectorize(disable)
                for (int b = 0; b <= i / 4; ++b)
                    target[b] = wp::where(is_linked, wp::add(target[b], wp::mul(factor, row[b])), target[b]);
            }
        // Last: the steps above need the row as it was.
        #pragma clang loop vectorize(disable)
        for (int b = 0; b <= k / 4; ++b)
            row[b] = wp::mul(inverse, row[b]);
    }
""")
def factorise_rows(
    matrix: Vector4Rows,
    start: Int32,
    dofs: DofRows,
    first: Int32,
    world: Int32,
    count: Int32,
    least_pivot: real,
):
    """Replace a matrix H = Lᵀ D L by L; `inverse_pivot` becomes 1 / D, or 0 if D is below `least_pivot`."""
    ...


@wp.func_native("""
    const int blocks = (count + 3) / 4;
    const auto* rows = &wp::index(matrix, world, start);
    auto* dof = &wp::index(dofs, world, first);
    for (int k = count - 1; k >= 0; --k) {
        const auto* entries = rows[k * blocks].c;
        const auto force = dof[k].force;
        for (int i = 0; i < k; ++i)
            dof[i].force -= entries[i] * force;
    }
    for (int k = 0; k < count; ++k) {
        const auto* entries = rows[k * blocks].c;
        auto acceleration = dof[k].force * dof[k].inverse_pivot;
        for (int i = 0; i < k; ++i)
            acceleration -= entries[i] * dof[i].force;
        dof[k].force = acceleration;
    }
""")
def solve_rows(matrix: Vector4Rows, start: Int32, dofs: DofRows, first: Int32, world: Int32, count: Int32):
    """Replace `force` of the dofs by the solution of Lᵀ D L x = force."""
    ...


@wp.func_native("""
    const int blocks = (count + 3) / 4;
    auto* rows = &wp::index(inverse, world, start);
    const auto* factors = &wp::index(matrix, world, start);
    const auto* dof = &wp::index(dofs, world, first);
    for (int i = 0; i < count; ++i) {
        auto* row = rows + i * blocks;
        auto* entries = row->c;
        const auto* factor = factors[i * blocks].c;
        for (int b = 0; b < blocks; ++b)
            row[b] = {};
        for (int j = 0; j < i; ++j)
            if (factor[j] != 0.0) {
                const auto is_linked = factor[j] != 0.0;
                const auto* source = rows + j * blocks;
                #pragma clang loop vectorize(disable)
                for (int b = 0; b <= i / 4; ++b)
                    row[b] = wp::where(is_linked, wp::add(row[b], wp::mul(-factor[j], source[b])), row[b]);
            }
        // Column i of the rows above is not filled yet, so the diagonal is summed separately.
        auto diagonal = dof[i].inverse_pivot;
        for (int j = 0; j < i; ++j) {
            diagonal -= factor[j] * entries[j];
            rows[j * blocks].c[i] = entries[j];
        }
        entries[i] = diagonal;
    }
""")
def invert_rows(
    inverse: Vector4Rows,
    matrix: Vector4Rows,
    start: Int32,
    dofs: DofRows,
    first: Int32,
    world: Int32,
    count: Int32,
):
    """Fill the inverse A of a matrix Lᵀ D L.

    L A = D⁻¹ L⁻ᵀ is upper triangular, which gives the rows of A one after the other:
    A[i, c] = -Σ L[i, j] A[j, c] over j < i for c < i; on the diagonal, 1 / D[i] is added.
    """
    ...
