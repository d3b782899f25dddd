"""Integration of positions, with the velocities at the end of the step (semi-implicit Euler)."""

import warp as wp

from carom.kernels.dynamics.kinematics import base_omega, base_velocity, load_quaternion, three_numbers
from carom.kernels.maths.rotation import axis_rotation, rotation_step
from carom.kernels.structs import Model, State
from carom.kernels.types import Int32, Quaternion, func, real
from carom.layouts.codes import PLANAR, PRISMATIC, REVOLUTE, SPHERICAL


@func
def store_quaternion(state: State, world: Int32, q: Int32, value: Quaternion):
    """Store `value`, normalised, from coordinate `q` on."""
    unit = wp.normalize(value)
    for i in range(4):
        state.position[world, q + i] = unit[i]


@func
def integrate_positions(model: Model, state: State, world: Int32, tree: Int32, dt: real):
    """Integrate the coordinates of a tree over `dt`.

    Angular velocities of the base are in world axes, those of a spherical joint in the axes of its link; the
    translational rates of a planar joint are along axes of its link.
    """
    base = model.tree[tree].first_link
    q = model.tree[tree].first_position
    velocity = base_velocity(model, state, world, tree)
    omega = base_omega(model, state, world, tree)
    if wp.dot(velocity, velocity) + wp.dot(omega, omega) != 0.0:
        for axis in range(3):
            state.position[world, q + axis] += dt * velocity[axis]
        turn = rotation_step(omega, dt)
        store_quaternion(state, world, q + 3, turn * load_quaternion(state, world, q + 3))

    for link in range(base + 1, base + model.tree[tree].link_count):
        joint_type = model.link[link].joint_type
        q = model.link[link].first_position
        dof = model.link[link].first_dof
        if joint_type == REVOLUTE or joint_type == PRISMATIC:
            state.position[world, q] += dt * state.dof_velocity[world, dof]
        elif joint_type == SPHERICAL:
            rate = three_numbers(state.dof_velocity, world, dof)
            current = load_quaternion(state, world, q)
            store_quaternion(state, world, q, rotation_step(wp.quat_rotate(current, rate), dt) * current)
        elif joint_type == PLANAR:
            angle = state.position[world, q] + dt * state.dof_velocity[world, dof]
            state.position[world, q] = angle
            axis1 = model.link[link].planar_axis1
            axis2 = model.link[link].planar_axis2
            slide = wp.quat_rotate(
                axis_rotation(model.link[link].unit_axis, angle),
                axis1 * state.dof_velocity[world, dof + 1] + axis2 * state.dof_velocity[world, dof + 2],
            )
            state.position[world, q + 1] += dt * wp.dot(axis1, slide)
            state.position[world, q + 2] += dt * wp.dot(axis2, slide)
