"""Forces on the links, and joint accelerations without constraints.

Recursive Newton-Euler with spatial vectors computes the generalized bias force; the composite rigid
body algorithm and the factorisation in `mass_matrix` give the accelerations for generalized forces.
Notation and method: R. Featherstone, Rigid Body Dynamics Algorithms (2008), chapters 5, 6 and 8.
"""

import warp as wp

from carom.kernels.dynamics.kinematics import base_omega, base_velocity
from carom.kernels.dynamics.quarantine import report_fault
from carom.kernels.maths.min_max import within_bounds
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import Int32, Matrix3, Vector3, func, real
from carom.layouts.codes import CONSTRAINT_FEEDBACK, FREE_MOTION, LAST_STEP


@func
def link_inertias(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Fill in the rotational inertia of each link in world axes, and start composite inertias with it."""
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        rotation = scratch.link[world, link].rotation
        about_com = turned_inertia(rotation, model.link_inertia[world, link])
        mass = model.link_mass[world, link]
        c = scratch.link[world, link].offset
        scratch.link[world, link].com_inertia = about_com
        scratch.link[world, link].composite_mass = mass
        scratch.link[world, link].composite_first = mass * c
        scratch.link[world, link].composite_inertia = about_com + mass * parallel_axis(c)


@func
def turned_inertia(r: Matrix3, moments: Vector3) -> Matrix3:
    """The inertia R diag(moments) Rᵀ."""
    ax, ay, az = r[0, 0] * moments[0], r[0, 1] * moments[1], r[0, 2] * moments[2]
    bx, by, bz = r[1, 0] * moments[0], r[1, 1] * moments[1], r[1, 2] * moments[2]
    cx, cy, cz = r[2, 0] * moments[0], r[2, 1] * moments[1], r[2, 2] * moments[2]
    xx = ax * r[0, 0] + ay * r[0, 1] + az * r[0, 2]
    xy = ax * r[1, 0] + ay * r[1, 1] + az * r[1, 2]
    xz = ax * r[2, 0] + ay * r[2, 1] + az * r[2, 2]
    yy = bx * r[1, 0] + by * r[1, 1] + bz * r[1, 2]
    yz = bx * r[2, 0] + by * r[2, 1] + bz * r[2, 2]
    zz = cx * r[2, 0] + cy * r[2, 1] + cz * r[2, 2]
    return Matrix3(xx, xy, xz, xy, yy, yz, xz, yz, zz)


@func
def parallel_axis(c: Vector3) -> Matrix3:
    """Rotational inertia of a unit point mass at `c`, about the origin."""
    xx, yy, zz = c[0] * c[0], c[1] * c[1], c[2] * c[2]
    xy, xz, yz = c[0] * c[1], c[0] * c[2], c[1] * c[2]
    return Matrix3(yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy)


@func
def damping_rate(coefficient: real, speed: real) -> real:
    """Decay rate of a damped velocity [1/s]: linear and quadratic damping, both by `coefficient`."""
    return coefficient + coefficient * speed


@func
def external_force(model: Model, state: State, mass: real, world: Int32, link: Int32) -> Vector3:
    """Gravity, less what is compensated, and the force applied by the user, at the centre of mass [N]."""
    wrench = state.link_wrench[world, link]
    pulled = mass - model.link_gravity_compensation[world, link] * mass
    return model.gravity_vector[world, 0] * pulled + Vector3(wrench[0], wrench[1], wrench[2])


@func
def external_torque(state: State, world: Int32, link: Int32) -> Vector3:
    """Torque applied by the user [N m]."""
    wrench = state.link_wrench[world, link]
    return Vector3(wrench[3], wrench[4], wrench[5])


@func
def write_link_force(
    model: Model,
    state: State,
    scratch: Scratch,
    world: Int32,
    tree: Int32,
    link: Int32,
    purpose: Int32,
    omega: Vector3,
    velocity: Vector3,
    alpha: Vector3,
    acceleration: Vector3,
    linear_damping: real,
    angular_damping: real,
):
    """Fill in the force that a link needs for its motion, see `link_bias_forces`."""
    mass = model.link_mass[world, link]
    c = scratch.link[world, link].offset
    about_com = scratch.link[world, link].com_inertia
    com_velocity = velocity + wp.cross(omega, c)
    spin = about_com * omega

    # Newton-Euler equations at the centre of mass.
    com_acceleration = acceleration + wp.cross(alpha, c) + wp.cross(omega, com_velocity)
    force = mass * com_acceleration
    torque = about_com * alpha + wp.cross(omega, spin)

    if linear_damping != 0.0:
        force += com_velocity * (mass * damping_rate(linear_damping, wp.length(com_velocity)))
    if angular_damping != 0.0:
        torque += spin * damping_rate(angular_damping, wp.length(omega))

    if purpose == LAST_STEP:
        gravity = state.tree_load_step[world, tree]
        pulled = mass - model.link_gravity_compensation[world, link] * mass
        wrench = state.link_wrench[world, link]
        force -= Vector3(gravity[0], gravity[1], gravity[2]) * pulled
        force -= Vector3(wrench[0], wrench[1], wrench[2])
        torque -= external_torque(state, world, link)
    elif purpose != CONSTRAINT_FEEDBACK:
        force -= external_force(model, state, mass, world, link)
        torque -= external_torque(state, world, link)
    else:
        force -= scratch.link[world, link].constraint_force
        torque -= scratch.link[world, link].constraint_torque
        if link > model.tree[tree].first_link:
            force -= mass * wp.cross(omega, com_velocity)

    scratch.link[world, link].force = force
    scratch.link[world, link].moment = torque + wp.cross(c, force)


@func
def link_bias_forces(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32, purpose: Int32):
    """Fill in the velocities and bias accelerations of the links, and the force each link needs for them.

    For the purpose `FREE_MOTION` that is the force for motion without joint acceleration, less gravity and
    applied forces, plus damping. `CONSTRAINT_FEEDBACK` is Bullet's second pass for force-torque
    sensors: with constraint forces in place of gravity and applied forces, and without the
    centripetal force of the links. `LAST_STEP` is free motion in a step that has been performed, with the
    gravity of that step.
    """
    base = model.tree[tree].first_link
    linear_damping = model.tree_linear_damping[world, tree]
    angular_damping = model.tree_angular_damping[world, tree]

    omega = base_omega(model, state, world, tree)
    velocity = base_velocity(model, state, world, tree)
    alpha, acceleration = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    if model.tree[tree].fixed == 0:
        # The base's velocity stays constant, so its spatial acceleration is -omega x velocity.
        acceleration = -wp.cross(omega, velocity)

    for link in range(base, base + model.tree[tree].link_count):
        if link > base:
            parent = model.link[link].parent
            # The parent of most links is the link before, whose motion is still in the variables.
            if parent != link - 1:
                omega = scratch.link[world, parent].omega
                velocity = scratch.link[world, parent].velocity
                alpha = scratch.link[world, parent].alpha
                acceleration = scratch.link[world, parent].acceleration
            joint_omega, joint_velocity = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
            first = model.link[link].first_dof
            dof = first + 0
            while dof < first + model.link[link].dof_count:
                rate = state.dof_velocity[world, dof]
                joint_omega += scratch.dof[world, dof].angular * rate
                joint_velocity += scratch.dof[world, dof].linear * rate
                dof += 1
            omega += joint_omega
            velocity += joint_velocity
            # The motion subspace moves with the link: spatial cross product of both velocities.
            alpha += wp.cross(omega, joint_omega)
            acceleration += wp.cross(omega, joint_velocity) + wp.cross(velocity, joint_omega)
        scratch.link[world, link].omega = omega
        scratch.link[world, link].velocity = velocity
        scratch.link[world, link].alpha = alpha
        scratch.link[world, link].acceleration = acceleration

        write_link_force(
            model, state, scratch, world, tree, link, purpose, omega, velocity, alpha, acceleration,
            linear_damping, angular_damping,
        )  # fmt: skip


@func
def generalized_forces(
    model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32, purpose: Int32
):
    """Sum up link forces towards the root; leaves in `dof_force` applied minus bias forces."""
    base = model.tree[tree].first_link
    count = model.tree[tree].link_count
    for i in range(count):
        link = base + count - 1 - i
        force = scratch.link[world, link].force
        moment = scratch.link[world, link].moment
        first = model.link[link].first_dof
        dof = first + 0
        while dof < first + model.link[link].dof_count:
            needed = wp.dot(scratch.dof[world, dof].angular, moment) + wp.dot(
                scratch.dof[world, dof].linear, force
            )
            applied = state.dof_torque[world, dof] if purpose == FREE_MOTION else 0.0
            scratch.dof[world, dof].force = applied - needed
            dof += 1
        if link > base:
            parent = model.link[link].parent
            scratch.link[world, parent].force += force
            scratch.link[world, parent].moment += moment


@func
def turn_base_velocity(
    model: Model, settings: Settings, state: State, bound: real, world: Int32, tree: Int32
):
    """Update the velocity that was set for a base without dofs: as in Bullet, it turns with the base.

    Bullet's spatial acceleration of such a base is 0, that of its centre of mass therefore ω x v.
    """
    omega = base_omega(model, state, world, tree)
    velocity = base_velocity(model, state, world, tree)
    velocity += settings.time_step * wp.cross(omega, velocity)
    first = model.tree[tree].first_velocity
    for axis in range(3):
        state.dof_velocity[world, first + axis] = within_bounds(omega[axis], -bound, bound)
        state.dof_velocity[world, first + 3 + axis] = within_bounds(velocity[axis], -bound, bound)


@func
def update_velocities(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32
):
    """Update velocities by the accelerations in `dof_force`, without constraints."""
    bound = model.tree_max_velocity[world, tree]
    if model.tree[tree].fixed == 1:
        turn_base_velocity(model, settings, state, bound, world, tree)
    first = model.tree[tree].first_dof
    total = real(0.0)
    for dof in range(first, first + model.tree[tree].dof_count):
        acceleration = scratch.dof[world, dof].force
        scratch.dof[world, dof].free_acceleration = acceleration
        velocity = state.dof_velocity[world, dof] + settings.time_step * acceleration
        state.dof_velocity[world, dof] = within_bounds(velocity, -bound, bound)
        total += velocity
    report_fault(state, world, tree, total)
