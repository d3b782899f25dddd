"""The derivatives of a step: its rows, how their impulses follow changes, and the state after it."""

import warp as wp

from carom.kernels.adhesion.linear import add_all_adhesion
from carom.kernels.linearization.actuator_law import write_activations
from carom.kernels.linearization.contact_rows import add_contacts, pushing_contacts
from carom.kernels.linearization.dof_motion import find_axes
from carom.kernels.linearization.fluid_forces import add_fluid_changes
from carom.kernels.linearization.joint_rows import add_joint_rows
from carom.kernels.linearization.matrices import (
    add_products,
    clear,
    inverse_of_rows,
    scaled_row,
    transposed,
)
from carom.kernels.linearization.rows import make_room
from carom.kernels.linearization.user_rows import add_users
from carom.kernels.mechanism.sweep import cross_matrix
from carom.kernels.newton.linear_contacts import add_converged_contacts
from carom.kernels.newton.open_contacts import note_open_contacts
from carom.kernels.structs import (
    Contacts,
    Model,
    PairRows,
    Scratch,
    Settings,
    Shapes,
    State,
    StepBatch,
    StepSpace,
    UserConstraints,
)
from carom.kernels.types import Int32, Matrix3, Vector3, func, kernel, real
from carom.layouts.linearization import (
    ALL_STAGES,
    BALL_DOF,
    BASE_DOF,
    COMPLIANT_LAW,
    EQUATIONS_STAGE,
    FOUND,
    PLANE_DOF,
    REDUNDANT,
    ROWS_STAGE,
    SWEPT_LAW,
)

# Rows may be redundant where the product of the sizes of their equations and of the inverse is not below
# this: no number of sweeps resolves them.
_MOST = wp.constant(real(1.0e7))
# Those of the converged solver are never redundant, as each yields a little.
_MOST_CONVERGED = wp.constant(real(1.0e12))
# Angles below this have their derivatives by series.
_SERIES = wp.constant(real(1.0e-4))


@func
def find_impulses(space: StepSpace, steps: StepBatch, place: Int32):
    """The impulses on dofs that are not of the rows which are there."""
    n = space.dofs
    velocity = 3 * place * n
    for dof in range(n):
        total = real(0.0)
        for other in range(n):
            change = steps.velocity[velocity + 2 * n + other] - steps.velocity[velocity + n + other]
            total += steps.effective[(place * n + dof) * n + other] * change
        for index in range(steps.row_count[place]):
            row = place * space.most_rows + index
            total -= steps.row_impulse[row] * steps.jacobian[row * n + dof]
        steps.impulse[place * n + dof] = total


@func
def find_changes(settings: Settings, space: StepSpace, steps: StepBatch, place: Int32):
    """Changes of velocities without impulses, and with constant ones."""
    n = space.dofs
    columns = space.columns
    first = 2 * place * n * columns
    ends = wp.where(steps.row_count[place] > 0, Int32(2), Int32(1))
    clear(steps.change, first, 2 * n * columns)
    for end in range(ends):
        own = first + end * n * columns
        add_products(
            steps.change, own, columns, settings.time_step, steps.inverse, place * n * n, n,
            steps.force, own, columns, n, n, columns,
        )  # fmt: skip
        for dof in range(n):
            steps.change[own + dof * columns + n + dof] += 1.0


@func
def write_equations(space: StepSpace, steps: StepBatch, place: Int32) -> Int32:
    """Write the equations of the rows, and their inverse; returns 0 if they may be redundant.

    They are (α J M⁻¹ Jᵀ + β) dλ = side + through dv* - α J dv, where dv are changes of velocities at constant
    impulses, and dv* those without impulses.
    """
    n = space.dofs
    columns = space.columns
    count = steps.row_count[place]
    room = space.most_rows
    row = place * room
    jacobian = row * n
    square = row * room
    one = real(1.0)
    # M⁻¹ Jᵀ, by way of J M⁻¹ as M is symmetric.
    clear(steps.rate, jacobian, count * n)
    add_products(
        steps.rate, jacobian, n, one, steps.jacobian, jacobian, n, steps.inverse, place * n * n, n,
        count, n, n,
    )  # fmt: skip
    transposed(steps.response, jacobian, room, steps.rate, jacobian, n, count, n)
    if space.smoothing > 0.0:
        for other in range(count):
            softness = real(0.0)
            for dof in range(n):
                softness += (
                    steps.jacobian[jacobian + other * n + dof] * steps.rate[jacobian + other * n + dof]
                )
            for index in range(count):
                entry = square + index * room + other
                steps.beta[entry] += space.smoothing * softness * steps.alpha[entry]
    clear(steps.rate, jacobian, count * n)
    add_products(
        steps.rate, jacobian, n, one, steps.alpha, square, room, steps.jacobian, jacobian, n,
        count, count, n,
    )  # fmt: skip
    for index in range(count):
        for other in range(count):
            steps.system[square + index * count + other] = steps.beta[square + index * room + other]
    add_products(
        steps.system, square, count, one, steps.rate, jacobian, n, steps.response, jacobian, room,
        count, n, count,
    )  # fmt: skip
    wanted = row * columns
    for entry in range(count * columns):
        steps.wanted[wanted + entry] = steps.side[wanted + entry]
    free = 2 * place * n * columns
    add_products(
        steps.wanted, wanted, columns, one, steps.through, jacobian, n, steps.change, free, columns,
        count, n, columns,
    )  # fmt: skip
    add_products(
        steps.wanted, wanted, columns, -one, steps.rate, jacobian, n,
        steps.change, free + n * columns, columns, count, n, columns,
    )  # fmt: skip
    for index in range(count):
        scaled_row(
            steps.system, square + index * count, count, steps.wanted, wanted + index * columns, columns
        )
    most = wp.where(space.law == SWEPT_LAW, _MOST, _MOST_CONVERGED)
    return inverse_of_rows(steps.solution, square, steps.system, square, count, steps.alpha, square, most)


@func
def put_block(
    space: StepSpace, steps: StepBatch, place: Int32, dof: Int32, by_position: Matrix3, by_velocity: Matrix3
):
    """Put the derivatives of three positions that are turned together."""
    columns = space.columns
    first = place * space.states * columns + dof * columns
    velocity = first + space.dofs * columns
    for column in range(columns):
        changed = by_velocity * Vector3(
            steps.step[velocity + column],
            steps.step[velocity + columns + column],
            steps.step[velocity + 2 * columns + column],
        )
        for axis in range(3):
            steps.step[first + axis * columns + column] = changed[axis]
    for axis in range(3):
        for other in range(3):
            steps.step[first + axis * columns + dof + other] += by_position[axis, other]


@func
def integrate(
    settings: Settings, state: State, space: StepSpace, steps: StepBatch, place: Int32, world: Int32
):
    """Write the derivatives of positions after the step; those of velocities are there."""
    n = space.dofs
    columns = space.columns
    h = settings.time_step
    first = place * space.states * columns
    for dof in range(n):
        for column in range(columns):
            steps.step[first + dof * columns + column] = h * steps.step[first + (n + dof) * columns + column]
        steps.step[first + dof * columns + dof] += 1.0
    for dof in range(n):
        kind = space.dof_first[dof]
        row = space.dof_row[dof]
        if kind == BASE_DOF or kind == BALL_DOF:
            turn = h * Vector3(
                state.dof_velocity[world, row],
                state.dof_velocity[world, row + 1],
                state.dof_velocity[world, row + 2],
            )
            if kind == BALL_DOF:
                # Changes are along the axes of the link.
                turn = -turn
            angle = wp.length(turn)
            sine = 1.0 - angle * angle / 6.0
            versine = 0.5 - angle * angle / 24.0
            rest = real(0.16666666666666666)
            if angle >= _SERIES:
                sine = wp.sin(angle) / angle
                half = wp.sin(0.5 * angle) / angle
                versine = 2.0 * half * half
                rest = (1.0 - sine) / (angle * angle)
            unit = Matrix3(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
            skew = cross_matrix(turn)
            outer = wp.outer(turn, turn)
            rotation = (1.0 - versine * angle * angle) * unit + sine * skew + versine * outer
            put_block(space, steps, place, dof, rotation, h * (sine * unit + versine * skew + rest * outer))
        elif kind == PLANE_DOF:
            hand = space.dof_hand[dof]
            angle = -hand * h * state.dof_velocity[world, row]
            x = -hand * h * state.dof_velocity[world, row + 2]
            y = hand * h * state.dof_velocity[world, row + 1]
            cosine, sine = wp.cos(angle), wp.sin(angle)
            put_block(
                space, steps, place, dof,
                Matrix3(1.0, 0.0, 0.0, x, cosine, -sine, y, sine, cosine),
                Matrix3(h, 0.0, 0.0, h * x, h, 0.0, h * y, 0.0, h),
            )  # fmt: skip


@func
def write_step(
    model: Model,
    settings: Settings,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
):
    """Write the derivatives of velocities and positions after the step."""
    n = space.dofs
    columns = space.columns
    count = steps.row_count[place]
    change = 2 * place * n * columns
    if count > 0:
        change += n * columns
        row = place * space.most_rows
        # The right sides are in `wanted`: their memory takes the impulses.
        clear(steps.side, row * columns, count * columns)
        add_products(
            steps.side, row * columns, columns, real(1.0), steps.solution, row * space.most_rows, count,
            steps.wanted, row * columns, columns, count, count, columns,
        )  # fmt: skip
        add_products(
            steps.change, change, columns, real(1.0), steps.response, row * n, space.most_rows,
            steps.side, row * columns, columns, n, count, columns,
        )  # fmt: skip
    first = place * space.states * columns
    clear(steps.step, first, space.states * columns)
    for dof in range(n):
        solved = steps.velocity[(3 * place + 2) * n + dof]
        # A velocity at its greatest value stays there.
        if wp.abs(solved) < model.tree_max_velocity[world, space.dof_tree[dof]]:
            for column in range(columns):
                steps.step[first + (n + dof) * columns + column] = steps.change[
                    change + dof * columns + column
                ]
    integrate(settings, state, space, steps, place, world)


@kernel
def solution_of_step_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    shapes: Shapes,
    contacts: Contacts,
    pair_rows: PairRows,
    space: StepSpace,
    steps: StepBatch,
    stage: Int32,
    first_world: Int32,
):
    """Find the derivatives of the step of a world, of which `motion_of_step_kernel` has all bodies.

    `stage` says which part of it: see `layouts.linearization`.
    """
    place = first_world + wp.tid()
    world = steps.world[place]
    if steps.problem[place] == FOUND:
        if stage == ALL_STAGES or stage == ROWS_STAGE:
            pushing = pushing_contacts(contacts, world)
            make_room(space, steps, place, pushing)
            find_axes(model, state, scratch, space, steps, place, world)
            add_fluid_changes(model, state, space, steps, place, world)
            add_all_adhesion(model, settings, state, scratch, shapes, contacts, space, steps, place, world)
            if space.law == COMPLIANT_LAW:
                note_open_contacts(model, settings, shapes, contacts, space, steps, place, world)
            if pushing > 0 and space.law != SWEPT_LAW:
                add_converged_contacts(model, settings, state, shapes, contacts, space, steps, place, world)
            elif pushing > 0:
                add_contacts(model, settings, state, shapes, contacts, pair_rows, space, steps, place, world)
            add_users(model, settings, state, scratch, users, space, steps, place, world)
            find_impulses(space, steps, place)
            add_joint_rows(model, settings, state, scratch, space, steps, place, world)
        if stage == ALL_STAGES or stage == EQUATIONS_STAGE:
            find_changes(settings, space, steps, place)
            if steps.row_count[place] > 0:
                if write_equations(space, steps, place) == 0:
                    if steps.problem[place] == FOUND:
                        steps.problem[place] = REDUNDANT
        if stage != ROWS_STAGE and steps.problem[place] == FOUND:
            write_step(model, settings, state, space, steps, place, world)
            write_activations(model, settings, state, scratch, space, steps, place, world)
