"""The wrenches that joints transmit to their links, for sensors of forces and torques at sites.

They are those of `kernels.dynamics.feedback` without Bullet's errors. Where nobody asks for Bullet's, they
are found once, for the last substep of a step: the forces of joints' rows are internal to a tree, so what
they do to the links beyond a joint is in the accelerations, and only forces from outside the tree have to be
summed up. They are found when they are read (`kernels.sensors.last_loads`), from what a step keeps.
"""

import warp as wp

from carom.kernels.dynamics.dynamics import generalized_forces
from carom.kernels.dynamics.feedback import has_loads, resting_link_forces
from carom.kernels.dynamics.kinematics import has_late_links
from carom.kernels.dynamics.mass_matrix import solve
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import Int32, Vector3, Vector4, Vector6, func, real
from carom.layouts.codes import CONSTRAINT_FEEDBACK, LOADED


@func
def accelerate_dofs(model: Model, substep: real, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Leave in `dof_force` the accelerations of joints in the last substep, with those by constraints."""
    first = model.tree[tree].first_dof
    count = model.tree[tree].dof_count
    if scratch.tree[world, tree].is_pushed != 0:
        # Sums of the links' forces of free motion are needed afterwards.
        base = model.tree[tree].first_link
        for link in range(base, base + model.tree[tree].link_count):
            scratch.link[world, link].free_force = scratch.link[world, link].force
            scratch.link[world, link].free_moment = scratch.link[world, link].moment
        resting_link_forces(model, scratch, world, tree)
        generalized_forces(model, state, scratch, world, tree, CONSTRAINT_FEEDBACK)
        for link in range(base, base + model.tree[tree].link_count):
            scratch.link[world, link].force += scratch.link[world, link].free_force
            scratch.link[world, link].moment += scratch.link[world, link].free_moment
    else:
        dof = first + 0
        while dof < first + count:
            scratch.dof[world, dof].force = real(0.0)
            dof += 1
    per_time = 1.0 / substep
    dof = first + 0
    while dof < first + count:
        own = state.dof_joint_impulse[world, dof] * per_time + scratch.dof[world, dof].coupling
        scratch.dof[world, dof].force += own
        dof += 1
    solve(model, scratch, world, tree)
    dof = first + 0
    while dof < first + count:
        scratch.dof[world, dof].force += scratch.dof[world, dof].free_acceleration
        dof += 1


@func
def inertial_forces(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Fill in the force and moment that each link needs for the accelerations of joints in `dof_force`."""
    base = model.tree[tree].first_link
    alpha, acceleration = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    for link in range(base, base + model.tree[tree].link_count):
        parent = model.link[link].parent
        # The parent of most links is the link before, whose motion is still in the variables.
        if link > base and parent != link - 1:
            alpha = scratch.link[world, parent].alpha
            acceleration = scratch.link[world, parent].acceleration
        first = model.link[link].first_dof
        dof = first + 0
        while dof < first + model.link[link].dof_count:
            rate = scratch.dof[world, dof].force
            alpha += scratch.dof[world, dof].angular * rate
            acceleration += scratch.dof[world, dof].linear * rate
            dof += 1
        scratch.link[world, link].alpha = alpha
        scratch.link[world, link].acceleration = acceleration
        c = scratch.link[world, link].offset
        force = model.link_mass[world, link] * (acceleration + wp.cross(alpha, c))
        scratch.link[world, link].inertial_force = force
        moment = scratch.link[world, link].com_inertia * alpha + wp.cross(c, force)
        scratch.link[world, link].inertial_moment = moment


@func
def store_load(
    model: Model,
    state: State,
    scratch: Scratch,
    per_time: real,
    world: Int32,
    link: Int32,
    force: Vector3,
    moment: Vector3,
):
    """Store the wrench of a joint by the sum of what its links need, less what acts along its axes.

    `per_time` is 1 by the length of a substep.
    """
    torque = moment - wp.cross(scratch.link[world, link].offset, force)
    first = model.link[link].first_dof
    dof = first + 0
    while dof < first + model.link[link].dof_count:
        own = state.dof_joint_impulse[world, dof] * per_time + scratch.dof[world, dof].coupling
        angular = scratch.dof[world, dof].angular
        if wp.dot(angular, angular) > 0.0:
            torque -= angular * own
        else:
            force -= scratch.dof[world, dof].linear * own
        dof += 1
    to_link = wp.transpose(scratch.link[world, link].rotation)
    force, torque = to_link * force, to_link * torque
    load = Vector6(force[0], force[1], force[2], torque[0], torque[1], torque[2])
    state.link_load[world, link] = load


@func
def measure_loads(model: Model, substep: real, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Store the wrenches of joints with sensors in the last substep in `State.link_load`.

    `substep` is its length. Expects the link forces of free motion summed up by `generalized_forces`, its
    accelerations, and the constraint forces on links. What rows and couplings of the joint itself exert along
    its axes is left out.
    """
    accelerate_dofs(model, substep, state, scratch, world, tree)
    inertial_forces(model, scratch, world, tree)
    base = model.tree[tree].first_link
    count = model.tree[tree].link_count
    for i in range(count - 1):
        link = base + count - 1 - i
        force = scratch.link[world, link].inertial_force
        moment = scratch.link[world, link].inertial_moment
        parent = model.link[link].parent
        scratch.link[world, parent].inertial_force += force
        scratch.link[world, parent].inertial_moment += moment
        if (model.link[link].sensor & LOADED) != 0:
            force += scratch.link[world, link].force
            moment += scratch.link[world, link].moment
            store_load(model, state, scratch, 1.0 / substep, world, link, force, moment)


@func
def keep_loads(model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """At the end of a step: keep what `settle_loads` finds the loads of a tree from.

    These are the forces from outside the tree, and for each joint its acceleration without constraints and
    the force of couplings; followed trees keep the motion before the step as well. The next step usually
    throws all this away. Of several substeps the last one counts, and the motion before that is not kept,
    nor are the velocities that links with late ones had: then loads are measured now.
    """
    state.tree_load_step[world, tree] = Vector4(0.0, 0.0, 0.0, 0.0)
    if not has_loads(model, tree):
        return
    is_kept = settings.duration == settings.time_step and model.tree[tree].is_followed != 0
    if not is_kept or has_late_links(model, tree):
        measure_loads(model, settings.time_step, state, scratch, world, tree)
        return
    gravity = model.gravity_vector[world, 0]
    state.tree_load_step[world, tree] = Vector4(gravity[0], gravity[1], gravity[2], settings.time_step)
    dof = model.tree[tree].first_dof + 0
    while dof < model.tree[tree].first_dof + model.tree[tree].dof_count:
        state.dof_acceleration[world, dof] = scratch.dof[world, dof].free_acceleration
        state.dof_coupling[world, dof] = scratch.dof[world, dof].coupling
        dof += 1
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        state.link_applied[world, link] = state.link_wrench[world, link]
    state.tree_is_pushed[world, tree] = scratch.tree[world, tree].is_pushed
    if scratch.tree[world, tree].is_pushed != 0:
        for link in range(base, base + model.tree[tree].link_count):
            force = scratch.link[world, link].constraint_force
            torque = scratch.link[world, link].constraint_torque
            push = Vector6(force[0], force[1], force[2], torque[0], torque[1], torque[2])
            state.link_push[world, link] = push
