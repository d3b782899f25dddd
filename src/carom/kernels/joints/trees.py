"""Joints of the trees that are stepped: `LinkModel` and `State`.

`unit_axis` is along the joint's axis, in the inertial frame of its link; `axis` is that times the velocity of
the link per unit of its rate. `com_from_pivot` goes from the joint to the centre of mass.
"""

import warp as wp

from carom.kernels.joints.coordinates import load_quaternion, store_quaternion, three_numbers
from carom.kernels.maths.rotation import axis_rotation, rotation_step, rotation_vector
from carom.kernels.structs import Model, Scratch, State
from carom.kernels.types import Int32, Matrix3, Quaternion, Vector3, func, real
from carom.layouts.codes import PLANAR, PRISMATIC, REVOLUTE, SCREW, SPHERICAL


@func
def has_quaternion(model: Model, link: Int32) -> bool:
    """Whether the position of a joint is a quaternion, and its velocity angular, in the axes of its link."""
    return model.link[link].joint_type == SPHERICAL


@func
def joint_pose(
    model: Model, state: State, world: Int32, link: Int32, orientation: Quaternion, pivot: Vector3
):
    """The pose of a link from its joint's position.

    `orientation` is the parent's, `pivot` where the joint is at position 0, both in the world.

    Returns:
        Rotation to the parent's inertial frame; translation along axes of the link; the pivot.
    """
    turn = model.link[link].joint_rotation
    slide = Vector3(0.0, 0.0, 0.0)
    joint_type = model.link[link].joint_type
    q = model.link[link].first_position
    if joint_type == REVOLUTE:
        turn = turn * axis_rotation(model.link[link].unit_axis, state.position[world, q])
    elif joint_type == PRISMATIC:
        slide = model.link[link].axis * state.position[world, q]
    elif joint_type == SPHERICAL:
        turn = turn * load_quaternion(state, world, q)
    elif joint_type == PLANAR:
        # The translations are measured along axes that do not turn with the joint.
        pivot += wp.quat_rotate(
            orientation * turn,
            model.link[link].planar_axis1 * state.position[world, q + 1]
            + model.link[link].planar_axis2 * state.position[world, q + 2],
        )
        turn = turn * axis_rotation(model.link[link].unit_axis, state.position[world, q])
    elif joint_type == SCREW:
        turn = turn * axis_rotation(model.link[link].unit_axis, state.position[world, q])
        slide = model.link[link].planar_axis1 * state.position[world, q]
    return turn, slide, pivot


@func
def joint_subspace(
    model: Model, scratch: Scratch, world: Int32, link: Int32, rotation: Matrix3, offset: Vector3
):
    """Write the motion subspace of a joint: velocities of its link per unit rate, at the reference point.

    `rotation` is that of the link, `offset` its centre of mass from the reference point, in the world.
    """
    zero = Vector3(0.0, 0.0, 0.0)
    joint_type = model.link[link].joint_type
    dof = model.link[link].first_dof
    if joint_type == REVOLUTE:
        axis_world = rotation * model.link[link].axis
        pivot = offset - rotation * model.link[link].com_from_pivot
        scratch.dof[world, dof].angular = axis_world
        scratch.dof[world, dof].linear = wp.cross(pivot, axis_world)
    elif joint_type == PRISMATIC:
        scratch.dof[world, dof].angular = zero
        scratch.dof[world, dof].linear = rotation * model.link[link].axis
    elif joint_type == SPHERICAL:
        pivot = offset - rotation * model.link[link].com_from_pivot
        for axis in range(3):
            column = Vector3(rotation[0, axis], rotation[1, axis], rotation[2, axis])
            scratch.dof[world, dof + axis].angular = column
            scratch.dof[world, dof + axis].linear = wp.cross(pivot, column)
    elif joint_type == PLANAR:
        axis_world = rotation * model.link[link].axis
        scratch.dof[world, dof].angular = axis_world
        scratch.dof[world, dof].linear = wp.cross(offset, axis_world)
        scratch.dof[world, dof + 1].angular = zero
        scratch.dof[world, dof + 1].linear = rotation * model.link[link].planar_axis1
        scratch.dof[world, dof + 2].angular = zero
        scratch.dof[world, dof + 2].linear = rotation * model.link[link].planar_axis2
    elif joint_type == SCREW:
        axis_world = rotation * model.link[link].axis
        pivot = offset - rotation * model.link[link].com_from_pivot
        scratch.dof[world, dof].angular = axis_world
        scratch.dof[world, dof].linear = (
            wp.cross(pivot, axis_world) + rotation * model.link[link].planar_axis1
        )


@func
def integrate_joint(model: Model, state: State, world: Int32, link: Int32, dt: real):
    """Integrate the coordinates of a joint over `dt`.

    Angular velocities of a spherical joint are in the axes of its link; the translational rates of a planar
    joint are along axes of its link.
    """
    joint_type = model.link[link].joint_type
    q = model.link[link].first_position
    dof = model.link[link].first_dof
    if joint_type == REVOLUTE or joint_type == PRISMATIC or joint_type == SCREW:
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


@func
def spring_stretch(model: Model, state: State, world: Int32, link: Int32) -> Vector3:
    """By how much the spring of a joint is stretched, along each of its dofs [rad or m]."""
    q = model.link[link].first_position
    joint_type = model.link[link].joint_type
    if joint_type == SPHERICAL:
        rest = Quaternion(
            model.position_spring[world, q],
            model.position_spring[world, q + 1],
            model.position_spring[world, q + 2],
            model.position_spring[world, q + 3],
        )
        return rotation_vector(wp.quat_inverse(rest) * load_quaternion(state, world, q))
    first = state.position[world, q] - model.position_spring[world, q]
    if joint_type != PLANAR:
        return Vector3(first, 0.0, 0.0)
    # The rates of a planar joint are along axes of its link, which its angle turns.
    angle = state.position[world, q]
    x = state.position[world, q + 1] - model.position_spring[world, q + 1]
    y = state.position[world, q + 2] - model.position_spring[world, q + 2]
    cosine, sine = wp.cos(angle), wp.sin(angle)
    return Vector3(first, cosine * x - sine * y, sine * x + cosine * y)


@func
def with_joint_load(
    model: Model, state: State, substep: real, world: Int32, link: Int32, force: Vector3, torque: Vector3
):
    """Add to force and torque on a link what motors, limits and actuators of its joint exert along its axes.

    All are those of the last substep, in the axes of the link's inertial frame.
    """
    joint_type = model.link[link].joint_type
    axis = model.link[link].axis
    dof = model.link[link].first_dof
    if joint_type == REVOLUTE or joint_type == SCREW:
        # What drives a screw turns it; that its thread pushes the link along is in the load already.
        torque += axis * (state.dof_joint_impulse[world, dof] / substep)
    elif joint_type == PRISMATIC:
        force += axis * (state.dof_joint_impulse[world, dof] / substep)
    elif joint_type == SPHERICAL:
        for k in range(3):
            torque[k] += state.dof_joint_impulse[world, dof + k] / substep
    elif joint_type == PLANAR:
        torque += axis * (state.dof_joint_impulse[world, dof] / substep)
        force += model.link[link].planar_axis1 * (state.dof_joint_impulse[world, dof + 1] / substep)
        force += model.link[link].planar_axis2 * (state.dof_joint_impulse[world, dof + 2] / substep)
    return force, torque
