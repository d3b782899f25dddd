"""How contacts and their rows yield, linearised, and how their friction follows that of links."""

import warp as wp

from carom.kernels.contact.ranked_friction import LEAST_FRICTION, friction_alone, friction_of
from carom.kernels.dynamics.contact_compliance import contact_law, let_contact_yield, yields_without_bounce
from carom.kernels.dynamics.yielding import impedance_at, impedance_slope, spring_and_damper
from carom.kernels.linearization.link_rows import law_of_row, parting
from carom.kernels.linearization.rows import set_input
from carom.kernels.solver.contact_terms import contact_friction, contact_stiffness
from carom.kernels.structs import (
    Contacts,
    ContactTerms,
    Settings,
    Shapes,
    StepBatch,
    StepSpace,
    TouchingLinks,
)
from carom.kernels.types import Int32, Vector3, Vector4, func, real
from carom.layouts.linearization import (
    CONTACT_FRICTION,
    INPUT_FRICTION,
    ROLLING_FRICTION,
    SPINNING_FRICTION,
)


@func
def surfaces_of(
    settings: Settings, shapes: Shapes, contacts: Contacts, world: Int32, touch: TouchingLinks
) -> TouchingLinks:
    """A contact with its friction, and with how its rows yield."""
    a, b = touch.shape_a, touch.shape_b
    distance = contacts.contact_distance[world, touch.contact]
    softness, erp = contact_stiffness(settings, shapes, world, a, b)
    touch.friction = contact_friction(shapes, world, a, b)
    touch.stated = Int32(0)
    touch.gain = wp.where(distance + settings.contact_slop > 0.0, real(1.0), erp) / settings.time_step
    touch.normal_law = Vector4(0.0, softness, 0.0, 0.0)
    touch.lateral_law = Vector4(0.0, 0.0, 0.0, 0.0)
    if yields_without_bounce(shapes, world, a, b):
        terms = ContactTerms()
        terms.friction = touch.friction
        terms.distance = distance
        terms.ignored = Int32(0)
        terms = let_contact_yield(settings, shapes, terms, world, a, b)
        reference, impedance, _lateral, margin, _mass, row = contact_law(settings, shapes, world, a, b)
        touch.friction = terms.friction
        touch.stated = wp.where(row >= 0, Int32(1), Int32(0))
        h = settings.time_step
        d = impedance_at(reference, impedance, distance - margin)
        slope = impedance_slope(reference, impedance, distance - margin)
        stiffness, _damping = spring_and_damper(settings, reference, impedance)
        touch.gain = h * stiffness * (d + slope * (distance - margin))
        # Relative to themselves: softness has the factor (1 - d) / d, ...
        falling = -slope / (d * (1.0 - d))
        normal_growth, lateral_growth = real(0.0), real(0.0)
        if wp.max(shapes.shape_mixing[world, a][2], shapes.shape_mixing[world, b][2]) > 0.0:
            # ... and that of a pyramid 1 + mu^2, along its normal mu^2, too.
            friction = touch.friction[0]
            lateral_growth = 2.0 * friction / (1.0 + friction * friction)
            if friction > 0.0:
                normal_growth = 2.0 / friction + lateral_growth
        normal, lateral = terms.softness, terms.lateral_softness
        touch.normal_law = Vector4(1.0 - h * terms.damping, normal, falling * normal, normal_growth * normal)
        touch.lateral_law = Vector4(1.0 - h * terms.erp, lateral, falling * lateral, lateral_growth * lateral)
    return touch


@func
def of_kind(friction: Vector3, kind: Int32) -> real:
    """The coefficient for rows of a kind, of those of a shape."""
    found = friction[0]
    if kind == ROLLING_FRICTION:
        found = friction[1]
    elif kind == SPINNING_FRICTION:
        found = friction[2]
    return found


@func
def friction_share(shapes: Shapes, world: Int32, shape: Int32, other: Int32, kind: Int32) -> real:
    """Derivative of a combined coefficient by the lateral one of a shape; see `contact_friction`.

    Rolling and spinning coefficients are multiplied by the lateral one of the other shape.
    """
    share = of_kind(friction_alone(shapes, world, other), kind)
    rank, rank_of_other = shapes.shape_friction_rank[world, shape], shapes.shape_friction_rank[world, other]
    if rank > 0 and rank_of_other > 0:
        own = of_kind(friction_of(shapes, world, shape), kind)
        share = of_kind(friction_of(shapes, world, other), kind)
        greater = rank > rank_of_other or (rank == rank_of_other and own > share)
        equal = rank == rank_of_other and own == share
        # Where both are the greater one, the mean of both sides, as of central differences.
        share = wp.where(greater, real(1.0), wp.where(equal, real(0.5), real(0.0)))
        if kind != CONTACT_FRICTION or own < LEAST_FRICTION:
            share = real(0.0)
    return share


@func
def set_friction(
    shapes: Shapes,
    space: StepSpace,
    steps: StepBatch,
    world: Int32,
    touch: TouchingLinks,
    kind: Int32,
    row: Int32,
    derivative: real,
):
    """Add to the derivatives of a row's right side by the lateral friction of the shapes of both links."""
    if touch.stated == 0:
        a, b = touch.shape_a, touch.shape_b
        of_a = derivative * friction_share(shapes, world, a, b, kind)
        of_b = derivative * friction_share(shapes, world, b, a, kind)
        set_input(space, steps, row, space.link_input[touch.link_a], INPUT_FRICTION, of_a)
        set_input(space, steps, row, space.link_input[touch.link_b], INPUT_FRICTION, of_b)


@func
def add_yielding(
    settings: Settings,
    shapes: Shapes,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
    kind: Int32,
    first: Int32,
    count: Int32,
):
    """Add what follows from α of some rows of a kind, of which there are `count` from `first` on.

    Each row asks for the velocity that it keeps, less softness times impulse, and for none of what its rate
    changes as its Jacobian turns.
    """
    n = space.dofs
    room = space.most_rows
    number = first - place * room
    law = law_of_row(settings, touch, kind)
    for row in range(first, first + count):
        for other in range(first, first + count):
            entry = row * room + number + other - first
            share = steps.alpha[entry]
            if share != 0.0:
                impulse = steps.row_impulse[other]
                steps.beta[entry] += share * law[1]
                for index in range(touch.reach):
                    dof = steps.reach[place * n + index]
                    softens = law[2] * parting(touch, steps, place * n + dof)
                    side = row * space.columns + dof
                    steps.side[side] -= share * (steps.rate[other * n + dof] + impulse * softens)
                    steps.side[side + n] += share * law[0] * steps.jacobian[other * n + dof]
                if law[3] != 0.0:
                    derivative = -share * impulse * law[3]
                    set_friction(shapes, space, steps, world, touch, CONTACT_FRICTION, row, derivative)
