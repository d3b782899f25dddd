"""Rows between two links, linearised: their Jacobians, and how these change with the positions."""

import warp as wp

from carom.kernels.linearization.dof_motion import follows
from carom.kernels.linearization.matrices import clear
from carom.kernels.linearization.rows import add_row
from carom.kernels.solver.contact_terms import torsion_softness
from carom.kernels.structs import Settings, StepBatch, StepSpace, TouchingLinks
from carom.kernels.types import Int32, Vector3, Vector4, func, real
from carom.layouts.linearization import CONTACT_FRICTION, CONTACT_ROW, MOVES_A, MOVES_B, ROW_HOLDS


@func
def direction_of(touch: TouchingLinks, number: Int32) -> Vector3:
    """The normal (0), or a friction direction (1, 2)."""
    friction = wp.where(number == 1, touch.direction1, touch.direction2)
    return wp.where(number == 0, touch.normal, friction)


@func
def law_of_row(settings: Settings, touch: TouchingLinks, kind: Int32) -> Vector4:
    """How rows of a kind yield, see `TouchingLinks`; for rolling and spinning friction the world says it."""
    about = Vector4(0.0, torsion_softness(settings), 0.0, 0.0)
    sideways = wp.where(kind == CONTACT_FRICTION, touch.lateral_law, about)
    return wp.where(kind == CONTACT_ROW, touch.normal_law, sideways)


@func
def parting(touch: TouchingLinks, steps: StepBatch, entry: Int32) -> real:
    """Derivative of the distance of a contact by a dof, whose entry in its place is given."""
    return wp.dot(touch.normal, steps.moved_a[entry] - steps.moved_b[entry])


@func
def end_change(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    dof: Int32,
    other: Int32,
    both: bool,
    point: Vector3,
    moved: Vector3,
    direction: Vector3,
    turned: Vector3,
    angular: Int32,
) -> real:
    """Change of a dof's velocity of a link along, or about, a direction, by a change of another dof.

    Args:
        space: The tangent space.
        steps: The steps.
        place: The place.
        dof: The dof; it moves the link.
        other: The other one.
        both: Whether that moves the link, too.
        point: The point of the link.
        moved: How the point of contact moves.
        direction: The direction.
        turned: How it turns.
        angular: 1 for the velocity about the direction.
    """
    own = place * space.dofs + dof
    axis, lift = steps.axis_angular[own], steps.axis_linear[own]
    none = Vector3(0.0, 0.0, 0.0)
    linear, shifted = wp.where(angular == 1, none, direction), wp.where(angular == 1, none, turned)
    about, spun = wp.where(angular == 1, direction, none), wp.where(angular == 1, turned, none)
    moment = about + wp.cross(point, linear)
    found = wp.dot(axis, spun + wp.cross(moved, linear) + wp.cross(point, shifted)) + wp.dot(lift, shifted)
    if both:
        if follows(space, dof, other):
            entry = place * space.dofs + other
            turn, shift = steps.axis_angular[entry], steps.axis_linear[entry]
            found += wp.dot(wp.cross(turn, axis), moment)
            found += wp.dot(wp.cross(turn, lift) + wp.cross(shift, axis), linear)
    return found


@func
def jacobian_change(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    touch: TouchingLinks,
    number: Int32,
    angular: Int32,
    dof: Int32,
    other: Int32,
) -> real:
    """Derivative of a dof's entry of a row's Jacobian by another dof's position."""
    n = space.dofs
    entry = place * n + other
    sides, sides_of_other = steps.reach_side[place * n + dof], steps.reach_side[entry]
    direction = direction_of(touch, number)
    turned = steps.turned[(3 * place + number) * n + other]
    found = real(0.0)
    if sides & MOVES_A != 0:
        both = sides_of_other & MOVES_A != 0
        found += end_change(
            space, steps, place, dof, other, both, touch.point_a, steps.moved_a[entry], direction, turned,
            angular,
        )  # fmt: skip
    if sides & MOVES_B != 0:
        both = sides_of_other & MOVES_B != 0
        found -= end_change(
            space, steps, place, dof, other, both, touch.point_b, steps.moved_b[entry], direction, turned,
            angular,
        )  # fmt: skip
    return found


@func
def add_turning_changes(
    space: StepSpace, steps: StepBatch, place: Int32, touch: TouchingLinks, number: Int32, angular: Int32
):
    """Add to what `write_mass_changes` has written of a row how its Jacobian turns."""
    n = space.dofs
    response = place * n * space.most_rows
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        rate = steps.response[response + dof]
        for rank in range(touch.reach):
            other = steps.reach[place * n + rank]
            bent = jacobian_change(space, steps, place, touch, number, angular, dof, other)
            steps.response[response + n + other] += 2.0 * rate * bent


@func
def add_row_of_links(
    settings: Settings,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    touch: TouchingLinks,
    kind: Int32,
    number: Int32,
    angular: Int32,
    impulse: real,
    kept: real,
) -> Int32:
    """Add a row along the direction `number` of a contact, or about it, without α and β.

    How its rate, less that of before the step of which it keeps the share `kept`, changes as its Jacobian
    turns is written to `steps.rate`.

    Returns:
        Its number among the rows of all worlds.
    """
    n = space.dofs
    row = add_row(space, steps, place, kind, ROW_HOLDS, touch.known_as, real(0.0), real(0.0))
    steps.row_impulse[row] = impulse
    clear(steps.rate, row * n, n)
    direction, none = direction_of(touch, number), Vector3(0.0, 0.0, 0.0)
    linear, about = wp.where(angular == 1, none, direction), wp.where(angular == 1, direction, none)
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        entry = place * n + dof
        axis, lift = steps.axis_angular[entry], steps.axis_linear[entry]
        value = real(0.0)
        if steps.reach_side[entry] & MOVES_A != 0:
            value += wp.dot(axis, about + wp.cross(touch.point_a, linear)) + wp.dot(lift, linear)
        if steps.reach_side[entry] & MOVES_B != 0:
            value -= wp.dot(axis, about + wp.cross(touch.point_b, linear)) + wp.dot(lift, linear)
        steps.jacobian[row * n + dof] = value
        solved = steps.velocity[(3 * place + 2) * n + dof] - kept * steps.velocity[3 * place * n + dof]
        for rank in range(touch.reach):
            other = steps.reach[place * n + rank]
            bent = jacobian_change(space, steps, place, touch, number, angular, dof, other)
            force = ((2 * place + 1) * n + dof) * space.columns + other
            steps.force[force] += impulse / settings.time_step * bent
            steps.rate[row * n + other] += solved * bent
    return row
