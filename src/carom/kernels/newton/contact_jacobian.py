"""The Jacobians of up to three rows of a contact at once, for the converged solver.

That of a body of one link is written down; others go from the link to the root, once for all rows. M⁻¹ Jᵀ is
not needed: with M = Lᵀ D L, J M⁻¹ Jᵀ is the sum of y² / D for Lᵀ y = Jᵀ, which has only dofs of that walk.

Written in C++, as `maths.blocks` and for the same reason.
"""

import warp as wp

from carom.kernels.dynamics.single_body import is_single_body
from carom.kernels.solver.pair_rows import tree_blocks
from carom.kernels.structs import DofRows, Dofs, Model, NewtonRows, NewtonWork, PairRows, Scratch, State
from carom.kernels.types import Index4, Int32, Matrix3, RealRows, Vector3, Vector4Rows, func, real


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    auto* own = &wp::index(rows, world, row);
    const four* inverse = &wp::index(inverse_mass, world, block);
    const auto* dof = &wp::index(dofs, world, first);
    const auto* velocity = &wp::index(velocities, world, first);
    for (int k = 0; k < count; ++k) {
        const auto* l = linear.data[k];
        const auto* m = angular.data[k];
        four* j = &wp::index(jacobian, world, start + k * stride);
        j[0] = four(m[0], m[1], m[2], l[0]);
        j[1] = four(l[1], l[2], 0.0, 0.0);
        wp::float64 square = 0.0, rate = 0.0, forced = 0.0;
        for (int i = 0; i < 3; ++i) {
            const four& line = inverse[2 * i];
            square += m[i] * (line[0] * m[0] + line[1] * m[1] + line[2] * m[2]);
            rate += m[i] * velocity[i] + l[i] * velocity[3 + i];
            forced += m[i] * dof[i].force + l[i] * dof[3 + i].force;
        }
        square += inverse[6][3] * (l[0] * l[0] + l[1] * l[1] + l[2] * l[2]);
        own[k].inverse_mass += square;
        own[k].speed += rate;
        own[k].from_forces += forced;
    }
""")
def add_single_side(
    rows: NewtonRows,
    jacobian: Vector4Rows,
    inverse_mass: Vector4Rows,
    dofs: DofRows,
    velocities: RealRows,
    world: Int32,
    row: Int32,
    count: Int32,
    start: Int32,
    stride: Int32,
    block: Int32,
    first: Int32,
    linear: Matrix3,
    angular: Matrix3,
):
    """As `add_side`, of a body of one link: angular dofs come first."""
    ...


@wp.func_native("""
    typedef wp::vec_t<4, wp::float64> four;
    auto* own = &wp::index(rows, world, row);
    const auto* dof = &wp::index(dofs, world, first);
    const auto* velocity = &wp::index(velocities, world, first);
    const four* factors = &wp::index(factor, world, block);
    four* j = &wp::index(jacobian, world, start);
    four* y = &wp::index(work, world, room);
    for (int k = 0; k < count; ++k)
        for (int b = 0; b < blocks; ++b)
            j[k * stride + b] = four{};
    const auto* l = linear.data;
    const auto* m = angular.data;
    four rate{}, forced{}, square{};
    for (int d = last; d >= 0; d = wp::index(topology, d).parent) {
        const int i = d - first;
        const auto& s = dof[i].linear;
        const auto& w = dof[i].angular;
        four share{};
        for (int k = 0; k < 3; ++k)
            share[k] = (l[k][0] * s[0] + l[k][1] * s[1] + l[k][2] * s[2]) +
                       (m[k][0] * w[0] + m[k][1] * w[1] + m[k][2] * w[2]);
        y[i] = share;
        rate = wp::add(rate, wp::mul(share, velocity[i]));
        forced = wp::add(forced, wp::mul(share, dof[i].force));
        for (int k = 0; k < count; ++k)
            j[k * stride + i / 4][i % 4] = share[k];
    }
    for (int d = last; d >= 0; d = wp::index(topology, d).parent) {
        const int i = d - first;
        const four own_y = y[i];
        const auto* entries = factors[i * blocks].c;
        square = wp::add(square, wp::mul(wp::cw_mul(own_y, own_y), dof[i].inverse_pivot));
        for (int e = wp::index(topology, d).parent; e >= 0; e = wp::index(topology, e).parent)
            y[e - first] = wp::sub(y[e - first], wp::mul(own_y, entries[e - first]));
    }
    for (int k = 0; k < count; ++k) {
        own[k].inverse_mass += square[k];
        own[k].speed += rate[k];
        own[k].from_forces += forced[k];
    }
""")
def add_side(
    rows: NewtonRows,
    jacobian: Vector4Rows,
    work: Vector4Rows,
    factor: Vector4Rows,
    dofs: DofRows,
    topology: Dofs,
    velocities: RealRows,
    world: Int32,
    row: Int32,
    count: Int32,
    start: Int32,
    stride: Int32,
    room: Int32,
    block: Int32,
    blocks: Int32,
    first: Int32,
    last: Int32,
    linear: Matrix3,
    angular: Matrix3,
):
    """Write the part of one tree of `count` Jacobians, `stride` blocks apart, and add to what they sum up.

    Dofs are those from `last` to the root, rows of `linear` and `angular` directions, and moments about the
    reference point of the tree. One block of `work` for each dof is overwritten, from block `room` on.
    """
    ...


@func
def write_contact_jacobians(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    work: NewtonWork,
    world: Int32,
    row: Int32,
    count: Int32,
    block: Int32,
    room: Int32,
    ends: Index4,
    point: Vector3,
    linear: Matrix3,
    angular: Matrix3,
) -> Int32:
    """Write `count` rows, from `row` on, of the motion of a at a point relative to b; returns the next block.

    Rows of both matrices are the directions along which, and about which, they go. `ends` are tree and link
    of a, then of b; tree -1 is the world. Adds to `inverse_mass`, `speed` and `from_forces` of the rows; the
    last is an acceleration. From block `room` on there is room for six rows.
    """
    blocks_a, blocks_b = tree_blocks(model, ends[0]), tree_blocks(model, ends[2])
    stride = blocks_a + blocks_b
    start = block + 0
    sign = real(1.0)
    side = Int32(0)
    while side < 2:
        tree = ends[2 * side]
        blocks = wp.where(side == 0, blocks_a, blocks_b)
        if blocks > 0:
            arm = point - wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
            # Rows of a product with this are those of the matrix, each crossed: arm x direction.
            moments = sign * (angular + linear * wp.skew(-arm))
            along = sign * linear
            first, matrix = model.tree[tree].first_dof, model.tree[tree].first_block
            if is_single_body(model, tree):
                add_single_side(
                    work.newton_row, pair_rows.jacobian_row, scratch.block_inverse_mass, scratch.dof,
                    state.dof_velocity, world, row, count, start, stride, matrix, first, along, moments,
                )  # fmt: skip
            else:
                add_side(
                    work.newton_row, pair_rows.jacobian_row, pair_rows.jacobian_response,
                    scratch.block_factor, scratch.dof, model.dof, state.dof_velocity, world, row, count,
                    start, stride, room, matrix, blocks, first, model.link[ends[2 * side + 1]].nearest_dof,
                    along, moments,
                )  # fmt: skip
            start += blocks
        sign = real(-1.0)
        side += 1
    return block + count * stride
