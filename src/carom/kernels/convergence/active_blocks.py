"""Equations of the free rows of manifold blocks of articulated bodies; see `active_set`.

A contact that pushes has three free rows, its normal and both of friction, or one if it has no friction. The
Delassus matrices of a block, which the sweeps use, have its normals among themselves and its friction among
itself, each column down to the diagonal.
"""

import warp as wp

from carom.kernels.solver.rigid_manifolds import ManifoldBlocks
from carom.kernels.types import Index4, Int32, RealRows, Vector4, Vector4Rows, Vector8, Vector12

__all__ = ["add_block_responses", "count_free", "write_block", "write_block_change", "write_block_column"]


@wp.func_native("""
    const auto& own = wp::index(blocks, world, block);
    int free = 0;
    for (int i = 0; i < own.count; ++i)
        free += own.normal_impulse[i] > 0.0 ? (own.friction[i] > 0.0 ? 3 : 1) : 0;
    return free;
""")
def count_free(blocks: ManifoldBlocks, world: Int32, block: Int32) -> Int32:
    """How many free rows a manifold block has."""
    ...


@wp.func_native("""
    const auto& own = wp::index(blocks, world, block);
    auto* equations = &wp::index(system, world, start);
    auto* right = &wp::index(system, world, side);
    auto* mass = right + width;
    auto* inverse = mass + width;
    const auto* vectors = &wp::index(matrices, world, 0);
    const int blocks_of_both = place[1] + place[3];
    const bool itself = place[1] > 0 && place[3] > 0;
    // Rows of the equations of normals and of friction, -1 for those that are not free.
    int normal[4], lateral[8];
    int row = first;
    for (int i = 0; i < own.count; ++i) {
        const bool pushes = own.normal_impulse[i] > 0.0, rubs = pushes && own.friction[i] > 0.0;
        normal[i] = pushes ? row++ : -1;
        lateral[2 * i] = rubs ? row++ : -1;
        lateral[2 * i + 1] = rubs ? row++ : -1;
    }
    // Rows of one kind: normals, or friction.
    auto write_kind = [&](int count, const int* rows, const auto& delassus, const auto& inverse_mass,
                          const auto& wanted, auto softness) {
        for (int j = 0; j < count; ++j) {
            const int column = rows[j];
            if (column < 0)
                continue;
            inverse[column] = inverse_mass[j];
            mass[column] = 1.0 / inverse[column];
            right[column] = wanted[j];
            for (int i = 0; i < j; ++i)
                if (rows[i] >= 0) {
                    const auto lowered = delassus.data[i][j];
                    equations[column * width + rows[i]] = lowered;
                    equations[rows[i] * width + column] = lowered * inverse[column] * mass[rows[i]];
                }
            equations[column * width + column] = delassus.data[j][j] + softness(j);
        }
    };
    write_kind(own.count, normal, own.normal_delassus, own.normal_inverse_mass, own.normal_wanted,
               [&](int j) { return own.normal_softness[j]; });
    write_kind(2 * own.count, lateral, own.friction_delassus, own.friction_inverse_mass, own.friction_wanted,
               [&](int j) { return own.yields != 0 ? own.friction_softness[j] : 0.0; });
    for (int j = 0; j < own.count; ++j) {
        const int column = normal[j];
        if (column < 0)
            continue;
        wp::vec_t<4, wp::float64> low = {}, high = {};
        for (int body = 0; body < 2; ++body) {
            const int blocks_of_tree = place[2 * body + 1];
            const auto* weighted = vectors + parts[1] + 8 * place[1] * body;
            const auto* response = vectors + parts[2] + 4 * place[1] * body + j;
            const auto* other = vectors + parts[2] + 4 * place[1] * (1 - body) + j;
            #pragma clang loop vectorize(disable)
            for (int i = 0; i < blocks_of_tree; ++i) {
                auto moved = response[4 * i];
                if (itself)
                    moved = wp::add(moved, other[4 * i]);
                #pragma clang loop unroll(full)
                for (int dof = 0; dof < 4; ++dof) {
                    low = wp::add(low, wp::mul(moved[dof], weighted[8 * i + 2 * dof]));
                    if (own.count > 2)
                        high = wp::add(high, wp::mul(moved[dof], weighted[8 * i + 2 * dof + 1]));
                }
            }
        }
        for (int k = 0; k < 2 * own.count; ++k)
            if (lateral[k] >= 0) {
                const auto lowered = k < 4 ? low[k] : high[k - 4];
                equations[lateral[k] * width + column] = lowered;
                equations[column * width + lateral[k]] = lowered * inverse[lateral[k]] * mass[column];
            }
    }
    return row;
""")
def write_block(
    blocks: ManifoldBlocks,
    matrices: Vector4Rows,
    world: Int32,
    block: Int32,
    place: Index4,
    parts: Index4,
    system: RealRows,
    start: Int32,
    side: Int32,
    width: Int32,
    first: Int32,
) -> Int32:
    """Write the equations of a block's free rows, from row `first` on, as far as they are about themselves.

    `parts` are its `matrix_parts`. Returns the row after them.
    """
    ...


@wp.func_native("""
    const auto& own = wp::index(blocks, world, block);
    auto* equations = &wp::index(system, world, start);
    const auto* mass = &wp::index(system, world, side + width);
    const auto* inverse = mass + width;
    int row = first;
    for (int i = 0; i < own.count; ++i) {
        if (!(own.normal_impulse[i] > 0.0))
            continue;
        const int rows = own.friction[i] > 0.0 ? 3 : 1;
        for (int k = 0; k < rows; ++k, ++row) {
            const auto lowered = k == 0 ? normals[i] : friction[2 * i + k - 1];
            equations[row * width + column] = lowered;
            equations[column * width + row] = lowered * inverse[row] * mass[column];
        }
    }
""")
def write_block_column(
    blocks: ManifoldBlocks,
    world: Int32,
    block: Int32,
    system: RealRows,
    start: Int32,
    side: Int32,
    width: Int32,
    first: Int32,
    column: Int32,
    normals: Vector4,
    friction: Vector8,
):
    """Write the effects of another row on those of a block, which begin with `first`, and the reverse."""
    ...


@wp.func_native("""
    const auto& own = wp::index(blocks, world, block);
    auto* equations = &wp::index(system, world, start);
    const auto* mass = &wp::index(system, world, side + width);
    const auto* vectors = &wp::index(matrices, world, 0);
    const auto weight = mass[column];
    int row = first;
    for (int i = 0; i < own.count; ++i) {
        if (!(own.normal_impulse[i] > 0.0))
            continue;
        const int rows = own.friction[i] > 0.0 ? 3 : 1;
        for (int k = 0; k < rows; ++k, ++row) {
            wp::float64 moved = 0.0;
            for (int body = 0; body < 2; ++body)
                if (place[2 * body + 1] > 0) {
                    const int from = 4 * place[1] * body;
                    const auto* response = k == 0
                        ? vectors + parts[2] + from + 4 * (dof / 4) + i
                        : vectors + parts[3] + 2 * from + 8 * (dof / 4) + 2 * i + k - 1;
                    moved += (*response)[dof % 4];
                }
            equations[row * width + column] = moved * mass[row];
            equations[column * width + row] = moved * weight;
        }
    }
""")
def add_block_responses(
    blocks: ManifoldBlocks,
    matrices: Vector4Rows,
    world: Int32,
    block: Int32,
    place: Index4,
    parts: Index4,
    system: RealRows,
    start: Int32,
    side: Int32,
    width: Int32,
    first: Int32,
    column: Int32,
    dof: Int32,
):
    """As `write_block_column`, for a row over one dof of the tree: rows of the block move that dof."""
    ...


@wp.func_native("""
    auto& own = wp::index(blocks, world, block);
    const auto* x = &wp::index(system, world, first);
    int row = 0;
    wp::vec_t<12, wp::float64> change = {};
    for (int i = 0; i < own.count; ++i) {
        if (!(own.normal_impulse[i] > 0.0))
            continue;
        change[i] = x[row++];
        if (own.friction[i] > 0.0) {
            change[4 + 2 * i] = x[row++];
            change[5 + 2 * i] = x[row++];
        }
    }
    for (int i = 0; i < 4; ++i)
        own.normal_impulse[i] += change[i];
    for (int i = 0; i < 8; ++i)
        own.friction_impulse[i] += change[4 + i];
    return change;
""")
def write_block_change(
    blocks: ManifoldBlocks, world: Int32, block: Int32, system: RealRows, first: Int32
) -> Vector12:
    """Add the solution, from entry `first` on, to the impulses of a block; returns normals and friction."""
    ...
