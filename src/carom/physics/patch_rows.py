"""Writing the rows of patches of small trees; see `patches`."""

import warp as wp

from carom.model.contact_structs import Couplings, Shapes
from carom.model.real import (
    Int32,
    Vector3,
    Vector4,
    Vector8,
    func,
    real,
)
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.contact_terms import (
    ContactTerms,
    friction_change,
    normal_change,
)
from carom.physics.couplings import tree_blocks
from carom.physics.patches import (
    add_change,
    combination,
)
from carom.physics.rows import inverse_or_off


@func
def small_jacobian(
    model: Model,
    state: State,
    scratch: Scratch,
    world: Int32,
    tree: Int32,
    link: Int32,
    point: Vector3,
    direction: Vector3,
) -> Vector8:
    """How dofs of a small tree, -1 for none, move a point of a link along a direction, in world axes."""
    result = Vector8(0.0)
    if tree >= 0:
        reference = wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
        moment = wp.cross(point - reference, direction)
        first = model.tree[tree].first_dof
        dof = model.link[link].nearest_dof
        while dof >= 0:
            result[dof - first] = wp.dot(scratch.dof[world, dof].linear, direction) + wp.dot(
                scratch.dof[world, dof].angular, moment
            )
            dof = model.dof[dof].parent
    return result


@func
def small_response(model: Model, scratch: Scratch, world: Int32, tree: Int32, jacobian: Vector8) -> Vector8:
    """What an impulse along a Jacobian does to the velocity of a small tree."""
    result = Vector8(0.0)
    blocks = tree_blocks(model, tree)
    if blocks > 0:
        block = model.tree[tree].first_block
        first = Vector4(0.0, 0.0, 0.0, 0.0)
        second = Vector4(0.0, 0.0, 0.0, 0.0)
        dof = Int32(0)
        while dof < model.tree[tree].dof_count:
            first += jacobian[dof] * scratch.block_inverse_mass[world, block]
            if blocks > 1:
                second += jacobian[dof] * scratch.block_inverse_mass[world, block + 1]
            block += blocks
            dof += 1
        result = Vector8(first[0], first[1], first[2], first[3], second[0], second[1], second[2], second[3])
    return result


@func
def small_velocity(model: Model, state: State, world: Int32, tree: Int32) -> Vector8:
    """Velocity of a small tree, -1 for none."""
    result = Vector8(0.0)
    if tree >= 0:
        first = model.tree[tree].first_dof
        dof = Int32(0)
        while dof < model.tree[tree].dof_count:
            result[dof] = state.dof_velocity[world, first + dof]
            dof += 1
    return result


@func
def row_direction(terms: ContactTerms, row: Int32) -> Vector3:
    """Direction of a row of a contact: 0 is the normal, 1 and 2 are those of friction."""
    direction = terms.normal
    if row == 1:
        direction = terms.lateral1
    elif row == 2:
        direction = terms.lateral2
    return direction


@func
def write_row_numbers(
    settings: Settings,
    shapes: Shapes,
    couplings: Couplings,
    terms: ContactTerms,
    world: Int32,
    patch: Int32,
    contact: Int32,
    row: Int32,
    velocity: real,
    inverse_mass: real,
) -> Vector3:
    """Write everything about a row of a contact but its matrices.

    Args:
        settings: Softness, error reduction and more.
        shapes: Restitution of the links.
        couplings: The patch.
        terms: The contact.
        world: The world.
        patch: The patch.
        contact: Which of its contacts.
        row: Which of the rows of the contact: 0 is the normal, 1 and 2 are those of friction.
        velocity: Present velocity of the row.
        inverse_mass: Velocity that a unit impulse gives it.

    Returns:
        Effective mass of the row, the impulse it starts from, 0.
    """
    if terms.ignored != 0:
        inverse_mass = real(0.0)
    change = friction_change(settings, velocity, terms.drift, row_direction(terms, row))
    if row == 0:
        inverse_mass += terms.softness
        change = normal_change(settings, shapes, terms, velocity)
    mass = inverse_or_off(inverse_mass)
    if mass == 0.0:
        inverse_mass = real(0.0)
    impulse = real(0.0)
    if mass > 0.0 and terms.start[0] > 0.0:
        impulse = terms.start[row]
    if row == 0:
        couplings.patch[world, patch].friction[contact] = terms.friction[0]
        couplings.patch[world, patch].normal_share[contact] = change * mass
        couplings.patch[world, patch].normal_softness[contact] = terms.softness * mass
        couplings.patch[world, patch].normal_inverse_mass[contact] = inverse_mass
        couplings.patch[world, patch].normal_impulse[contact] = impulse
    else:
        i = 2 * contact + row - 1
        couplings.patch[world, patch].friction_share[i] = change * mass
        couplings.patch[world, patch].friction_inverse_mass[i] = inverse_mass
        couplings.patch[world, patch].friction_impulse[i] = impulse
    return Vector3(mass, impulse, 0.0)


@func
def write_small_matrices(
    couplings: Couplings,
    world: Int32,
    patch: Int32,
    contact: Int32,
    row: Int32,
    mass: real,
    jacobian_a: Vector8,
    jacobian_b: Vector8,
    response_a: Vector8,
    response_b: Vector8,
):
    """Write the weighted Jacobian and the response of a row of effective mass `mass`."""
    if row == 0:
        couplings.patch[world, patch].normal_response_a[contact] = response_a
        couplings.patch[world, patch].normal_response_b[contact] = response_b
        for dof in range(8):
            couplings.patch[world, patch].normal_weighted_a[dof, contact] = mass * jacobian_a[dof]
            couplings.patch[world, patch].normal_weighted_b[dof, contact] = mass * jacobian_b[dof]
    else:
        i = 2 * contact + row - 1
        couplings.patch[world, patch].friction_response_a[i] = response_a
        couplings.patch[world, patch].friction_response_b[i] = response_b
        for dof in range(8):
            couplings.patch[world, patch].friction_weighted_a[dof, i] = mass * jacobian_a[dof]
            couplings.patch[world, patch].friction_weighted_b[dof, i] = mass * jacobian_b[dof]


@func
def write_small_contact(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    couplings: Couplings,
    terms: ContactTerms,
    world: Int32,
    patch: Int32,
    contact: Int32,
):
    """Write the three rows of a contact between small trees."""
    place = couplings.patch[world, patch].place
    velocity_a = small_velocity(model, state, world, terms.ends[0])
    velocity_b = small_velocity(model, state, world, terms.ends[2])
    row = Int32(0)
    while row < 3:
        direction = row_direction(terms, row)
        jacobian_a = small_jacobian(
            model, state, scratch, world, terms.ends[0], terms.ends[1], terms.point_a, direction
        )
        jacobian_b = small_jacobian(
            model, state, scratch, world, terms.ends[2], terms.ends[3], terms.point_b, -direction
        )
        response_a = small_response(model, scratch, world, terms.ends[0], jacobian_a)
        response_b = small_response(model, scratch, world, terms.ends[2], jacobian_b)
        velocity = wp.dot(jacobian_a, velocity_a) + wp.dot(jacobian_b, velocity_b)
        inverse_mass = wp.dot(jacobian_a, response_a) + wp.dot(jacobian_b, response_b)
        numbers = write_row_numbers(
            settings, shapes, couplings, terms, world, patch, contact, row, velocity, inverse_mass
        )
        write_small_matrices(
            couplings, world, patch, contact, row, numbers[0], jacobian_a, jacobian_b, response_a, response_b
        )
        if numbers[1] != 0.0:
            if place[1] > 0:
                add_change(scratch, world, place[0], numbers[1] * response_a)
            if place[3] > 0:
                add_change(scratch, world, place[2], numbers[1] * response_b)
        row += 1


@func
def write_small_gains(couplings: Couplings, world: Int32, patch: Int32):
    """Write by how much each impulse of a patch lowers those wanted along the rows after it."""
    for i in range(4):
        couplings.patch[world, patch].normal_gain[i] = combination(
            couplings.patch[world, patch].normal_weighted_a,
            couplings.patch[world, patch].normal_response_a[i],
        ) + combination(
            couplings.patch[world, patch].normal_weighted_b,
            couplings.patch[world, patch].normal_response_b[i],
        )
    row = Int32(0)
    while row < 8:
        couplings.patch[world, patch].friction_gain[row] = combination(
            couplings.patch[world, patch].friction_weighted_a,
            couplings.patch[world, patch].friction_response_a[row],
        ) + combination(
            couplings.patch[world, patch].friction_weighted_b,
            couplings.patch[world, patch].friction_response_b[row],
        )
        row += 1
