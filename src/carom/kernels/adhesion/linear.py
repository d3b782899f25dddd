"""Forces that pull links towards what touches them, linearised while the set of their contacts holds."""

import warp as wp

from carom.kernels.adhesion.stages import holds
from carom.kernels.dynamics.actuators import within_own_range
from carom.kernels.dynamics.contact_compliance import contact_law, yields
from carom.kernels.linearization.actuator_law import drive_of, follows_control, present_terms
from carom.kernels.linearization.contact_points import move_contact
from carom.kernels.linearization.contact_rows import touching_links
from carom.kernels.linearization.dof_motion import point_motion
from carom.kernels.linearization.link_rows import jacobian_change
from carom.kernels.linearization.rows import note_problem
from carom.kernels.newton.linear_contacts import meet_in_middle
from carom.kernels.structs import (
    Contacts,
    Model,
    Scratch,
    Settings,
    Shapes,
    State,
    StepBatch,
    StepSpace,
    TouchingLinks,
)
from carom.kernels.types import Int32, Vector2, Vector4, called_func, func, real
from carom.layouts.contacts import THERE
from carom.layouts.linearization import (
    FEATURES,
    INPUT_BIAS,
    INPUT_CONTROL,
    INPUT_GAIN,
    MOVES_A,
    MOVES_B,
    NEAR_MARGIN,
    PULLED,
)

_NEAR = wp.constant(real(NEAR_MARGIN))


@func
def pull_along_normal(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    touch: TouchingLinks,
    actuator: Int32,
    share: real,
    by_activation: real,
    by_input: Vector4,
):
    """Add the derivatives of a force `share` along the normal, on a and opposite on b, to `steps.force`.

    `by_input` is how the force changes with the control, with the first numbers of gain and bias.
    """
    n = space.dofs
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        entry = place * n + dof
        along = real(0.0)
        if steps.reach_side[entry] & MOVES_A != 0:
            along += wp.dot(touch.normal, point_motion(steps, entry, touch.point_a))
        if steps.reach_side[entry] & MOVES_B != 0:
            along -= wp.dot(touch.normal, point_motion(steps, entry, touch.point_b))
        for end in range(2):
            force = ((2 * place + end) * n + dof) * space.columns
            for rank in range(touch.reach):
                other = steps.reach[place * n + rank]
                bent = jacobian_change(space, steps, place, touch, Int32(0), Int32(0), dof, other)
                steps.force[force + other] += share * bent
            column = space.actuator_column[actuator]
            if column >= 0:
                steps.force[force + 2 * n + column] += along * by_activation
            given = space.actuator_input[actuator] + 0
            while given >= 0:
                number = space.input_number[given]
                slope = real(0.0)
                if number == INPUT_CONTROL:
                    slope = by_input[0]
                elif number == INPUT_GAIN:
                    slope = by_input[1]
                elif number == INPUT_BIAS:
                    slope = by_input[2]
                target = force + space.states + given
                steps.force[target] += along * slope * space.input_scale[given]
                given = space.input_next[given]


@func
def force_of_adhesion(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, actuator: Int32
):
    """Force of such an actuator, its derivatives by activation; by control, gain and bias."""
    drive = drive_of(model, state, scratch, world, actuator, settings.time_step)
    terms = present_terms(model, world, actuator, drive[0], real(0.0), real(0.0))
    force = within_own_range(model, world, actuator, terms[0])
    within = wp.where(force == terms[0], real(1.0), real(0.0))
    by_control = real(0.0)
    if follows_control(model, state, world, actuator):
        by_control = drive[2] * terms[3]
    by_input = within * Vector4(by_control, drive[0], real(1.0), real(0.0))
    return Vector2(force, within * drive[1] * terms[3]), by_input


@called_func
def add_adhesion(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    actuator: Int32,
    link: Int32,
):
    """Add the derivatives of the force of an actuator that pulls a link."""
    count = contacts.count_contacts[world, THERE]
    holding = real(0.0)
    for contact in range(count):
        if holds(settings, shapes, contacts, world, contact, link):
            holding += 1.0
    force, by_input = force_of_adhesion(model, settings, state, scratch, world, actuator)
    for contact in range(count):
        pair = contacts.contact_shapes[world, contact]
        if (pair[2] == link or pair[3] == link) and pair[2] != pair[3]:
            touch = touching_links(model, shapes, contacts, space, steps, place, world, contact)
            _reference, _impedance, _lateral, margin, _mass, _row = contact_law(
                settings, shapes, world, pair[0], pair[1]
            )
            beyond = contacts.contact_distance[world, contact] - margin
            if wp.abs(beyond) <= _NEAR:
                steps.near[place * space.most_contacts + contact] = touch.known_as
            if beyond >= 0.0 and not yields(shapes, world, pair[0], pair[1]):
                # Whether that is held depends on the impulse of the step before.
                note_problem(steps, place, PULLED, touch.known_as)
            elif beyond < 0.0:
                if move_contact(state, shapes, space, steps, place, world, touch, pair[0], pair[1]):
                    touch = meet_in_middle(space, steps, place, touch)
                    share = -1.0 / holding
                    pull_along_normal(
                        space, steps, place, touch, actuator, share * force[0], share * force[1],
                        share * by_input,
                    )  # fmt: skip
                else:
                    note_problem(steps, place, FEATURES, touch.known_as)


@func
def add_all_adhesion(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
):
    """Add the derivatives of the forces of all actuators that pull links."""
    for tree in range(settings.tree_count):
        first = model.tree[tree].first_actuator
        for actuator in range(first, first + model.tree[tree].actuator_count):
            if model.actuator[actuator].pulled != 0:
                link = model.tree[tree].first_link + model.actuator[actuator].pulled - 1
                add_adhesion(
                    model, settings, state, scratch, shapes, contacts, space, steps, place, world, actuator,
                    link,
                )  # fmt: skip
