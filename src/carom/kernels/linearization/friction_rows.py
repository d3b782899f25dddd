"""Rows of friction of contacts, linearised: the impulse of a normal row bounds them."""

import warp as wp

from carom.kernels.linearization.link_rows import add_row_of_links, add_turning_changes, law_of_row, parting
from carom.kernels.linearization.rows import share_left, status_of
from carom.kernels.linearization.soft_rows import write_mass_changes
from carom.kernels.linearization.yielding_rows import add_yielding, set_friction
from carom.kernels.newton.linear_surfaces import add_surface
from carom.kernels.structs import Model, Settings, Shapes, State, StepBatch, StepSpace, TouchingLinks
from carom.kernels.types import Int32, called_func, func, real
from carom.layouts.codes import ISOTROPIC
from carom.layouts.linearization import (
    CONTACT_FRICTION,
    ROW_HOLDS,
    ROW_LOWER,
    ROW_SLIDES,
    SPINNING_FRICTION,
)

# An impulse below this share of its bound sticks.
_STICKS = wp.constant(real(1.0 - 1.0e-7))


@func
def moves(space: StepSpace, steps: StepBatch, row: Int32) -> bool:
    """Whether anything moves along a row."""
    found = Int32(0)
    for dof in range(space.dofs):
        if steps.jacobian[row * space.dofs + dof] != 0.0:
            found = Int32(1)
    return found == 1


@func
def add_mass_changes(
    model: Model,
    settings: Settings,
    state: State,
    shapes: Shapes,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
    kind: Int32,
    row: Int32,
    number: Int32,
    factor: real,
    side: Int32,
) -> real:
    """Add derivatives of a row's effective mass, times a factor, to the right sides of another.

    They are those by positions and by friction, by which softness may change.

    With isotropic friction both rows take the same steps, so only their ratio counts, which is 1.

    Args:
        model: The model.
        settings: The settings.
        state: The state.
        shapes: The shapes.
        space: The tangent space.
        steps: The steps.
        place: The place.
        world: The world.
        touch: The contact.
        kind: Kind of both rows.
        row: The row.
        number: Its direction.
        factor: The factor.
        side: The other row.

    Returns:
        The effective mass.
    """
    if settings.cone_friction == ISOTROPIC:
        return real(1.0)
    n = space.dofs
    angular = wp.where(kind == CONTACT_FRICTION, Int32(0), Int32(1))
    law = law_of_row(settings, touch, kind)
    inverse = law[1] + write_mass_changes(model, state, space, steps, place, world, row)
    add_turning_changes(space, steps, place, touch, number, angular)
    change = place * n * space.most_rows + n
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        steps.response[change + dof] += law[2] * parting(touch, steps, place * n + dof)
    factor /= inverse * inverse
    for dof in range(n):
        steps.side[side * space.columns + dof] -= factor * steps.response[change + dof]
    if law[3] != 0.0:
        set_friction(shapes, space, steps, world, touch, CONTACT_FRICTION, side, -factor * law[3])
    return 1.0 / inverse


@func
def slide(
    model: Model,
    settings: Settings,
    state: State,
    shapes: Shapes,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
    kind: Int32,
    normal: Int32,
    first: Int32,
    friction: real,
):
    """Set the equations of two rows whose impulses together are at their bound."""
    n = space.dofs
    room = space.most_rows
    number = first - place * room
    second = first + 1
    entry, entry_of_second = first * room + number, second * room + number
    x, y = steps.row_impulse[first], steps.row_impulse[second]
    size = wp.sqrt(x * x + y * y)
    if size == 0.0:
        steps.row_asked[first] = 0.0
        steps.row_asked[second] = 0.0
        steps.beta[entry] = 1.0
        steps.beta[entry_of_second + 1] = 1.0
    else:
        # The impulse is as great as the bound, ...
        steps.beta[entry] = x / size
        steps.beta[entry + 1] = y / size
        steps.beta[first * room + normal - place * room] = -friction
        # ... and opposite to the change of the impulses that the rows still ask for.
        law = law_of_row(settings, touch, kind)
        asked = law[1] * x + steps.row_asked[first]
        asked_of_second = law[1] * y + steps.row_asked[second]
        for index in range(touch.reach):
            dof = steps.reach[place * n + index]
            lost = steps.velocity[(3 * place + 2) * n + dof] - law[0] * steps.velocity[3 * place * n + dof]
            asked += steps.jacobian[first * n + dof] * lost
            asked_of_second += steps.jacobian[second * n + dof] * lost
        mass = add_mass_changes(
            model, settings, state, shapes, space, steps, place, world, touch, kind, first, 1, -y * asked,
            second,
        )  # fmt: skip
        mass_of_second = add_mass_changes(
            model, settings, state, shapes, space, steps, place, world, touch, kind, second, 2,
            x * asked_of_second, second,
        )  # fmt: skip
        steps.row_asked[first] = asked
        steps.row_asked[second] = asked_of_second
        steps.row_mass[first] = mass
        steps.row_mass[second] = mass_of_second
        steps.alpha[entry_of_second] = mass * y
        steps.alpha[entry_of_second + 1] = -mass_of_second * x
        steps.beta[entry_of_second] = -mass_of_second * asked_of_second
        steps.beta[entry_of_second + 1] = mass * asked


@func
def bound_alone(
    shapes: Shapes,
    space: StepSpace,
    steps: StepBatch,
    world: Int32,
    touch: TouchingLinks,
    kind: Int32,
    row: Int32,
    number: Int32,
    of_normal: Int32,
    friction: real,
    push: real,
):
    """Set the equation of a row whose impulse has a bound of its own.

    `number` is that of the row in its world, `of_normal` that of the normal row.
    """
    bound = friction * push * _STICKS
    status = status_of(steps.row_impulse[row], -bound, bound)
    if not moves(space, steps, row):
        # It is off, and its impulse 0.
        status = Int32(ROW_HOLDS)
        steps.beta[row * space.most_rows + number] = 1.0
    elif status == ROW_HOLDS:
        steps.alpha[row * space.most_rows + number] = 1.0
        steps.row_switch[row] = share_left(steps.row_impulse[row], -bound, bound)
    else:
        sign = wp.where(status == ROW_LOWER, real(-1.0), real(1.0))
        steps.beta[row * space.most_rows + number] = 1.0
        steps.beta[row * space.most_rows + of_normal] = -sign * friction
        set_friction(shapes, space, steps, world, touch, kind, row, sign * push)
    steps.row_status[row] = status


@called_func
def add_friction_rows(
    model: Model,
    settings: Settings,
    state: State,
    shapes: Shapes,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
    kind: Int32,
    normal: Int32,
    friction: real,
    x: real,
    y: real,
):
    """Add the two rows of lateral or rolling friction, or that of spinning friction.

    Args:
        model: The model.
        settings: The settings.
        state: The state.
        shapes: The shapes.
        space: The tangent space.
        steps: The steps.
        place: The place.
        world: The world.
        touch: The contact.
        kind: Kind of the rows.
        normal: Its normal row among the rows of all worlds.
        friction: Coefficient of friction.
        x: Impulse of the first row.
        y: That of the second one.
    """
    room = space.most_rows
    angular = wp.where(kind == CONTACT_FRICTION, Int32(0), Int32(1))
    alone = kind == SPINNING_FRICTION
    direction = wp.where(alone, Int32(0), Int32(1))
    kept = law_of_row(settings, touch, kind)[0]
    first = add_row_of_links(settings, space, steps, place, touch, kind, direction, angular, x, kept)
    count = Int32(1)
    if not alone:
        add_row_of_links(settings, space, steps, place, touch, kind, 2, angular, y, kept)
        count = Int32(2)
    for index in range(count):
        # Those that slide take it from there.
        steps.row_asked[first + index] = add_surface(
            state, shapes, space, steps, place, world, touch, first + index, direction + index, angular, kept
        )
    number = first - place * room
    push = steps.row_impulse[normal]
    whole = not alone and settings.cone_friction != 0
    if whole:
        whole = moves(space, steps, first) and moves(space, steps, first + 1)
    if not whole:
        for index in range(count):
            bound_alone(
                shapes, space, steps, world, touch, kind, first + index, number + index,
                normal - place * room, friction, push,
            )  # fmt: skip
    elif wp.sqrt(x * x + y * y) < friction * push * _STICKS:
        for index in range(2):
            steps.alpha[(first + index) * room + number + index] = 1.0
            steps.row_switch[first + index] = 1.0 - wp.sqrt(x * x + y * y) / (friction * push)
    else:
        steps.row_status[first] = ROW_SLIDES
        steps.row_status[first + 1] = ROW_SLIDES
        slide(
            model, settings, state, shapes, space, steps, place, world, touch, kind, normal, first, friction
        )
        if x != 0.0 or y != 0.0:
            set_friction(shapes, space, steps, world, touch, kind, first, push)
    add_yielding(settings, shapes, space, steps, place, world, touch, kind, first, count)
