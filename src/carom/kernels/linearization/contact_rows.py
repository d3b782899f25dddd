"""Rows of contacts, linearised: normals, and lateral, rolling and spinning friction."""

import warp as wp

from carom.kernels.dynamics.contact_compliance import combined_restitution
from carom.kernels.dynamics.kinematics import base_omega, base_velocity
from carom.kernels.linearization.contact_points import greatest_of, move_contact
from carom.kernels.linearization.dof_motion import find_reach
from carom.kernels.linearization.friction_rows import add_friction_rows
from carom.kernels.linearization.link_rows import add_row_of_links, parting
from carom.kernels.linearization.rows import note_problem
from carom.kernels.linearization.yielding_rows import add_yielding, surfaces_of
from carom.kernels.solver.contact_terms import surface_moves
from carom.kernels.structs import (
    Contacts,
    Model,
    PairRows,
    Settings,
    Shapes,
    State,
    StepBatch,
    StepSpace,
    TouchingLinks,
)
from carom.kernels.types import Int32, Vector4, called_func, func, real
from carom.layouts.codes import LATERAL_ROW, NORMAL_ROW, ROLLING_ROW, SPINNING_ROW
from carom.layouts.contacts import THERE
from carom.layouts.linearization import (
    ANCHOR,
    ANISOTROPY,
    BOUNCE,
    CONTACT_FRICTION,
    CONTACT_ROW,
    FEATURES,
    MOVING_BASE,
    ROLLING_FRICTION,
    SHAPE_KINDS,
    SPINNING_FRICTION,
    TORSION,
)


@func
def torsion_impulses(contacts: Contacts, pair_rows: PairRows, world: Int32, contact: Int32) -> Vector4:
    """Impulses of rolling friction, two, and of spinning friction in the solver's rows of a contact, then 1.

    The last is 0 if the rows of other bodies have taken their place: bodies that do not touch are solved one
    after the other in the same memory.
    """
    expected = contacts.contact_impulse[world, contact]
    found = Vector4(0.0, 0.0, 0.0, 0.0)
    # Contacts of rigid bodies have rows of fixed size, in two places that follow each other.
    for single in range(pair_rows.single_contact.shape[1] - 1):
        own = pair_rows.single_contact[world, single] == contact
        if own and pair_rows.single_contact[world, single + 1] == contact and found[3] == 0.0:
            along = pair_rows.single_impulse[world, single]
            if along[0] == expected[0] and along[1] == expected[1] and along[2] == expected[2]:
                about = pair_rows.single_impulse[world, single + 1]
                found = Vector4(about[1], about[2], about[0], 1.0)
    rows = pair_rows.contact_rows[world, contact]
    if found[3] == 0.0 and rows[NORMAL_ROW] >= 0 and rows[LATERAL_ROW] >= 0:
        lateral = rows[LATERAL_ROW]
        same = pair_rows.row_terms[world, rows[NORMAL_ROW]].impulse == expected[0]
        same = same and pair_rows.row_terms[world, lateral].impulse == expected[1]
        if same and pair_rows.row_terms[world, lateral + 1].impulse == expected[2]:
            found[3] = 1.0
            if rows[ROLLING_ROW] >= 0:
                found[0] = pair_rows.row_terms[world, rows[ROLLING_ROW]].impulse
                found[1] = pair_rows.row_terms[world, rows[ROLLING_ROW] + 1].impulse
            if rows[SPINNING_ROW] >= 0:
                found[2] = pair_rows.row_terms[world, rows[SPINNING_ROW]].impulse
    return found


@func
def has_factors(shapes: Shapes, world: Int32, shape: Int32) -> bool:
    """Whether a shape's friction is anisotropic."""
    factors = shapes.shape_anisotropy[world, shape]
    return factors[0] != 1.0 or factors[1] != 1.0 or factors[2] != 1.0


@func
def is_carried(model: Model, state: State, world: Int32, tree: Int32) -> bool:
    """Whether a fixed base has been given a velocity."""
    if model.tree[tree].fixed == 0:
        return False
    return greatest_of(base_omega(model, state, world, tree)) > 0.0 or (
        greatest_of(base_velocity(model, state, world, tree)) > 0.0
    )


@func
def refuse_surfaces(
    model: Model,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
):
    """Note what has no exact derivatives of how two links touch."""
    a, b = touch.shape_a, touch.shape_b
    pair = contacts.contact_shapes[world, touch.contact]
    for end in range(2):
        if is_carried(model, state, world, shapes.shape_tree[wp.where(end == 0, pair[0], pair[1])]):
            note_problem(steps, place, MOVING_BASE, touch.known_as)
    if has_factors(shapes, world, a) or has_factors(shapes, world, b):
        note_problem(steps, place, ANISOTROPY, touch.known_as)
    if shapes.shape_friction_anchor[world, a] != 0 or shapes.shape_friction_anchor[world, b] != 0:
        note_problem(steps, place, ANCHOR, touch.known_as)


@func
def add_normal(
    settings: Settings,
    shapes: Shapes,
    contacts: Contacts,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
) -> Int32:
    """Add the normal row of a contact; returns its number among the rows of all worlds."""
    n = space.dofs
    impulse = contacts.contact_impulse[world, touch.contact][0]
    kept = touch.normal_law[0]
    row = add_row_of_links(settings, space, steps, place, touch, CONTACT_ROW, 0, Int32(0), impulse, kept)
    number = row - place * space.most_rows
    steps.alpha[row * space.most_rows + number] = 1.0
    if touch.normal_law[2] == 0.0:
        steps.row_switch[row] = wp.abs(contacts.contact_distance[world, touch.contact])
    approach = real(0.0)
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        free = steps.velocity[(3 * place + 1) * n + dof]
        approach -= steps.jacobian[row * n + dof] * free
        steps.side[row * space.columns + dof] -= touch.gain * parting(touch, steps, place * n + dof)
    add_yielding(settings, shapes, space, steps, place, world, touch, CONTACT_ROW, row, Int32(1))
    restitution = combined_restitution(shapes, world, touch.shape_a, touch.shape_b)
    if restitution > 0.0 and approach >= settings.restitution_threshold:
        note_problem(steps, place, BOUNCE, touch.known_as)
    return row


@func
def touching_links(
    model: Model,
    shapes: Shapes,
    contacts: Contacts,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    contact: Int32,
) -> TouchingLinks:
    """A contact, and the dofs that move its links; its surfaces are not there yet."""
    pair = contacts.contact_shapes[world, contact]
    kinds = shapes.shape_kind[pair[0]] * SHAPE_KINDS + shapes.shape_kind[pair[1]]
    touch = TouchingLinks()
    touch.contact = contact
    touch.known_as = contact * SHAPE_KINDS * SHAPE_KINDS + kinds
    touch.shape_a = pair[0]
    touch.shape_b = pair[1]
    touch.link_a = pair[2]
    touch.link_b = pair[3]
    moving = surface_moves(shapes, world, pair[0]) or surface_moves(shapes, world, pair[1])
    touch.surface_moves = wp.where(moving, Int32(1), Int32(0))
    touch.point_a = contacts.contact_point_a[world, contact]
    touch.point_b = contacts.contact_point_b[world, contact]
    touch.normal = contacts.contact_normal[world, contact]
    touch.direction1 = contacts.contact_direction1[world, contact]
    touch.direction2 = contacts.contact_direction2[world, contact]
    touch.reach = find_reach(model, space, steps, place, pair[2], pair[3])
    return touch


@called_func
def add_contact(
    model: Model,
    settings: Settings,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    pair_rows: PairRows,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    contact: Int32,
):
    """Add the rows of a contact."""
    touch = touching_links(model, shapes, contacts, space, steps, place, world, contact)
    pair = contacts.contact_shapes[world, contact]
    if move_contact(state, shapes, space, steps, place, world, touch, pair[0], pair[1]):
        refuse_surfaces(model, state, shapes, contacts, steps, place, world, touch)
        touch = surfaces_of(settings, shapes, contacts, world, touch)
        friction = touch.friction
        impulse = contacts.contact_impulse[world, contact]
        normal = add_normal(settings, shapes, contacts, space, steps, place, world, touch)
        add_friction_rows(
            model, settings, state, shapes, space, steps, place, world, touch, CONTACT_FRICTION, normal,
            friction[0], impulse[1], impulse[2],
        )  # fmt: skip
        if friction[1] > 0.0 or friction[2] > 0.0:
            along = torsion_impulses(contacts, pair_rows, world, contact)
            if along[3] == 0.0:
                note_problem(steps, place, TORSION, touch.known_as)
            if friction[1] > 0.0:
                add_friction_rows(
                    model, settings, state, shapes, space, steps, place, world, touch, ROLLING_FRICTION,
                    normal, friction[1], along[0], along[1],
                )  # fmt: skip
            if friction[2] > 0.0 and settings.cone_friction != 0:
                add_friction_rows(
                    model, settings, state, shapes, space, steps, place, world, touch, SPINNING_FRICTION,
                    normal, friction[2], along[2], real(0.0),
                )  # fmt: skip
    else:
        note_problem(steps, place, FEATURES, touch.known_as)


@func
def pushing_contacts(contacts: Contacts, world: Int32) -> Int32:
    """Number of contacts with an impulse."""
    count = Int32(0)
    for contact in range(contacts.count_contacts[world, THERE]):
        if contacts.contact_impulse[world, contact][0] > 0.0:
            count += 1
    return count


@func
def add_contacts(
    model: Model,
    settings: Settings,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    pair_rows: PairRows,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
):
    """Add the rows of all contacts that push."""
    for contact in range(contacts.count_contacts[world, THERE]):
        if contacts.contact_impulse[world, contact][0] > 0.0:
            add_contact(
                model, settings, state, shapes, contacts, pair_rows, space, steps, place, world, contact
            )
