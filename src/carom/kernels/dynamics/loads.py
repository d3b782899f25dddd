"""The wrenches that joints transmit to their links, for sensors of forces and torques at sites.

They are those of `kernels.dynamics.feedback` without Bullet's errors. Where nobody asks for Bullet's, one
pass after the solver is enough: accelerations of free motion and by constraint forces are added first.
"""

import warp as wp

from carom.kernels.dynamics.dynamics import generalized_forces
from carom.kernels.dynamics.feedback import resting_link_forces
from carom.kernels.dynamics.mass_matrix import solve
from carom.kernels.structs import Model, Scratch, State
from carom.kernels.types import Int32, Vector3, Vector6, func
from carom.layouts.codes import CONSTRAINT_FEEDBACK


@func
def accelerate_links(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Fill in the accelerations of links by those of joints: of free motion, and those in `dof_force`."""
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
            rate = scratch.dof[world, dof].free_acceleration + scratch.dof[world, dof].force
            alpha += scratch.dof[world, dof].angular * rate
            acceleration += scratch.dof[world, dof].linear * rate
            dof += 1
        scratch.link[world, link].alpha = alpha
        scratch.link[world, link].acceleration = acceleration
        scratch.link[world, link].inertial_force = Vector3(0.0, 0.0, 0.0)
        scratch.link[world, link].inertial_moment = Vector3(0.0, 0.0, 0.0)


@func
def measure_loads(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Store the wrenches of joints with sensors in `State.link_load`.

    Expects the link forces of free motion summed up by `generalized_forces`, its accelerations, and the
    constraint forces on links.
    """
    base = model.tree[tree].first_link
    count = model.tree[tree].link_count
    for link in range(base, base + count):
        scratch.link[world, link].free_force = scratch.link[world, link].force
        scratch.link[world, link].free_moment = scratch.link[world, link].moment
    resting_link_forces(model, scratch, world, tree)
    generalized_forces(model, state, scratch, world, tree, CONSTRAINT_FEEDBACK)
    solve(model, scratch, world, tree)
    accelerate_links(model, scratch, world, tree)
    for i in range(count - 1):
        link = base + count - 1 - i
        mass = model.link_mass[world, link]
        c = scratch.link[world, link].offset
        alpha = scratch.link[world, link].alpha
        acceleration = scratch.link[world, link].acceleration + wp.cross(alpha, c)
        force = mass * acceleration
        moment = scratch.link[world, link].com_inertia * alpha + wp.cross(c, force)
        force += scratch.link[world, link].inertial_force
        moment += scratch.link[world, link].inertial_moment
        parent = model.link[link].parent
        scratch.link[world, parent].inertial_force += force
        scratch.link[world, parent].inertial_moment += moment
        if model.link[link].sensor != 0:
            force += scratch.link[world, link].free_force + scratch.link[world, link].force
            moment += scratch.link[world, link].free_moment + scratch.link[world, link].moment
            torque = moment - wp.cross(c, force)
            to_link = wp.transpose(scratch.link[world, link].rotation)
            force, torque = to_link * force, to_link * torque
            load = Vector6(force[0], force[1], force[2], torque[0], torque[1], torque[2])
            state.link_load[world, link] = load
