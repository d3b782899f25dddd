"""Writing the rows of manifold blocks of articulated bodies; see `articulated_manifolds`."""

import warp as wp

from carom.kernels.maths.blocks import add_multiples, combine4, combine8, dot_product, fill_zero
from carom.kernels.solver.articulated_manifolds import VECTORS_PER_BLOCK, matrix_parts
from carom.kernels.solver.pair_rows import tree_blocks
from carom.kernels.solver.rigid_manifold_rows import write_row_numbers
from carom.kernels.structs import ContactTerms, Model, PairRows, Scratch, Settings, Shapes, State
from carom.kernels.types import Index4, Int32, Vector3, func, real


@func
def clear_matrices(pair_rows: PairRows, world: Int32, manifold_block: Int32):
    """Set the matrices of a manifold block to zero."""
    place = pair_rows.manifold_block[world, manifold_block].place
    fill_zero(
        pair_rows.matrix_block,
        pair_rows.manifold_block[world, manifold_block].matrices,
        world,
        VECTORS_PER_BLOCK * (place[1] + place[3]),
    )


@func
def write_matrices(
    pair_rows: PairRows,
    world: Int32,
    weighted: Int32,
    responses: Int32,
    width: Int32,
    blocks: Int32,
    row: Int32,
    mass: real,
    start: Int32,
):
    """Copy a row's Jacobian (times `mass`) and response, at block `start`, to the matrices.

    These begin at the blocks `weighted` and `responses`, and have `width` times four rows; this is `row`.
    """
    for block in range(blocks):
        jacobian = pair_rows.jacobian_row[world, start + block]
        for i in range(4):
            entry = 4 * (weighted + width * (4 * block + i)) + row
            pair_rows.entry_matrix[world, entry] = mass * jacobian[i]
        response = pair_rows.jacobian_response[world, start + block]
        pair_rows.matrix_block[world, responses + 4 * width * block + row] = response


@func
def touches_itself(place: Index4) -> bool:
    """Whether both bodies of a manifold block are one tree: what pushes one link moves the other, too."""
    return place[0] == place[2] and place[1] > 0 and place[3] > 0


@func
def write_normal_delassus(
    pair_rows: PairRows, world: Int32, manifold_block: Int32, contact: Int32, mass: real, start: Int32
):
    """Write a column of the Delassus matrix: the effect of the rows written so far on this normal row.

    It is computed from the response to this row, whose effective mass is `mass`: the matrix is symmetric
    before the multiplication by effective masses.
    """
    place = pair_rows.manifold_block[world, manifold_block].place
    part = matrix_parts(pair_rows.manifold_block[world, manifold_block].matrices, place)
    lowered = pair_rows.manifold_block[world, manifold_block].normal_share * real(0.0)
    for side in range(2):
        if place[2 * side + 1] > 0:
            lowered += combine4(
                pair_rows.matrix_block, part[0] + 4 * place[1] * side, 1, pair_rows.jacobian_response,
                start + place[1] * side, world, place[2 * side + 1],
            )  # fmt: skip
            if touches_itself(place):
                lowered += combine4(
                    pair_rows.matrix_block, part[0] + 4 * place[1] * side, 1, pair_rows.jacobian_response,
                    start + place[1] * (1 - side), world, place[2 * side + 1],
                )  # fmt: skip
    for i in range(4):
        inverse_mass = pair_rows.manifold_block[world, manifold_block].normal_inverse_mass[i]
        entry = lowered[i] * inverse_mass * mass
        pair_rows.manifold_block[world, manifold_block].normal_delassus[i, contact] = entry


@func
def write_friction_delassus(
    pair_rows: PairRows, world: Int32, manifold_block: Int32, row: Int32, mass: real, start: Int32
):
    """As `write_normal_delassus`, for friction row `row` of eight."""
    place = pair_rows.manifold_block[world, manifold_block].place
    part = matrix_parts(pair_rows.manifold_block[world, manifold_block].matrices, place)
    lowered = pair_rows.manifold_block[world, manifold_block].friction_share * real(0.0)
    for side in range(2):
        if place[2 * side + 1] > 0:
            lowered += combine8(
                pair_rows.matrix_block, part[1] + 8 * place[1] * side, pair_rows.jacobian_response,
                start + place[1] * side, world, place[2 * side + 1],
            )  # fmt: skip
            if touches_itself(place):
                lowered += combine8(
                    pair_rows.matrix_block, part[1] + 8 * place[1] * side, pair_rows.jacobian_response,
                    start + place[1] * (1 - side), world, place[2 * side + 1],
                )  # fmt: skip
    for i in range(8):
        inverse_mass = pair_rows.manifold_block[world, manifold_block].friction_inverse_mass[i]
        entry = lowered[i] * inverse_mass * mass
        pair_rows.manifold_block[world, manifold_block].friction_delassus[i, row] = entry


@func
def write_contact_jacobians(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    terms: ContactTerms,
    world: Int32,
    start: Int32,
    distance: Int32,
):
    """Write the Jacobians of a contact's three rows and their responses, as `pair_rows.write_jacobians`.

    They are stored from block `start` on, each `distance` blocks after the one before.

    Returns:
        Inverse masses and relative velocities of the rows.
    """
    inverse_mass = Vector3(0.0, 0.0, 0.0)
    velocity = Vector3(0.0, 0.0, 0.0)
    side = Int32(0)
    while side < 2:
        point = terms.point_a
        sign = real(1.0)
        if side == 1:
            point = terms.point_b
            sign = real(-1.0)
            start += tree_blocks(model, terms.ends[0])
        tree = terms.ends[2 * side]
        blocks = tree_blocks(model, tree)
        if blocks > 0:
            for row in range(3):
                fill_zero(pair_rows.jacobian_row, start + row * distance, world, blocks)
                fill_zero(pair_rows.jacobian_response, start + row * distance, world, blocks)
            arm = point - wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
            normal, lateral1, lateral2 = sign * terms.normal, sign * terms.lateral1, sign * terms.lateral2
            moment0, moment1, moment2 = (
                wp.cross(arm, normal),
                wp.cross(arm, lateral1),
                wp.cross(arm, lateral2),
            )
            first = model.tree[tree].first_dof
            matrix = model.tree[tree].first_block
            own_velocity = Vector3(0.0, 0.0, 0.0)
            dof = model.link[terms.ends[2 * side + 1]].nearest_dof
            while dof >= 0:
                linear = scratch.dof[world, dof].linear
                angular = scratch.dof[world, dof].angular
                shares = Vector3(
                    wp.dot(linear, normal) + wp.dot(angular, moment0),
                    wp.dot(linear, lateral1) + wp.dot(angular, moment1),
                    wp.dot(linear, lateral2) + wp.dot(angular, moment2),
                )
                own_velocity += shares * state.dof_velocity[world, dof]
                for row in range(3):
                    entry = 4 * (start + row * distance) + dof - first
                    pair_rows.entry_row[world, entry] = shares[row]
                add_multiples(
                    pair_rows.jacobian_response, start, distance, shares, scratch.block_inverse_mass,
                    matrix + (dof - first) * blocks, world, blocks,
                )  # fmt: skip
                dof = model.dof[dof].parent
            velocity += own_velocity
            for row in range(3):
                inverse_mass[row] += dot_product(
                    pair_rows.jacobian_row, start + row * distance, pair_rows.jacobian_response,
                    start + row * distance, world, blocks,
                )  # fmt: skip
        side += 1
    return inverse_mass, velocity


@func
def write_articulated_contact(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pair_rows: PairRows,
    terms: ContactTerms,
    world: Int32,
    manifold_block: Int32,
    contact: Int32,
    start: Int32,
):
    """Write the three rows of a contact; blocks from `start` on, for rows over two trees, are workspace."""
    place = pair_rows.manifold_block[world, manifold_block].place
    part = matrix_parts(pair_rows.manifold_block[world, manifold_block].matrices, place)
    distance = place[1] + place[3]
    inverse_masses, velocities = write_contact_jacobians(
        model, state, scratch, pair_rows, terms, world, start, distance
    )
    row = Int32(0)
    while row < 3:
        mass = write_row_numbers(
            settings, shapes, pair_rows, terms, world, manifold_block, contact, row, velocities[row],
            inverse_masses[row],
        )  # fmt: skip
        line = 2 * contact + row - 1
        for side in range(2):
            # The parts of body b come after those of body a.
            own = part + Index4(4 * place[1], 8 * place[1], 4 * place[1], 8 * place[1]) * side
            jacobian = start + place[1] * side
            blocks = place[2 * side + 1]
            if row == 0:
                write_matrices(pair_rows, world, own[0], own[2], 1, blocks, contact, mass, jacobian)
            else:
                write_matrices(pair_rows, world, own[1], own[3], 2, blocks, line, mass, jacobian)
        if row == 0:
            write_normal_delassus(pair_rows, world, manifold_block, contact, mass, start)
        else:
            write_friction_delassus(pair_rows, world, manifold_block, line, mass, start)
        start += distance
        row += 1
