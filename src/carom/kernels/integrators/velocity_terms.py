"""How the forces of a tree change with its velocities: damping, actuators, tendons, and what rotations do.

Terms are added to a matrix over the dofs of the tree, of rows of ceil(n/4) blocks, in all entries (i, j).
"""

import warp as wp

from carom.kernels.dynamics.actuators import actuator_law, within_own_range
from carom.kernels.dynamics.dynamics import generalized_forces, link_bias_forces
from carom.kernels.dynamics.kinematics import base_omega
from carom.kernels.integrators.frames import arm_of_base
from carom.kernels.structs import Model, PairRows, Scratch, Settings, State, UserConstraints
from carom.kernels.tendons.paths import add_path
from carom.kernels.tendons.rows import add_site_wrench, begin_row
from carom.kernels.types import Int32, Vector3, called_func, func, real
from carom.layouts.codes import ACTUATOR, FREE_MOTION, USER_TENDON, USER_TRANSMISSION

# Forces of actuators are polynomials of second order in velocity, if pieces: such a difference is exact.
_STEP = real(1e-3)


@func
def force_at(
    model: Model, settings: Settings, state: State, world: Int32, actuator: Int32, length: real, speed: real
) -> real:
    """Force of an actuator without bounds."""
    force, _stiffness, damping = actuator_law(
        model, state, world, actuator, length, speed, settings.time_step
    )
    return force - damping * speed


@func
def damping_of_actuator(
    model: Model, settings: Settings, state: State, world: Int32, actuator: Int32, length: real, speed: real
) -> real:
    """By how much the force of an actuator falls per unit of its velocity; 0 beyond its own range."""
    now = force_at(model, settings, state, world, actuator, length, speed)
    if within_own_range(model, world, actuator, now) != now:
        return real(0.0)
    faster = force_at(model, settings, state, world, actuator, length, speed + _STEP)
    slower = force_at(model, settings, state, world, actuator, length, speed - _STEP)
    return (slower - faster) / (2.0 * _STEP)


@func
def sum_is_at_bound(
    model: Model, settings: Settings, state: State, world: Int32, actuator: Int32, position: real, rate: real
) -> bool:
    """Whether the sum of the forces of all actuators of a joint or tendon is at a bound, or beyond it."""
    other = actuator - model.actuator[actuator].follows
    total = real(0.0)
    while other >= 0:
        gear = model.actuator_gear[world, other]
        force = force_at(model, settings, state, world, other, gear * position, gear * rate)
        total += gear * within_own_range(model, world, other, force)
        step = model.actuator[other].to_next + 0
        other = wp.where(step > 0, other + step, Int32(-1))
    return (
        total <= model.actuator_joint_lower[world, actuator]
        or total >= model.actuator_joint_upper[world, actuator]
    )


@func
def add_products(
    model: Model, scratch: Scratch, pair_rows: PairRows, world: Int32, tree: Int32, factor: real
):
    """Add `factor` Jᵀ J to the matrix, with the Jacobian in block 0 of the rows."""
    n = model.tree[tree].dof_count
    blocks = (n + 3) // 4
    matrix = model.tree[tree].first_block
    for i in range(n):
        of_row = factor * pair_rows.entry_row[world, i]
        if of_row != 0.0:
            for j in range(n):
                scratch.entry_inverse_mass[world, 4 * (matrix + i * blocks) + j] += (
                    of_row * pair_rows.entry_row[world, j]
                )


@func
def rate_of_row(model: Model, state: State, pair_rows: PairRows, world: Int32, tree: Int32) -> real:
    """The rate along the Jacobian in block 0 of the rows."""
    first = model.tree[tree].first_dof
    rate = real(0.0)
    for i in range(model.tree[tree].dof_count):
        rate += pair_rows.entry_row[world, i] * state.dof_velocity[world, first + i]
    return rate


@func
def add_user_terms(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
    of_armature: real,
    of_damping: real,
):
    """Add the armature of tendons, and the damping of tendons and of actuators of tendons and sites."""
    for user in range(settings.user_count):
        if users.user_tree_a[user] == tree and users.user_enabled[world, user] != 0:
            kind = users.user_kind[user]
            first, second = users.user_first_path[user], users.user_second_path[user]
            if kind == USER_TENDON:
                factor = of_armature * users.user_armature[user] + of_damping * users.user_spring[user][1]
                if factor != 0.0:
                    begin_row(model, pair_rows, world, Int32(0), tree, Int32(0))
                    add_path(
                        model, state, scratch, users, pair_rows, world, tree, first, second, real(1.0),
                        Int32(0),
                    )  # fmt: skip
                    add_products(model, scratch, pair_rows, world, tree, factor)
            elif kind == USER_TRANSMISSION and of_damping != 0.0:
                actuator = users.user_actuator[user]
                gear = model.actuator_gear[world, actuator]
                begin_row(model, pair_rows, world, Int32(0), tree, Int32(0))
                length = real(0.0)
                if users.user_is_wrench[user] != 0:
                    length = add_site_wrench(
                        model, state, scratch, users, pair_rows, world, user, gear, Int32(0)
                    )
                else:
                    length = gear * add_path(
                        model, state, scratch, users, pair_rows, world, tree, first, second, gear, Int32(0)
                    )
                speed = rate_of_row(model, state, pair_rows, world, tree)
                damping = damping_of_actuator(model, settings, state, world, actuator, length, speed)
                if users.user_is_wrench[user] == 0 and gear != 0.0:
                    if sum_is_at_bound(model, settings, state, world, actuator, length / gear, speed / gear):
                        damping = real(0.0)
                add_products(model, scratch, pair_rows, world, tree, of_damping * damping)


@func
def add_joint_dampings(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    tree: Int32,
    with_actuators: bool,
    factor: real,
):
    """Add damping of joints, and of actuators of joints, to the diagonal, times `factor`."""
    first = model.tree[tree].first_dof
    n = model.tree[tree].dof_count
    blocks = (n + 3) // 4
    matrix = model.tree[tree].first_block
    for i in range(n):
        scratch.entry_inverse_mass[world, 4 * (matrix + i * blocks) + i] += (
            factor * model.dof_implicit_damping[world, first + i]
        )
    if with_actuators and model.tree[tree].actuator_count > 0:
        for constraint in range(settings.constraint_count):
            if model.constraint[constraint].kind == ACTUATOR and model.constraint[constraint].tree == tree:
                actuator = model.constraint[constraint].actuator
                link = model.constraint[constraint].link
                dof = model.link[link].first_dof
                gear = model.actuator_gear[world, actuator]
                position = state.position[world, model.link[link].first_position] + 0.0
                rate = state.dof_velocity[world, dof] + 0.0
                damping = damping_of_actuator(
                    model, settings, state, world, actuator, gear * position, gear * rate
                )
                if sum_is_at_bound(model, settings, state, world, actuator, position, rate):
                    damping = real(0.0)
                place = dof - first
                scratch.entry_inverse_mass[world, 4 * (matrix + place * blocks) + place] += (
                    factor * gear * gear * damping
                )


@called_func
def add_rotation_terms(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32, factor: real):
    """Subtract `factor` times the derivative of τ − c by the velocities.

    Bias forces c are a quadratic function of these, so their differences are derivatives, but for rounding.
    """
    first = model.tree[tree].first_dof
    n = model.tree[tree].dof_count
    blocks = (n + 3) // 4
    matrix = model.tree[tree].first_block
    for j in range(n):
        velocity = state.dof_velocity[world, first + j] + 0.0
        size = real(0.01) * (real(1.0) + wp.abs(velocity))
        for side in range(2):
            sign = real(1.0)
            if side == 1:
                sign = real(-1.0)
            state.dof_velocity[world, first + j] = velocity + sign * size
            link_bias_forces(model, state, scratch, world, tree, FREE_MOTION)
            generalized_forces(model, state, scratch, world, tree, FREE_MOTION)
            for i in range(n):
                scratch.entry_inverse_mass[world, 4 * (matrix + i * blocks) + j] -= (
                    factor * sign * scratch.dof[world, first + i].force / (2.0 * size)
                )
        state.dof_velocity[world, first + j] = velocity


@called_func
def add_carried_terms(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32, factor: real):
    """Add `factor` times the derivative of M a by the velocities, of what turning carries a base along.

    The matrix is M still. See `frames`: a is ω x (ω x c) at the centre of mass of the base.
    """
    n = model.tree[tree].dof_count
    blocks = (n + 3) // 4
    matrix = model.tree[tree].first_block
    omega = base_omega(model, state, world, tree)
    arm = arm_of_base(model, state, world, tree)
    for axis in range(3):
        turned = Vector3(0.0, 0.0, 0.0)
        turned[axis] = 1.0
        change = wp.cross(turned, wp.cross(omega, arm)) + wp.cross(omega, wp.cross(turned, arm))
        for i in range(n):
            total = real(0.0)
            for other in range(3):
                place = 3 + other
                entry = scratch.entry_inverse_mass[world, 4 * (matrix + i * blocks) + place]
                total += entry * change[other]
            scratch.entry_inverse_mass[world, 4 * (matrix + i * blocks) + axis] += factor * total
