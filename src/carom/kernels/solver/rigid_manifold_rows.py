"""Writing the rows of manifold blocks of rigid bodies; see `rigid_manifolds`."""

import warp as wp

from carom.kernels.dynamics.rows import inverse_or_off
from carom.kernels.solver.contact_terms import lateral_change, normal_change
from carom.kernels.solver.rigid_manifolds import (
    ManifoldBlocks,
    ManifoldSides,
    combination,
    push_manifold_block,
)
from carom.kernels.structs import ContactTerms, Model, PairRows, Scratch, Settings, Shapes, State
from carom.kernels.types import Int32, Matrix8, Vector3, Vector4, Vector8, func, real


@wp.struct
class RigidBody:
    """A rigid body with the reference point of its tree; all zero if it cannot move."""

    reference: Vector3
    velocity: Vector8  # angular before linear, in world axes
    inverse_mass: Matrix8  # its last two rows and columns are zero


@func
def rigid_body(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32) -> RigidBody:
    """Data of a tree that is a rigid body; -1 is the world."""
    body = RigidBody()
    body.reference = Vector3(0.0, 0.0, 0.0)
    body.velocity = Vector8(0.0)
    body.inverse_mass = Matrix8()
    if tree >= 0 and model.tree[tree].dof_count > 0:
        body.reference = wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
        first = model.tree[tree].first_dof
        block = model.tree[tree].first_block
        for i in range(6):
            left = scratch.block_inverse_mass[world, block + 2 * i]
            right = scratch.block_inverse_mass[world, block + 2 * i + 1]
            body.velocity[i] = state.dof_velocity[world, first + i]
            body.inverse_mass[i] = Vector8(left[0], left[1], left[2], left[3], right[0], right[1], 0.0, 0.0)
    return body


@func
def row_direction(terms: ContactTerms, row: Int32) -> Vector3:
    """Direction of a row of a contact: row 0 is the normal, rows 1 and 2 are friction."""
    return terms.normal if row == 0 else terms.lateral1 if row == 1 else terms.lateral2


@func
def stuck_bit(contact: Int32, row: Int32) -> Int32:
    """Bit of `ManifoldBlock.stuck` for a row of a contact: 0 is the normal, 1 and 2 are friction."""
    return Int32(1) << (contact + (4 if row > 0 else 0))


@func
def write_row_numbers(
    settings: Settings,
    shapes: Shapes,
    pair_rows: PairRows,
    terms: ContactTerms,
    world: Int32,
    manifold_block: Int32,
    contact: Int32,
    row: Int32,
    velocity: real,
    inverse_mass: real,
) -> real:
    """Write all data of a row of a contact except its matrices; returns the row's effective mass.

    Row 0 is the normal, 1 and 2 are friction. `contact` is the contact's index in the block, `velocity` the
    present velocity of the row, without set velocities of fixed bases, and `inverse_mass` the change of this
    velocity by a unit impulse.
    """
    if terms.ignored != 0:
        inverse_mass = real(0.0)
    direction = row_direction(terms, row)
    total = velocity + wp.dot(terms.carried, direction)
    change = real(0.0)
    if row == 0:
        inverse_mass += terms.softness
        change = normal_change(settings, shapes, terms, world, total)
    else:
        inverse_mass += terms.lateral_softness
        change = lateral_change(settings, terms, total, row, direction)
    mass = inverse_or_off(inverse_mass)
    if mass == 0.0:
        inverse_mass = real(0.0)
        if terms.ignored == 0:
            stuck = pair_rows.manifold_block[world, manifold_block].stuck
            pair_rows.manifold_block[world, manifold_block].stuck = stuck | stuck_bit(contact, row)
    impulse = terms.start[row] if mass > 0.0 and terms.start[0] > 0.0 else 0.0
    if row == 0:
        pair_rows.manifold_block[world, manifold_block].friction[contact] = terms.friction[0]
        pair_rows.manifold_block[world, manifold_block].normal_share[contact] = change * mass
        pair_rows.manifold_block[world, manifold_block].normal_softness[contact] = terms.softness * mass
        pair_rows.manifold_block[world, manifold_block].normal_inverse_mass[contact] = inverse_mass
        pair_rows.manifold_block[world, manifold_block].normal_impulse[contact] = impulse
    else:
        i = 2 * contact + row - 1
        pair_rows.manifold_block[world, manifold_block].friction_share[i] = change * mass
        if terms.lateral_softness > 0.0:
            pair_rows.manifold_block[world, manifold_block].yields = Int32(1)
            pair_rows.manifold_block[world, manifold_block].friction_softness[i] = (
                terms.lateral_softness * mass
            )
        pair_rows.manifold_block[world, manifold_block].friction_inverse_mass[i] = inverse_mass
        pair_rows.manifold_block[world, manifold_block].friction_impulse[i] = impulse
    return mass


@func
def rigid_jacobian(arm: Vector3, direction: Vector3) -> Vector8:
    """Jacobian row of the velocity of a point at `arm` along a direction, in world axes."""
    moment = wp.cross(arm, direction)
    return Vector8(
        moment[0], moment[1], moment[2], direction[0], direction[1], direction[2], real(0.0), real(0.0)
    )


@func
def write_rigid_jacobians(
    pair_rows: PairRows,
    terms: ContactTerms,
    reference_a: Vector3,
    reference_b: Vector3,
    world: Int32,
    manifold_block: Int32,
    contact: Int32,
):
    """Store the Jacobians of a contact where its responses and weighted Jacobians will be."""
    row = Int32(0)
    while row < 3:
        direction = row_direction(terms, row)
        i = 2 * contact + row - 1
        for body in range(2):
            side = 2 * manifold_block + body
            jacobian = rigid_jacobian(terms.point_a - reference_a, direction)
            if body == 1:
                jacobian = rigid_jacobian(terms.point_b - reference_b, -direction)
            if row == 0:
                pair_rows.side[world, side].normal_response[contact] = jacobian
                for dof in range(6):
                    pair_rows.side[world, side].normal_weighted[dof, contact] = jacobian[dof]
            else:
                pair_rows.side[world, side].friction_response[i] = jacobian
                for dof in range(6):
                    pair_rows.side[world, side].friction_weighted[dof, i] = jacobian[dof]
        row += 1


@wp.func_native("""
    using Four = wp::vec_t<4, wp::float64>;
    using Eight = wp::vec_t<8, wp::float64>;
    auto& own = wp::index(sides, world, side);
    auto& delassus = wp::index(blocks, world, block);
    // The product of a row with a matrix, of which six rows are not zero.
    auto product = [](const auto& row, const auto& matrix, auto sum) {
        #pragma clang loop unroll(full)
        for (int dof = 0; dof < 6; ++dof)
            sum = wp::add(sum, wp::mul(row[dof], reinterpret_cast<const decltype(sum)&>(matrix.data[dof])));
        return sum;
    };
    auto respond = [&](auto& response, const auto& jacobian, auto& lowered, auto none) {
        const auto change = product(response, inverse_mass, Eight());
        reinterpret_cast<Eight&>(response) = change;
        auto& row = reinterpret_cast<decltype(none)&>(lowered);
        row = wp::add(row, product(change, jacobian, none));
    };
    auto& normal = delassus.normal_delassus;
    auto& friction = delassus.friction_delassus;
    for (int i = 0; i < delassus.count; ++i)
        respond(own.normal_response.data[i], own.normal_weighted, normal.data[i], Four());
    for (int i = 0; i < 2 * delassus.count; ++i)
        respond(own.friction_response.data[i], own.friction_weighted, friction.data[i], Eight());
""")
def add_responses(
    sides: ManifoldSides,
    blocks: ManifoldBlocks,
    world: Int32,
    side: Int32,
    block: Int32,
    inverse_mass: Matrix8,
):
    """Replace Jacobians by responses of a body, and add its part to Delassus matrices."""
    ...


@func
def write_responses(pair_rows: PairRows, world: Int32, manifold_block: Int32, side: Int32, body: RigidBody):
    """Compute the responses of a body, and add its part to Delassus matrices and velocities of rows.

    Until `weigh`, Delassus matrices are not multiplied by effective masses; until `write_row_numbers`, shares
    are the present velocities of the rows.
    """
    normal = pair_rows.side[world, side].normal_weighted
    friction = pair_rows.side[world, side].friction_weighted
    add_responses(pair_rows.side, pair_rows.manifold_block, world, side, manifold_block, body.inverse_mass)
    pair_rows.manifold_block[world, manifold_block].normal_share += combination(normal, body.velocity)
    pair_rows.manifold_block[world, manifold_block].friction_share += combination(friction, body.velocity)


@func
def weigh(
    pair_rows: PairRows, world: Int32, manifold_block: Int32, normal_mass: Vector4, friction_mass: Vector8
):
    """Multiply Jacobians and Delassus matrices by the effective masses of their rows."""
    for body in range(2):
        side = 2 * manifold_block + body
        for dof in range(6):
            pair_rows.side[world, side].normal_weighted[dof] = wp.cw_mul(
                normal_mass, pair_rows.side[world, side].normal_weighted[dof]
            )
            pair_rows.side[world, side].friction_weighted[dof] = wp.cw_mul(
                friction_mass, pair_rows.side[world, side].friction_weighted[dof]
            )
    for i in range(4):
        pair_rows.manifold_block[world, manifold_block].normal_delassus[i] = wp.cw_mul(
            normal_mass, pair_rows.manifold_block[world, manifold_block].normal_delassus[i]
        )
    for i in range(8):
        pair_rows.manifold_block[world, manifold_block].friction_delassus[i] = wp.cw_mul(
            friction_mass, pair_rows.manifold_block[world, manifold_block].friction_delassus[i]
        )


@func
def write_rigid_rows(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pair_rows: PairRows,
    world: Int32,
    manifold_block: Int32,
    tree_a: Int32,
    tree_b: Int32,
):
    """Write all rows of a manifold block of rigid bodies; its contacts are in `PairRows.terms`."""
    body_a = rigid_body(model, state, scratch, world, tree_a)
    body_b = rigid_body(model, state, scratch, world, tree_b)
    count = pair_rows.manifold_block[world, manifold_block].count
    contact = Int32(0)
    while contact < count:
        terms = pair_rows.terms[world, contact]
        write_rigid_jacobians(
            pair_rows, terms, body_a.reference, body_b.reference, world, manifold_block, contact
        )
        contact += 1
    place = pair_rows.manifold_block[world, manifold_block].place
    if place[1] > 0:
        write_responses(pair_rows, world, manifold_block, 2 * manifold_block, body_a)
    if place[3] > 0:
        write_responses(pair_rows, world, manifold_block, 2 * manifold_block + 1, body_b)
    normal_mass = Vector4(0.0, 0.0, 0.0, 0.0)
    friction_mass = Vector8(0.0)
    row = Int32(0)
    while row < 3 * count:
        contact = row // 3
        part = row % 3
        i = 2 * contact + part - 1
        velocity = pair_rows.manifold_block[world, manifold_block].normal_share[contact]
        inverse_mass = pair_rows.manifold_block[world, manifold_block].normal_delassus[contact, contact]
        if part > 0:
            velocity = pair_rows.manifold_block[world, manifold_block].friction_share[i]
            inverse_mass = pair_rows.manifold_block[world, manifold_block].friction_delassus[i, i]
        mass = write_row_numbers(
            settings, shapes, pair_rows, pair_rows.terms[world, contact],
            world, manifold_block, contact, part,
            velocity, inverse_mass,
        )  # fmt: skip
        if part > 0:
            friction_mass[i] = mass
        else:
            normal_mass[contact] = mass
        row += 1
    weigh(pair_rows, world, manifold_block, normal_mass, friction_mass)
    push_manifold_block(
        scratch, pair_rows, world, manifold_block,
        pair_rows.manifold_block[world, manifold_block].normal_impulse,
        pair_rows.manifold_block[world, manifold_block].friction_impulse,
    )  # fmt: skip
