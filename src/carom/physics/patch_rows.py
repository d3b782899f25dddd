"""Writing the rows of patches; see `patches`."""

import warp as wp

from carom.model.contact_structs import Contacts, Couplings, Patch, Shapes
from carom.model.real import (
    Index4,
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
    contact_terms,
    friction_change,
    keep_contact_impulse,
    normal_change,
)
from carom.physics.couplings import tree_blocks
from carom.physics.patches import (
    add_change,
    lowered_friction,
    lowered_normals,
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
def write_normal(
    couplings: Couplings,
    world: Int32,
    patch: Int32,
    i: Int32,
    jacobian_a: Vector8,
    jacobian_b: Vector8,
    response_a: Vector8,
    response_b: Vector8,
    inverse_mass: real,
    mass: real,
    change: real,
    softness: real,
    impulse: real,
):
    """Write normal row `i`; `mass` is its effective mass, `change` the change of velocity it asks for."""
    couplings.patch[world, patch].normal_response_a[i] = response_a
    couplings.patch[world, patch].normal_response_b[i] = response_b
    for dof in range(8):
        couplings.patch[world, patch].normal_weighted_a[dof, i] = mass * jacobian_a[dof]
        couplings.patch[world, patch].normal_weighted_b[dof, i] = mass * jacobian_b[dof]
    couplings.patch[world, patch].normal_share[i] = change * mass
    couplings.patch[world, patch].normal_softness[i] = softness * mass
    couplings.patch[world, patch].normal_inverse_mass[i] = inverse_mass
    couplings.patch[world, patch].normal_impulse[i] = impulse


@func
def write_friction(
    couplings: Couplings,
    world: Int32,
    patch: Int32,
    i: Int32,
    jacobian_a: Vector8,
    jacobian_b: Vector8,
    response_a: Vector8,
    response_b: Vector8,
    inverse_mass: real,
    mass: real,
    change: real,
    impulse: real,
):
    """Write friction row `i`, as `write_normal`."""
    couplings.patch[world, patch].friction_response_a[i] = response_a
    couplings.patch[world, patch].friction_response_b[i] = response_b
    for dof in range(8):
        couplings.patch[world, patch].friction_weighted_a[dof, i] = mass * jacobian_a[dof]
        couplings.patch[world, patch].friction_weighted_b[dof, i] = mass * jacobian_b[dof]
    couplings.patch[world, patch].friction_share[i] = change * mass
    couplings.patch[world, patch].friction_inverse_mass[i] = inverse_mass
    couplings.patch[world, patch].friction_impulse[i] = impulse


@func
def write_patch_contact(
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
    velocity_a: Vector8,
    velocity_b: Vector8,
):
    """Write the three rows of a contact of a patch."""
    place = couplings.patch[world, patch].place
    couplings.patch[world, patch].friction[contact] = terms.friction[0]
    row = Int32(0)
    while row < 3:
        direction = terms.normal
        if row == 1:
            direction = terms.lateral1
        elif row == 2:
            direction = terms.lateral2
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
        if terms.ignored != 0:
            inverse_mass = real(0.0)
        change = friction_change(settings, velocity, terms.drift, direction)
        if row == 0:
            inverse_mass += terms.softness
            change = normal_change(
                settings, shapes, velocity, terms.distance, terms.erp, terms.ends[1], terms.ends[3]
            )
        mass = inverse_or_off(inverse_mass)
        if mass == 0.0:
            inverse_mass = real(0.0)
        impulse = real(0.0)
        if mass > 0.0 and terms.start[0] > 0.0:
            impulse = terms.start[row]
            if place[1] > 0:
                add_change(scratch, world, place[0], impulse * response_a)
            if place[3] > 0:
                add_change(scratch, world, place[2], impulse * response_b)
        if row == 0:
            write_normal(
                couplings, world, patch, contact, jacobian_a, jacobian_b, response_a, response_b,
                inverse_mass, mass, change, terms.softness, impulse,
            )  # fmt: skip
        else:
            write_friction(
                couplings, world, patch, 2 * contact + row - 1, jacobian_a, jacobian_b,
                response_a, response_b, inverse_mass, mass, change, impulse,
            )  # fmt: skip
        row += 1


@func
def write_gains(couplings: Couplings, world: Int32, patch: Int32):
    """Write by how much each impulse of a patch lowers those wanted along the rows after it."""
    for i in range(4):
        couplings.patch[world, patch].normal_gain[i] = lowered_normals(
            couplings.patch[world, patch].normal_weighted_a,
            couplings.patch[world, patch].normal_response_a[i],
        ) + lowered_normals(
            couplings.patch[world, patch].normal_weighted_b,
            couplings.patch[world, patch].normal_response_b[i],
        )
    row = Int32(0)
    while row < 8:
        couplings.patch[world, patch].friction_gain[row] = lowered_friction(
            couplings.patch[world, patch].friction_weighted_a,
            couplings.patch[world, patch].friction_response_a[row],
        ) + lowered_friction(
            couplings.patch[world, patch].friction_weighted_b,
            couplings.patch[world, patch].friction_response_b[row],
        )
        row += 1


@func
def tree_place(model: Model, tree: Int32) -> Int32:
    """First block of a tree in `delta_velocity`; 0 for the world, -1."""
    if tree < 0:
        return Int32(0)
    return model.tree[tree].first_delta


@func
def write_patch(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    couplings: Couplings,
    world: Int32,
    patch: Int32,
    first_contact: Int32,
    count: Int32,
):
    """Write the rows of `count` contacts of the same two shapes of small trees."""
    pair = contacts.contact_shapes[world, first_contact]
    a = shapes.shape_tree[pair[0]]
    b = shapes.shape_tree[pair[1]]
    velocity_a = small_velocity(model, state, world, a)
    velocity_b = small_velocity(model, state, world, b)
    couplings.patch[world, patch] = Patch()
    couplings.patch[world, patch].place = Index4(
        tree_place(model, a), tree_blocks(model, a), tree_place(model, b), tree_blocks(model, b)
    )
    couplings.patch[world, patch].first_contact = first_contact
    couplings.patch[world, patch].count = count
    contact = Int32(0)
    while contact < count:
        terms = contact_terms(settings, state, shapes, contacts, world, first_contact + contact)
        write_patch_contact(
            settings, model, state, scratch, shapes, couplings, terms, world, patch, contact,
            velocity_a, velocity_b,
        )  # fmt: skip
        contact += 1
    write_gains(couplings, world, patch)


@func
def keep_patch_impulses(contacts: Contacts, couplings: Couplings, world: Int32, patch: Int32):
    """Report the impulses of the contacts of a patch."""
    normal = couplings.patch[world, patch].normal_impulse
    lateral = couplings.patch[world, patch].friction_impulse
    friction = couplings.patch[world, patch].friction
    first = couplings.patch[world, patch].first_contact
    for i in range(couplings.patch[world, patch].count):
        keep_contact_impulse(
            contacts, world, first + i, normal[i], lateral[2 * i], lateral[2 * i + 1], friction[i]
        )
