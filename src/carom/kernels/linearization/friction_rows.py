"""Rows of friction of contacts, linearised: the impulse of a normal row bounds them."""

import warp as wp

from carom.kernels.linearization.dof_motion import add_inertia_changes
from carom.kernels.linearization.link_rows import add_row_of_links, add_turning, jacobian_change
from carom.kernels.linearization.matrices import add_products, clear
from carom.kernels.linearization.rows import set_input, status_of
from carom.kernels.structs import Model, Settings, Shapes, State, StepBatch, StepSpace, TouchingLinks
from carom.kernels.types import Int32, func, real
from carom.layouts.codes import ISOTROPIC
from carom.layouts.linearization import (
    CONTACT_FRICTION,
    INPUT_FRICTION,
    ROLLING_FRICTION,
    ROW_HOLDS,
    ROW_LOWER,
    ROW_SLIDES,
    SPINNING_FRICTION,
)

# An impulse below this share of its bound sticks.
_STICKS = wp.constant(real(1.0 - 1.0e-7))


@func
def friction_of_link(shapes: Shapes, world: Int32, link: Int32, kind: Int32) -> real:
    """The coefficient of a link for rows of a kind."""
    found = shapes.link_lateral_friction[world, link]
    if kind == ROLLING_FRICTION:
        found = shapes.link_rolling_friction[world, link]
    elif kind == SPINNING_FRICTION:
        found = shapes.link_spinning_friction[world, link]
    return found


@func
def friction_share(shapes: Shapes, world: Int32, link: Int32, other: Int32, kind: Int32) -> real:
    """Derivative of a combined coefficient by the lateral one of a link; see `contact_friction`.

    Rolling and spinning coefficients are multiplied by the lateral one of the other link.
    """
    share = friction_of_link(shapes, world, other, kind)
    rank, rank_of_other = shapes.link_friction_rank[world, link], shapes.link_friction_rank[world, other]
    if rank > 0 and rank_of_other > 0:
        own = friction_of_link(shapes, world, link, kind)
        greater = rank > rank_of_other or (rank == rank_of_other and own >= share)
        share = wp.where(greater and kind == CONTACT_FRICTION, real(1.0), real(0.0))
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
    """Set the derivatives of a row's right side by the lateral friction of both links."""
    a, b = touch.link_a, touch.link_b
    of_a = derivative * friction_share(shapes, world, a, b, kind)
    of_b = derivative * friction_share(shapes, world, b, a, kind)
    set_input(space, steps, row, space.link_input[a], INPUT_FRICTION, of_a)
    set_input(space, steps, row, space.link_input[b], INPUT_FRICTION, of_b)


@func
def add_mass_changes(
    model: Model,
    settings: Settings,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
    row: Int32,
    number: Int32,
    angular: Int32,
    factor: real,
    side: Int32,
) -> real:
    """Add derivatives of a row's effective mass by positions, times a factor, to the right sides of another.

    With isotropic friction both rows take the same steps, so only their ratio counts, which is 1.

    Args:
        model: The model.
        settings: The settings.
        state: The state.
        space: The tangent space.
        steps: The steps.
        place: The place.
        world: The world.
        touch: The contact.
        row: The row.
        number: Its direction.
        angular: 1 for a row about it.
        factor: The factor.
        side: The other row.

    Returns:
        The effective mass.
    """
    if settings.cone_friction == ISOTROPIC:
        return real(1.0)
    n = space.dofs
    # The memory of M⁻¹ Jᵀ of all rows, which is written later.
    response = place * n * space.most_rows
    change = response + n
    clear(steps.response, response, 2 * n)
    add_products(
        steps.response, response, n, real(1.0), steps.jacobian, row * n, n,
        steps.inverse, place * n * n, n, 1, n, n,
    )  # fmt: skip
    inverse = real(0.0)
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        rate = steps.response[response + dof]
        inverse += rate * steps.jacobian[row * n + dof]
        for rank in range(touch.reach):
            other = steps.reach[place * n + rank]
            bent = jacobian_change(space, steps, place, touch, number, angular, dof, other)
            steps.response[change + other] += 2.0 * rate * bent
    tree = space.dof_tree[steps.reach[place * n]]
    last = space.dof_tree[steps.reach[place * n + touch.reach - 1]]
    add_inertia_changes(model, state, space, steps, place, world, tree, response, change)
    if last != tree:
        add_inertia_changes(model, state, space, steps, place, world, last, response, change)
    for dof in range(n):
        steps.side[side * space.columns + dof] -= factor * steps.response[change + dof] / (inverse * inverse)
    return 1.0 / inverse


@func
def slide(
    model: Model,
    settings: Settings,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
    angular: Int32,
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
        steps.beta[entry] = 1.0
        steps.beta[entry_of_second + 1] = 1.0
    else:
        # The impulse is as great as the bound, ...
        steps.beta[entry] = x / size
        steps.beta[entry + 1] = y / size
        steps.beta[first * room + normal - place * room] = -friction
        # ... and opposite to the change of the impulses that the rows still ask for.
        rate, rate_of_second = real(0.0), real(0.0)
        for index in range(touch.reach):
            dof = steps.reach[place * n + index]
            solved = steps.velocity[(3 * place + 2) * n + dof]
            rate += steps.jacobian[first * n + dof] * solved
            rate_of_second += steps.jacobian[second * n + dof] * solved
        mass = add_mass_changes(
            model, settings, state, space, steps, place, world, touch, first, 1, angular, -y * rate, second
        )
        mass_of_second = add_mass_changes(
            model, settings, state, space, steps, place, world, touch, second, 2, angular,
            x * rate_of_second, second,
        )  # fmt: skip
        steps.alpha[entry_of_second] = mass * y
        steps.alpha[entry_of_second + 1] = -mass_of_second * x
        steps.beta[entry_of_second] = -mass_of_second * rate_of_second
        steps.beta[entry_of_second + 1] = mass * rate


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
    steps.row_status[row] = status
    if status == ROW_HOLDS:
        steps.alpha[row * space.most_rows + number] = 1.0
    else:
        sign = wp.where(status == ROW_LOWER, real(-1.0), real(1.0))
        steps.beta[row * space.most_rows + number] = 1.0
        steps.beta[row * space.most_rows + of_normal] = -sign * friction
        set_friction(shapes, space, steps, world, touch, kind, row, sign * push)


@func
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
    first = add_row_of_links(settings, space, steps, place, touch, kind, direction, angular, x)
    count = Int32(1)
    if not alone:
        add_row_of_links(settings, space, steps, place, touch, kind, 2, angular, y)
        count = Int32(2)
    number = first - place * room
    push = steps.row_impulse[normal]
    if alone or settings.cone_friction == 0:
        for index in range(count):
            bound_alone(
                shapes, space, steps, world, touch, kind, first + index, number + index,
                normal - place * room, friction, push,
            )  # fmt: skip
    elif wp.sqrt(x * x + y * y) < friction * push * _STICKS:
        for index in range(2):
            steps.alpha[(first + index) * room + number + index] = 1.0
    else:
        steps.row_status[first] = ROW_SLIDES
        steps.row_status[first + 1] = ROW_SLIDES
        slide(model, settings, state, space, steps, place, world, touch, angular, normal, first, friction)
        if x != 0.0 or y != 0.0:
            set_friction(shapes, space, steps, world, touch, kind, first, push)
    add_turning(space, steps, place, touch, first, count)
