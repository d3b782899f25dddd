"""Contacts of a step of the converged solver, linearised: rigid ones.

Impulses follow from residuals x = J v − b by the law of the row, λ = λ(x), and x from the velocities after
the step. So dλ = −S dx, with S of Newton's method at its solution; see docs/solver.md.
"""

import warp as wp

from carom.kernels.dynamics.contact_compliance import combined_restitution, yields_without_bounce
from carom.kernels.linearization.contact_points import move_contact
from carom.kernels.linearization.contact_rows import has_factors, is_carried, touching_links
from carom.kernels.linearization.dof_motion import point_motion
from carom.kernels.linearization.link_rows import (
    add_row_of_links,
    add_turning_changes,
    direction_of,
    jacobian_change,
    parting,
)
from carom.kernels.linearization.matrices import clear
from carom.kernels.linearization.rows import note_problem, share_left
from carom.kernels.linearization.soft_rows import write_mass_changes
from carom.kernels.linearization.yielding_rows import set_friction
from carom.kernels.newton.contacts import (
    CORRECTION_STEPS,
    FASTEST_CORRECTION,
    FRICTION_REGULAR,
    LEAST_INVERSE_MASS,
    NORMAL_REGULAR,
)
from carom.kernels.newton.linear_surfaces import add_surface
from carom.kernels.newton.linear_yielding import add_yielding_contact
from carom.kernels.solver.contact_terms import (
    contact_friction,
    contact_stiffness,
)
from carom.kernels.structs import (
    Contacts,
    Model,
    Settings,
    Shapes,
    State,
    StepBatch,
    StepSpace,
    TouchingLinks,
)
from carom.kernels.types import Int32, Vector3, called_func, func, real
from carom.layouts.contacts import THERE
from carom.layouts.linearization import (
    ANISOTROPY,
    BOUNCE,
    COMPLIANT_LAW,
    CONTACT_FRICTION,
    CONTACT_ROW,
    FEATURES,
    MOVES_A,
    MOVES_B,
    MOVING_BASE,
    ROLLING_FRICTION,
    ROW_LOWER,
    ROW_SLIDES,
    ROW_UPPER,
    SPINNING_FRICTION,
)

# Vectors over the dofs in the memory of `steps.response`, behind those of `write_mass_changes`: how a contact
# parts, and how the mean inverse mass of two rows changes. Each contact has more rows than these.
_PARTING, _MEAN = wp.constant(Int32(3)), wp.constant(Int32(4))


@func
def of_contact(space: StepSpace, place: Int32, vector: Int32) -> Int32:
    """Where such a vector begins."""
    return place * space.dofs * space.most_rows + vector * space.dofs


@func
def meet_in_middle(space: StepSpace, steps: StepBatch, place: Int32, touch: TouchingLinks) -> TouchingLinks:
    """A contact both sides of which act at one point, as the solver has it; how it parts is noted before."""
    noted = of_contact(space, place, _PARTING)
    for index in range(touch.reach):
        dof = steps.reach[place * space.dofs + index]
        entry = place * space.dofs + dof
        steps.response[noted + dof] = parting(touch, steps, entry)
        moved = 0.5 * (steps.moved_a[entry] + steps.moved_b[entry])
        steps.moved_a[entry] = moved
        steps.moved_b[entry] = moved
    middle = 0.5 * (touch.point_a + touch.point_b)
    touch.point_a = middle
    touch.point_b = middle
    return touch


@func
def motion_between(space: StepSpace, steps: StepBatch, place: Int32, touch: TouchingLinks, end: Int32):
    """Velocities of a relative to b, linear and angular: before the step (0), free (1), solved (2)."""
    linear = Vector3(0.0, 0.0, 0.0)
    angular = Vector3(0.0, 0.0, 0.0)
    for index in range(touch.reach):
        dof = steps.reach[place * space.dofs + index]
        entry = place * space.dofs + dof
        rate = steps.velocity[(3 * place + end) * space.dofs + dof]
        if steps.reach_side[entry] & MOVES_A != 0:
            linear += rate * point_motion(steps, entry, touch.point_a)
            angular += rate * steps.axis_angular[entry]
        if steps.reach_side[entry] & MOVES_B != 0:
            linear -= rate * point_motion(steps, entry, touch.point_b)
            angular -= rate * steps.axis_angular[entry]
    return linear, angular


@func
def own_mass(
    model: Model,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
    row: Int32,
    number: Int32,
    angular: Int32,
) -> real:
    """The inverse mass of a row; its changes with the positions are written as by `write_mass_changes`."""
    inverse_mass = write_mass_changes(model, state, space, steps, place, world, row)
    add_turning_changes(space, steps, place, touch, number, angular)
    return inverse_mass


@func
def push_row(
    settings: Settings,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    touch: TouchingLinks,
    row: Int32,
    number: Int32,
    angular: Int32,
    impulse: real,
):
    """Give a row that was added without one its impulse."""
    steps.row_impulse[row] = impulse
    for index in range(touch.reach):
        dof = steps.reach[place * space.dofs + index]
        for rank in range(touch.reach):
            other = steps.reach[place * space.dofs + rank]
            bent = jacobian_change(space, steps, place, touch, number, angular, dof, other)
            force = ((2 * place + 1) * space.dofs + dof) * space.columns + other
            steps.force[force] += impulse / settings.time_step * bent


@func
def add_rigid_normal(
    model: Model,
    settings: Settings,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
) -> Int32:
    """Add the row of a normal that presses; returns its number among the rows of all worlds."""
    n, h = space.dofs, settings.time_step
    impulse = contacts.contact_impulse[world, touch.contact][0]
    gap = contacts.contact_distance[world, touch.contact]
    row = add_row_of_links(settings, space, steps, place, touch, CONTACT_ROW, 0, Int32(0), impulse, real(0.0))
    regular = NORMAL_REGULAR * own_mass(model, state, space, steps, place, world, touch, row, 0, 0)
    regular += settings.contact_softness
    share = real(NORMAL_REGULAR)
    gain = 1.0 / h
    if gap <= 0.0:
        gain = wp.where(-gap < FASTEST_CORRECTION * CORRECTION_STEPS * h, gain / CORRECTION_STEPS, real(0.0))
    a, b = touch.shape_a, touch.shape_b
    if shapes.shape_stiffness[world, a] >= 0.0 or shapes.shape_stiffness[world, b] >= 0.0:
        softness, erp = contact_stiffness(settings, shapes, world, a, b)
        if softness > regular:
            regular = softness + 0.0
            share = real(0.0)
        if gap <= 0.0:
            gain = erp / h
    entry = row * space.most_rows + row - place * space.most_rows
    steps.alpha[entry] = 1.0
    steps.beta[entry] = regular
    steps.row_yield[row] = share
    change, parts = of_contact(space, place, 1), of_contact(space, place, _PARTING)
    for dof in range(n):
        found = -steps.rate[row * n + dof] - impulse * share * steps.response[change + dof]
        steps.side[row * space.columns + dof] = found
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        steps.side[row * space.columns + dof] -= gain * steps.response[parts + dof]
    steps.row_switch[row] = wp.abs(gap)
    return row


@func
def add_disc(
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
    motion: Vector3,
    memory: Vector3,
):
    """Add two rows of friction, lateral or rolling, whose impulse together is bounded.

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
        motion: Velocity, or angular velocity, of a relative to b after the step.
        memory: The impulse of the substep before, in world axes.
    """
    n, room = space.dofs, space.most_rows
    angular = wp.where(kind == CONTACT_FRICTION, Int32(0), Int32(1))
    first = add_row_of_links(settings, space, steps, place, touch, kind, 1, angular, real(0.0), real(0.0))
    add_row_of_links(settings, space, steps, place, touch, kind, 2, angular, real(0.0), real(0.0))
    for i in range(2):
        slip = add_surface(
            state, shapes, space, steps, place, world, touch, first + i, 1 + i, angular, real(0.0)
        )
        motion = motion + slip * direction_of(touch, 1 + i)
    number = first - place * room
    mean, change = of_contact(space, place, _MEAN), of_contact(space, place, 1)
    clear(steps.response, mean, n)
    inverse_mass = real(0.0)
    for i in range(2):
        inverse_mass += 0.5 * own_mass(
            model, state, space, steps, place, world, touch, first + i, 1 + i, angular
        )
        for dof in range(n):
            steps.response[mean + dof] += 0.5 * FRICTION_REGULAR * steps.response[change + dof]
    if friction <= 0.0 or inverse_mass <= LEAST_INVERSE_MASS:
        for i in range(2):
            steps.beta[(first + i) * room + number + i] = 1.0
        return
    regular = FRICTION_REGULAR * inverse_mass
    axis1, axis2 = direction_of(touch, 1), direction_of(touch, 2)
    x = wp.dot(motion - regular * memory, axis1)
    y = wp.dot(motion - regular * memory, axis2)
    length = wp.sqrt(x * x + y * y)
    push = steps.row_impulse[normal]
    bound = friction * push
    slides = length > regular * bound
    stiffness = 1.0 / regular
    if slides:
        stiffness = bound / length
    for i in range(2):
        rate = wp.where(i == 0, x, y)
        row = first + i
        impulse = -stiffness * rate
        push_row(settings, space, steps, place, touch, row, 1 + i, angular, impulse)
        steps.row_yield[row] = FRICTION_REGULAR
        entry = row * room + number
        if slides:
            steps.row_status[row] = ROW_SLIDES
            along = rate / length
            steps.beta[entry + i] = 1.0
            steps.beta[row * room + normal - place * room] = friction * along
            steps.alpha[entry] = -stiffness * along * x / length
            steps.alpha[entry + 1] = -stiffness * along * y / length
            steps.alpha[entry + i] += stiffness
            set_friction(shapes, space, steps, world, touch, kind, row, -along * push)
        else:
            steps.alpha[entry + i] = 1.0
            steps.beta[entry + i] = regular
            steps.row_switch[row] = 1.0 - length / (regular * bound)
        for j in range(2):
            share = steps.alpha[entry + j]
            if share != 0.0:
                other = first + j
                pulled = wp.dot(memory, wp.where(j == 0, axis1, axis2))
                for dof in range(n):
                    softens = steps.response[mean + dof]
                    found = softens * pulled - steps.rate[other * n + dof]
                    if not slides:
                        found -= softens * impulse
                    steps.side[row * space.columns + dof] += share * found
                for index in range(touch.reach):
                    dof = steps.reach[place * n + index]
                    turned = steps.turned[(3 * place + 1 + j) * n + dof]
                    steps.side[row * space.columns + dof] += share * regular * wp.dot(memory, turned)


@func
def add_spinning(
    model: Model,
    settings: Settings,
    state: State,
    shapes: Shapes,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
    normal: Int32,
    friction: real,
    rate: real,
):
    """Add the row of spinning friction; `rate` is that of the rows after the step."""
    n = space.dofs
    row = add_row_of_links(
        settings, space, steps, place, touch, SPINNING_FRICTION, 0, Int32(1), real(0.0), real(0.0)
    )
    rate = rate + add_surface(
        state, shapes, space, steps, place, world, touch, row, Int32(0), Int32(1), real(0.0)
    )
    entry = row * space.most_rows + row - place * space.most_rows
    inverse_mass = own_mass(model, state, space, steps, place, world, touch, row, 0, 1)
    if inverse_mass <= LEAST_INVERSE_MASS:
        steps.beta[entry] = 1.0
        return
    regular = FRICTION_REGULAR * inverse_mass
    push = steps.row_impulse[normal]
    bound = friction * push
    impulse = wp.clamp(-rate / regular, -bound, bound)
    push_row(settings, space, steps, place, touch, row, 0, 1, impulse)
    if wp.abs(rate) < regular * bound:
        steps.alpha[entry] = 1.0
        steps.beta[entry] = regular
        steps.row_yield[row] = FRICTION_REGULAR
        steps.row_switch[row] = share_left(impulse, -bound, bound)
        change = of_contact(space, place, 1)
        for dof in range(n):
            softens = FRICTION_REGULAR * steps.response[change + dof]
            steps.side[row * space.columns + dof] = -steps.rate[row * n + dof] - impulse * softens
    else:
        sign = wp.where(rate > 0.0, real(-1.0), real(1.0))
        steps.row_status[row] = wp.where(rate > 0.0, Int32(ROW_LOWER), Int32(ROW_UPPER))
        steps.beta[entry] = 1.0
        steps.beta[row * space.most_rows + normal - place * space.most_rows] = -sign * friction
        set_friction(shapes, space, steps, world, touch, SPINNING_FRICTION, row, sign * push)


@called_func
def add_converged_contact(
    model: Model,
    settings: Settings,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    contact: Int32,
):
    """Add the rows of a contact."""
    touch = touching_links(model, shapes, contacts, space, steps, place, world, contact)
    a, b = touch.shape_a, touch.shape_b
    if not move_contact(state, shapes, space, steps, place, world, touch, a, b):
        note_problem(steps, place, FEATURES, touch.known_as)
        return
    if is_carried(model, state, world, shapes.shape_tree[a]) or (
        is_carried(model, state, world, shapes.shape_tree[b])
    ):
        note_problem(steps, place, MOVING_BASE, touch.known_as)
    if has_factors(shapes, world, a) or has_factors(shapes, world, b):
        note_problem(steps, place, ANISOTROPY, touch.known_as)
    touch = meet_in_middle(space, steps, place, touch)
    before, before_about = motion_between(space, steps, place, touch, 0)
    after, about = motion_between(space, steps, place, touch, 2)
    restitution = combined_restitution(shapes, world, a, b)
    if space.law == COMPLIANT_LAW and yields_without_bounce(shapes, world, a, b):
        add_yielding_contact(
            settings, state, shapes, contacts, space, steps, place, world, touch, before, before_about, after,
            about, of_contact(space, place, _PARTING),
        )  # fmt: skip
        return
    free, _about = motion_between(space, steps, place, touch, 1)
    if restitution > 0.0 and -wp.dot(free, touch.normal) >= settings.restitution_threshold:
        note_problem(steps, place, BOUNCE, touch.known_as)
    touch.stated = Int32(0)
    touch.friction = contact_friction(shapes, world, a, b)
    normal = add_rigid_normal(model, settings, state, shapes, contacts, space, steps, place, world, touch)
    none = Vector3(0.0, 0.0, 0.0)
    add_disc(
        model, settings, state, shapes, space, steps, place, world, touch, CONTACT_FRICTION, normal,
        touch.friction[0], after, contacts.contact_anchor_b[world, contact],
    )  # fmt: skip
    if touch.friction[1] > 0.0:
        add_disc(
            model, settings, state, shapes, space, steps, place, world, touch, ROLLING_FRICTION, normal,
            touch.friction[1], about, none,
        )  # fmt: skip
    if touch.friction[2] > 0.0:
        add_spinning(
            model, settings, state, shapes, space, steps, place, world, touch, normal, touch.friction[2],
            wp.dot(about, touch.normal),
        )  # fmt: skip


@func
def add_converged_contacts(
    model: Model,
    settings: Settings,
    state: State,
    shapes: Shapes,
    contacts: Contacts,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
):
    """Add the rows of all contacts that push."""
    for contact in range(contacts.count_contacts[world, THERE]):
        if contacts.contact_impulse[world, contact][0] > 0.0:
            add_converged_contact(
                model, settings, state, shapes, contacts, space, steps, place, world, contact
            )
