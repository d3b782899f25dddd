"""Islands on which only forces act that are known, so that no equations of several rows have to be solved.

An arm of servos that touches nothing, a robot in the air, a gripper before it closes: their rows are impulses
that are given, and bounds that are not reached. M⁻¹ of the free motion then gives the solution.
"""

import warp as wp

from carom.kernels.newton.envelope import clear_entries
from carom.kernels.newton.law import apply_law, push_by_impulses, row_products
from carom.kernels.structs import Model, NewtonRows, NewtonWork, PairRows, Scratch
from carom.kernels.types import Int32, RealRows, Vector4Rows, func
from carom.layouts.newton import MEMBERS, PLACES, ROWS

__all__ = ["are_idle", "may_be_idle", "moves_by_given_forces", "multiply_inverse"]


@wp.func_native("""
    const auto* all = &wp::index(row, world, 0);
    for (int r = 0; r < count; ++r) {
        const auto& own = all[r];
        if (own.kind == 1) {
            // Pushes by itself: towards the side on which its bound is not 0.
            if (own.lower != own.upper && !(own.lower == 0.0 && own.rate >= 0.0) &&
                !(own.upper == 0.0 && own.rate <= 0.0))
                return 0;
        } else if (own.kind == 2) {
            if (own.upper != 0.0)
                return 0;
        } else if (own.kind >= 4) {
            if (own.rate < 0.0)
                return 0;
        }
    }
    return 1;
""")
def may_be_idle(row: NewtonRows, world: Int32, count: Int32) -> Int32:
    """Whether the rows whose impulses are not given may have none: 0 if one has by its residual."""
    ...


@wp.func_native("""
    const auto* all = &wp::index(row, world, 0);
    for (int r = 0; r < count; ++r)
        if (all[r].impulse != 0.0 && !(all[r].kind == 1 && all[r].lower == all[r].upper))
            return 0;
    return 1;
""")
def are_idle(row: NewtonRows, world: Int32, count: Int32) -> Int32:
    """Whether no row has an impulse but those whose impulses are given."""
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    const int blocks = (count + 3) / 4;
    const four* rows = (const four*)&wp::index(inverse, world, block);
    const four* along = (const four*)(&wp::index(push, world, 0) + place);
    auto* to = &wp::index(change, world, 0) + place;
    for (int i = 0; i < count; ++i) {
        four sum = wp::cw_mul(rows[i * blocks], along[0]);
        for (int b = 1; b < blocks; ++b)
            sum = wp::add(sum, wp::cw_mul(rows[i * blocks + b], along[b]));
        to[i] = (sum[0] + sum[2]) + (sum[1] + sum[3]);
    }
    for (int i = count; i < 4 * blocks; ++i)
        to[i] = 0.0;
""")
def multiply_inverse(
    inverse: Vector4Rows,
    push: RealRows,
    change: RealRows,
    world: Int32,
    block: Int32,
    place: Int32,
    count: Int32,
):
    """Write M⁻¹ of a tree of `count` dofs, whose rows begin at `block`, times a push, both at `place`."""
    ...


@func
def moves_by_given_forces(
    model: Model, scratch: Scratch, work: NewtonWork, pair_rows: PairRows, world: Int32
) -> bool:
    """Solve an island whose rows push by given impulses alone; whether it is one.

    Writes Δv and the impulses of all rows, as `equations.converge` does. If the island is none, its rows have
    the residuals of the motion by what is given, from which they can be solved.
    """
    rows = work.count_newton[world, ROWS]
    if may_be_idle(work.newton_row, world, rows) == 0:
        return False
    apply_law(work.newton_row, world, rows)
    if are_idle(work.newton_row, world, rows) == 0:
        return False
    clear_entries(work.vector_push, world, 4 * work.count_newton[world, PLACES])
    push_by_impulses(work.newton_row, pair_rows.jacobian_row, work.vector_push, world, rows, 1.0, Int32(0))
    for member in range(work.count_newton[world, MEMBERS]):
        tree = work.tree_member[world, member]
        multiply_inverse(
            scratch.block_inverse_mass, work.vector_push, work.vector_change, world,
            model.tree[tree].first_block, 4 * work.tree_place[world, tree], model.tree[tree].dof_count,
        )  # fmt: skip
    row_products(work.newton_row, pair_rows.jacobian_row, work.vector_change, world, rows, Int32(0))
    apply_law(work.newton_row, world, rows)
    return are_idle(work.newton_row, world, rows) == 1
