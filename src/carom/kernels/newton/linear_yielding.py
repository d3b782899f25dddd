"""Contacts of a step of the converged solver, linearised: those that yield by MuJoCo's law.

With the residuals x of its rows and the factor s = (1 − d) / d of all their R, λ = f(x) / s. So
dλ = −S dx − λ ds/s, where S = −df/dx / s.
"""

import warp as wp

from carom.kernels.dynamics.contact_compliance import contact_law, let_contact_yield
from carom.kernels.linearization.link_rows import add_row_of_links
from carom.kernels.linearization.rows import note_problem
from carom.kernels.linearization.yielding_rows import surfaces_of
from carom.kernels.newton.contacts import (
    LEAST_FRICTION,
    LEAST_LEAN,
    axis_of_capsule,
    capsule_on_plane,
    direction_on_shapes,
)
from carom.kernels.newton.law import CONTACT_LAW
from carom.kernels.newton.linear_noslip import note_law, take_given
from carom.kernels.newton.linear_surfaces import add_surface
from carom.kernels.structs import (
    Contacts,
    ContactTerms,
    Settings,
    Shapes,
    State,
    StepBatch,
    StepSpace,
    TouchingLinks,
)
from carom.kernels.types import Int32, Reals, Vector3, Vector6, func, real
from carom.layouts.linearization import (
    CONE_SURFACE,
    CONTACT_FRICTION,
    CONTACT_ROW,
    MOVES_A,
    MOVES_B,
    ROLLING_FRICTION,
    ROW_SLIDES,
    SPINNING_FRICTION,
)
from carom.layouts.newton import CONE, PYRAMID

_ON_CONE = wp.constant(real(1.0 - 1.0e-9))


@wp.func_native(
    CONTACT_LAW
    + """
    struct { int kind, size; double friction, regular; } rows[6];
    double x[6], f[6], s[6][6];
    for (int i = 0; i < 6; ++i) {
        x[i] = rate[i];
        f[i] = 0.0;
        rows[i].kind = kind;
        rows[i].size = size;
        rows[i].friction = coefficient[i];
        rows[i].regular = regular[i];
    }
    if (coefficient[0] > 0.0)
        yield(rows, x, f, s);
    else {
        s[0][0] = x[0] < 0.0 ? 1.0 / regular[0] : 0.0;
        f[0] = -s[0][0] * x[0];
    }
    const int count = coefficient[0] > 0.0 ? size : 1;
    auto* target = &wp::index(slopes, start);
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j)
            target[i * step + j] = s[i][j];
    wp::vec_t<6, wp::float64> found;
    for (int i = 0; i < 6; ++i)
        found[i] = f[i];
    return found;
"""
)
def impulses_of_contact(
    slopes: Reals,
    start: Int32,
    step: Int32,
    rate: Vector6,
    regular: Vector6,
    coefficient: Vector6,
    kind: Int32,
    size: Int32,
) -> Vector6:
    """Impulses of a contact for the residuals of its rows; S is written from `start` on, by rows."""
    ...


@func
def turn_with_pyramid(
    state: State,
    shapes: Shapes,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
):
    """Write how the directions of friction turn with the normal where they are those of MuJoCo's pyramids.

    Those of a capsule on a plane turn with the capsule as well.
    """
    n = space.dofs
    normal, first = touch.normal, touch.direction1
    axis = Vector3(0.0, 1.0, 0.0)
    if wp.abs(normal[1]) >= 0.5:
        axis = Vector3(0.0, 0.0, 1.0)
    turns_with = Int32(0)
    capsule = capsule_on_plane(shapes, touch.shape_a, touch.shape_b)
    if capsule >= 0:
        own = axis_of_capsule(state, shapes, world, capsule)
        if wp.length(own - wp.dot(normal, own) * normal) > LEAST_LEAN:
            axis = own
            turns_with = wp.where(capsule == touch.shape_a, Int32(MOVES_A), Int32(MOVES_B))
    along = wp.dot(normal, axis)
    length = wp.length(axis - along * normal)
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        entry = 3 * place * n + dof
        turned = steps.turned[entry]
        rate = -(along * turned + wp.dot(turned, axis) * normal) / length
        if steps.reach_side[place * n + dof] & turns_with != 0:
            swung = wp.cross(steps.axis_angular[place * n + dof], axis)
            rate += (swung - wp.dot(swung, normal) * normal) / length
        rate -= wp.dot(first, rate) * first
        steps.turned[entry + n] = rate
        steps.turned[entry + 2 * n] = wp.cross(turned, first) + wp.cross(normal, rate)


@func
def kind_of_row(number: Int32, count: Int32) -> Int32:
    """What a row of a contact is of: its normal, lateral, rolling or spinning friction."""
    kind = Int32(CONTACT_ROW)
    if number > 2:
        kind = wp.where(number < 5 and count > 4, Int32(ROLLING_FRICTION), Int32(SPINNING_FRICTION))
    elif number > 0:
        kind = Int32(CONTACT_FRICTION)
    return kind


@func
def direction_number(kind: Int32, number: Int32) -> Int32:
    """The direction of a row of a contact: the normal (0), or one of friction (1, 2)."""
    found = number + 0
    if kind == ROLLING_FRICTION:
        found = number - 2
    elif kind == SPINNING_FRICTION:
        found = Int32(0)
    return found


@func
def first_free_row(space: StepSpace, steps: StepBatch, place: Int32) -> Int32:
    """The row that is added next, whose memory is free until then."""
    return place * space.most_rows + steps.row_count[place]


@func
def slides_on_cone(impulses: Vector6, friction: real, kind: Int32) -> bool:
    """Whether lateral friction is as great as it can be."""
    x, y = impulses[1], impulses[2]
    length = wp.sqrt(x * x + y * y)
    if kind == PYRAMID:
        length = wp.abs(x) + wp.abs(y)
    return length >= friction * impulses[0] * _ON_CONE


@func
def add_yielding_contact(
    settings: Settings,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
    before: Vector3,
    before_about: Vector3,
    after: Vector3,
    about: Vector3,
    parts: Int32,
):
    """Add the rows of a contact that yields.

    Args:
        settings: The settings.
        state: The state.
        shapes: The shapes.
        contacts: The contacts.
        space: The tangent space.
        steps: The steps.
        place: The place.
        world: The world.
        touch: The contact.
        before: Velocity of a relative to b before the step.
        before_about: Its angular velocity.
        after: Velocity after it.
        about: Angular velocity after it.
        parts: Where `steps.response` has how the contact parts.
    """
    n, room, h = space.dofs, space.most_rows, settings.time_step
    touch = surfaces_of(settings, shapes, contacts, world, touch)
    a, b = touch.shape_a, touch.shape_b
    first_direction = direction_on_shapes(state, shapes, world, a, b, touch.normal)
    touch.direction1 = first_direction
    touch.direction2 = wp.cross(touch.normal, first_direction)
    turn_with_pyramid(state, shapes, space, steps, place, world, touch)
    _reference, _impedance, _lateral, margin, _mass, _row = contact_law(settings, shapes, world, a, b)
    terms = ContactTerms()
    terms.friction = touch.friction
    terms.distance = contacts.contact_distance[world, touch.contact]
    terms.ignored = Int32(0)
    terms = let_contact_yield(settings, shapes, terms, world, touch.shape_a, touch.shape_b)
    friction = touch.friction[0]
    share = wp.max(shapes.shape_mixing[world, touch.shape_a][2], shapes.shape_mixing[world, touch.shape_b][2])
    law = wp.where(share > 0.0, Int32(PYRAMID), Int32(CONE))
    lateral = terms.lateral_softness + 0.0
    if share < 0.0:
        lateral = -share * lateral
    count = Int32(3)
    if touch.friction[1] > 0.0:
        count += 2
    if touch.friction[2] > 0.0:
        count += 1
    kept_along, kept_across = touch.normal_law[0], touch.lateral_law[0]
    rate, regular, coefficient = Vector6(), Vector6(), Vector6()
    coefficient[0] = friction
    regular[0] = terms.softness
    if share > 0.0 and friction > 0.0:
        regular[0] = 2.0 * friction * friction * terms.lateral_softness
    rate[0] = wp.dot(touch.normal, after - kept_along * before) + h * terms.pull
    for i in range(1, count):
        kind = kind_of_row(i, count)
        number = direction_number(kind, i)
        direction = wp.where(number == 1, touch.direction1, touch.direction2)
        direction = wp.where(number == 0, touch.normal, direction)
        own = friction + 0.0
        change = after - kept_across * before
        if kind == ROLLING_FRICTION:
            own = touch.friction[1]
            change = about - kept_across * before_about
        elif kind == SPINNING_FRICTION:
            own = touch.friction[2]
            change = about - kept_across * before_about
        ratio = friction / wp.max(own, LEAST_FRICTION)
        coefficient[i] = own
        regular[i] = lateral * ratio * ratio
        rate[i] = wp.dot(direction, change)
        if touch.surface_moves != 0:
            # Its changes are written where the row is added.
            angular = wp.where(kind == CONTACT_FRICTION, Int32(0), Int32(1))
            free = first_free_row(space, steps, place)
            rate[i] = rate[i] + add_surface(
                state, shapes, space, steps, place, world, touch, free, number, angular, kept_across
            )
    if friction <= 0.0:
        count = Int32(1)
    first = place * room + steps.row_count[place]
    number_of_first = steps.row_count[place]
    start = first * room + number_of_first + 0
    impulses = impulses_of_contact(steps.alpha, start, room, rate, regular, coefficient, law, count)
    if space.is_given != 0:
        impulses = take_given(space, steps, first, start, room, count)
    slopes = Vector6()
    for i in range(count):
        slopes[i] = steps.alpha[start + i * room + i]
    slides = slides_on_cone(impulses, friction, law)
    for i in range(count):
        kind = kind_of_row(i, count)
        angular = wp.where(kind == ROLLING_FRICTION or kind == SPINNING_FRICTION, Int32(1), Int32(0))
        kept = wp.where(i == 0, kept_along, kept_across)
        row = add_row_of_links(
            settings, space, steps, place, touch, kind, direction_number(kind, i), angular, impulses[i], kept
        )
        if i > 0:
            add_surface(
                state, shapes, space, steps, place, world, touch, row, direction_number(kind, i), angular,
                kept,
            )  # fmt: skip
        # That has cleared α and β of the row itself.
        steps.alpha[start + i * room + i] = slopes[i]
        steps.beta[start + i * room + i] = 1.0
        if i == 0:
            steps.row_switch[row] = wp.abs(terms.distance - margin)
        if slides and kind == CONTACT_FRICTION:
            steps.row_status[row] = ROW_SLIDES
    softens = real(0.0)
    if touch.normal_law[1] > 0.0:
        softens = touch.normal_law[2] / touch.normal_law[1]
    if space.is_given != 0:
        note_law(space, steps, place, touch, first, count, rate, coefficient, law, softens, parts)
        softens = real(0.0)
    for i in range(count):
        side = (first + i) * space.columns
        for index in range(touch.reach):
            dof = steps.reach[place * n + index]
            parted = steps.response[parts + dof]
            by_position = -impulses[i] * softens * parted
            by_velocity = real(0.0)
            for j in range(count):
                slope = steps.alpha[start + i * room + j]
                other = (first + j) * n + dof
                by_position -= slope * steps.rate[other]
                kept = wp.where(j == 0, kept_along, kept_across)
                by_velocity += slope * kept * steps.jacobian[other]
                if j == 0:
                    by_position -= slope * touch.gain * parted
            steps.side[side + dof] = by_position
            steps.side[side + n + dof] = by_velocity
    stated = touch.stated != 0
    if not stated and (space.link_input[touch.link_a] >= 0 or space.link_input[touch.link_b] >= 0):
        note_problem(steps, place, CONE_SURFACE, touch.known_as)
