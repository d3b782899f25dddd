"""Force-torque sensors: the wrench that a joint carries from its parent to its link.

As in Bullet it is measured in two passes: the wrench of the unconstrained motion, plus that of a
second motion which only the constraint forces drive.
"""

import warp as wp

from carom.model.codes import CONSTRAINT_FEEDBACK, ROW_IMPULSE
from carom.model.real import Int32, Vector3, Vector6, func
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.dynamics import generalized_forces, link_bias_forces, parallel_axis
from carom.physics.mass_matrix import solve
from carom.physics.rows import row_dof


@func
def clear_constraint_forces(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Forget the constraint forces of the last substep."""
    base = model.tree_first_link[tree]
    for link in range(base, base + model.tree_link_count[tree]):
        scratch.link_constraint_force[world, link] = Vector3(0.0, 0.0, 0.0)
        scratch.link_constraint_torque[world, link] = Vector3(0.0, 0.0, 0.0)


@func
def gather_constraint_forces(
    model: Model, settings: Settings, scratch: Scratch, world: Int32, first: Int32, last: Int32
):
    """Turn the impulses of rows [first, last) into forces on the joint's link and on its parent."""
    for row in range(first, last):
        constraint = scratch.row_constraint[world, row]
        if model.tree_sensor_count[model.constraint_tree[constraint]] > 0:
            link = model.constraint_link[constraint]
            parent = model.link_parent[link]
            dof = row_dof(model, scratch, world, row)
            size = scratch.row_terms[world, row][ROW_IMPULSE] / settings.time_step
            angular = scratch.dof_angular[world, dof]
            if wp.dot(angular, angular) > 0.0:
                scratch.link_constraint_torque[world, link] += angular * size
                scratch.link_constraint_torque[world, parent] -= angular * size
            else:
                linear = scratch.dof_linear[world, dof]
                scratch.link_constraint_force[world, link] += linear * size
                scratch.link_constraint_force[world, parent] -= linear * size


@func
def measure_joint_wrenches(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32, add: Int32
):
    """Store in (or add to) the sensors what their joints carry.

    Expects the accelerations in `dof_force` and the gathered bias forces of `generalized_forces`.
    """
    base = model.tree_first_link[tree]
    count = model.tree_link_count[tree]
    zero = Vector3(0.0, 0.0, 0.0)

    # What the joint accelerations add to the accelerations of the links.
    for link in range(base, base + count):
        alpha = zero
        acceleration = zero
        if link > base:
            alpha = scratch.link_alpha[world, model.link_parent[link]]
            acceleration = scratch.link_acceleration[world, model.link_parent[link]]
        first = model.link_first_dof[link]
        for dof in range(first, first + model.link_dof_count[link]):
            rate = scratch.dof_force[world, dof]
            alpha += scratch.dof_angular[world, dof] * rate
            acceleration += scratch.dof_linear[world, dof] * rate
        scratch.link_alpha[world, link] = alpha
        scratch.link_acceleration[world, link] = acceleration

    # The force for that, gathered towards the root on top of the bias forces.
    for link in range(base, base + count):
        mass = model.link_mass[link]
        c = scratch.link_offset[world, link]
        alpha = scratch.link_alpha[world, link]
        acceleration = scratch.link_acceleration[world, link]
        inertia = scratch.link_com_inertia[world, link] + mass * parallel_axis(c)
        force = mass * (acceleration + wp.cross(alpha, c))
        moment = inertia * alpha + mass * wp.cross(c, acceleration)
        up = link
        while up >= 0:
            scratch.link_force[world, up] += force
            scratch.link_moment[world, up] += moment
            up = model.link_parent[up]

    for link in range(base + 1, base + count):
        if model.link_sensor[link] != 0:
            force = scratch.link_force[world, link]
            torque = scratch.link_moment[world, link] - wp.cross(scratch.link_offset[world, link], force)
            to_link = wp.transpose(scratch.link_rotation[world, link])
            force = to_link * force
            torque = to_link * torque
            if settings.feedback_in_joint != 0:
                torque -= wp.cross(force, model.link_com_from_pivot[link])
            if settings.feedback_in_world != 0:
                force = scratch.link_rotation[world, link] * force
                torque = scratch.link_rotation[world, link] * torque
            wrench = Vector6(force[0], force[1], force[2], torque[0], torque[1], torque[2])
            if add != 0:
                wrench += state.link_reaction[world, link]
            state.link_reaction[world, link] = wrench


@func
def constraint_feedback(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32
):
    """Second pass: add to the sensors what the constraint forces do."""
    link_bias_forces(model, settings, state, scratch, world, tree, CONSTRAINT_FEEDBACK)
    generalized_forces(model, state, scratch, world, tree, CONSTRAINT_FEEDBACK)
    solve(model, scratch, world, tree)
    measure_joint_wrenches(model, settings, state, scratch, world, tree, 1)
