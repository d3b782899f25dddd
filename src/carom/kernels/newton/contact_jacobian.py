"""The Jacobian of a row of a contact for the converged solver.

That of a body of one link is written down; others go from the link to the root, as those of the sweeps do.
"""

import warp as wp

from carom.kernels.dynamics.single_body import is_single_body
from carom.kernels.solver.pair_rows import place_row, tree_blocks, write_jacobian
from carom.kernels.structs import Model, PairRows, Scratch, State
from carom.kernels.types import Index4, Int32, Vector3, Vector4, func, real


@func
def write_single_jacobian(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
    point: Vector3,
    linear: Vector3,
    angular: Vector3,
    start: Int32,
):
    """As `write_jacobian`, of a body of one link, without its response: angular dofs come first."""
    reference = wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
    moment = wp.cross(point - reference, linear) + angular
    pair_rows.jacobian_row[world, start] = Vector4(moment[0], moment[1], moment[2], linear[0])
    pair_rows.jacobian_row[world, start + 1] = Vector4(linear[1], linear[2], 0.0, 0.0)
    block = model.tree[tree].first_block
    first = scratch.block_inverse_mass[world, block]
    second = scratch.block_inverse_mass[world, block + 2]
    third = scratch.block_inverse_mass[world, block + 4]
    turned = Vector3(
        first[0] * moment[0] + first[1] * moment[1] + first[2] * moment[2],
        second[0] * moment[0] + second[1] * moment[1] + second[2] * moment[2],
        third[0] * moment[0] + third[1] * moment[1] + third[2] * moment[2],
    )
    inverse_mass = (
        wp.dot(turned, moment) + wp.dot(linear, linear) * (scratch.block_inverse_mass[world, block + 6][3])
    )
    dof = model.tree[tree].first_dof
    spin = Vector3(
        state.dof_velocity[world, dof],
        state.dof_velocity[world, dof + 1],
        state.dof_velocity[world, dof + 2],
    )
    speed = Vector3(
        state.dof_velocity[world, dof + 3],
        state.dof_velocity[world, dof + 4],
        state.dof_velocity[world, dof + 5],
    )
    velocity = wp.dot(spin, moment) + wp.dot(speed, linear)
    return inverse_mass, velocity


@func
def write_contact_jacobian(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    row: Int32,
    block: Int32,
    ends: Index4,
    point: Vector3,
    linear: Vector3,
    angular: Vector3,
):
    """Write the row of the motion of a at a point relative to b, along or about an axis.

    `ends` are tree and link of a, then of b; tree -1 is the world. It begins at `block`.

    Returns:
        Inverse mass, relative velocity, and the next free block.
    """
    after = place_row(model, pair_rows, world, row, ends[0], ends[2], block)
    inverse_mass, velocity = real(0.0), real(0.0)
    start = block + 0
    sign = real(1.0)
    side = Int32(0)
    while side < 2:
        tree = ends[2 * side]
        if tree >= 0:
            of_side, speed = real(0.0), real(0.0)
            if is_single_body(model, tree):
                of_side, speed = write_single_jacobian(
                    model, state, scratch, pair_rows, world, tree, point, sign * linear, sign * angular, start
                )
            else:
                of_side, speed = write_jacobian(
                    model, state, scratch, pair_rows, world, tree, ends[2 * side + 1], point, sign * linear,
                    sign * angular, start,
                )  # fmt: skip
            inverse_mass += of_side
            velocity += speed
            start += tree_blocks(model, tree)
        sign = real(-1.0)
        side += 1
    return inverse_mass, velocity, after
