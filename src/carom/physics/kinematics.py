"""Where the links are, how the joints can move them, and how fast they go."""

import warp as wp

from carom.model.codes import PLANAR, PRISMATIC, REVOLUTE, SPHERICAL
from carom.model.real import Int32, Quaternion, Transform, TransformRows, Vector3, Vector6, func, kernel
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.rotation import axis_rotation, canonical, rotation_matrix


@func
def forward_kinematics(model: Model, state: State, poses: TransformRows, world: Int32, tree: Int32):
    """Fill `poses` with the world poses of a tree's inertial frames, from its coordinates."""
    base = model.tree_first_link[tree]
    q = model.tree_first_position[tree]
    position = Vector3(state.position[world, q], state.position[world, q + 1], state.position[world, q + 2])
    orientation = Quaternion(
        state.position[world, q + 3],
        state.position[world, q + 4],
        state.position[world, q + 5],
        state.position[world, q + 6],
    )
    poses[world, base] = Transform(position, canonical(orientation))

    for link in range(base + 1, base + model.tree_link_count[tree]):
        parent_pose = poses[world, model.link_parent[link]]
        parent_orientation = wp.transform_get_rotation(parent_pose)
        pivot = wp.transform_get_translation(parent_pose) + wp.quat_rotate(
            parent_orientation, model.link_pivot_in_parent[link]
        )
        child_orientation = parent_orientation * model.link_joint_rotation[link]
        slide = Vector3(0.0, 0.0, 0.0)

        joint_type = model.link_joint_type[link]
        q = model.link_first_position[link]
        if joint_type == REVOLUTE:
            child_orientation = child_orientation * axis_rotation(
                model.link_unit_axis[link], state.position[world, q]
            )
        elif joint_type == PRISMATIC:
            slide = model.link_axis[link] * state.position[world, q]
        elif joint_type == SPHERICAL:
            child_orientation = child_orientation * Quaternion(
                state.position[world, q],
                state.position[world, q + 1],
                state.position[world, q + 2],
                state.position[world, q + 3],
            )
        elif joint_type == PLANAR:
            # The translations are measured along axes that do not turn with the joint.
            pivot += wp.quat_rotate(
                child_orientation,
                model.link_planar_axis1[link] * state.position[world, q + 1]
                + model.link_planar_axis2[link] * state.position[world, q + 2],
            )
            child_orientation = child_orientation * axis_rotation(
                model.link_unit_axis[link], state.position[world, q]
            )

        child_orientation = canonical(child_orientation)
        offset = wp.quat_rotate(child_orientation, model.link_com_from_pivot[link] + slide)
        poses[world, link] = Transform(pivot + offset, child_orientation)


@func
def motion_subspaces(model: Model, poses: TransformRows, scratch: Scratch, world: Int32, tree: Int32):
    """What one unit of each active dof does to its link: angular and linear velocity.

    Linear velocities are those at the tree's reference point, the centre of mass of its base.
    """
    base = model.tree_first_link[tree]
    reference = wp.transform_get_translation(poses[world, base])
    zero = Vector3(0.0, 0.0, 0.0)

    if model.tree_fixed[tree] == 0:
        first = model.tree_first_velocity[tree]
        for axis in range(3):
            unit = Vector3(0.0, 0.0, 0.0)
            unit[axis] = 1.0
            scratch.dof_angular[world, first + axis] = unit
            scratch.dof_linear[world, first + axis] = zero
            scratch.dof_angular[world, first + 3 + axis] = zero
            scratch.dof_linear[world, first + 3 + axis] = unit

    for link in range(base, base + model.tree_link_count[tree]):
        pose = poses[world, link]
        rotation = rotation_matrix(wp.transform_get_rotation(pose))
        offset = wp.transform_get_translation(pose) - reference
        scratch.link_rotation[world, link] = rotation
        scratch.link_offset[world, link] = offset

        joint_type = model.link_joint_type[link]
        dof = model.link_first_dof[link]
        if joint_type == REVOLUTE:
            axis_world = rotation * model.link_axis[link]
            pivot = offset - rotation * model.link_com_from_pivot[link]
            scratch.dof_angular[world, dof] = axis_world
            scratch.dof_linear[world, dof] = wp.cross(pivot, axis_world)
        elif joint_type == PRISMATIC:
            scratch.dof_angular[world, dof] = zero
            scratch.dof_linear[world, dof] = rotation * model.link_axis[link]
        elif joint_type == SPHERICAL:
            pivot = offset - rotation * model.link_com_from_pivot[link]
            for axis in range(3):
                column = Vector3(rotation[0, axis], rotation[1, axis], rotation[2, axis])
                scratch.dof_angular[world, dof + axis] = column
                scratch.dof_linear[world, dof + axis] = wp.cross(pivot, column)
        elif joint_type == PLANAR:
            axis_world = rotation * model.link_axis[link]
            scratch.dof_angular[world, dof] = axis_world
            scratch.dof_linear[world, dof] = wp.cross(offset, axis_world)
            scratch.dof_angular[world, dof + 1] = zero
            scratch.dof_linear[world, dof + 1] = rotation * model.link_planar_axis1[link]
            scratch.dof_angular[world, dof + 2] = zero
            scratch.dof_linear[world, dof + 2] = rotation * model.link_planar_axis2[link]


@func
def base_omega(model: Model, state: State, world: Int32, tree: Int32) -> Vector3:
    """Angular velocity of a tree's base [rad/s]."""
    v = model.tree_first_velocity[tree]
    return Vector3(
        state.dof_velocity[world, v], state.dof_velocity[world, v + 1], state.dof_velocity[world, v + 2]
    )


@func
def base_velocity(model: Model, state: State, world: Int32, tree: Int32) -> Vector3:
    """Velocity of the centre of mass of a tree's base [m/s]."""
    v = model.tree_first_velocity[tree] + 3
    return Vector3(
        state.dof_velocity[world, v], state.dof_velocity[world, v + 1], state.dof_velocity[world, v + 2]
    )


@func
def link_velocities(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Velocities of all links of a tree about its reference point, from the joint rates."""
    base = model.tree_first_link[tree]
    scratch.link_omega[world, base] = base_omega(model, state, world, tree)
    scratch.link_velocity[world, base] = base_velocity(model, state, world, tree)
    for link in range(base + 1, base + model.tree_link_count[tree]):
        parent = model.link_parent[link]
        omega = scratch.link_omega[world, parent]
        velocity = scratch.link_velocity[world, parent]
        first = model.link_first_dof[link]
        for dof in range(first, first + model.link_dof_count[link]):
            rate = state.dof_velocity[world, dof]
            omega += scratch.dof_angular[world, dof] * rate
            velocity += scratch.dof_linear[world, dof] * rate
        scratch.link_omega[world, link] = omega
        scratch.link_velocity[world, link] = velocity


@kernel
def forward_kinematics_kernel(model: Model, state: State, tree: Int32):
    """Bring the link poses of one tree up to date with its coordinates."""
    forward_kinematics(model, state, state.link_pose, wp.tid(), tree)


@kernel
def link_poses_kernel(settings: Settings, model: Model, state: State):
    """Bring the link poses of all trees up to date with their coordinates."""
    world = wp.tid()
    for tree in range(settings.tree_count):
        forward_kinematics(model, state, state.link_pose, world, tree)


@kernel
def link_twist_kernel(model: Model, state: State, scratch: Scratch, tree: Int32):
    """Velocities of the links of one tree, in world axes, for its present coordinates.

    As in Bullet they are turned to world axes by `State.link_pose`, which after a step is that of
    the start of its last substep.
    """
    world = wp.tid()
    forward_kinematics(model, state, scratch.link_pose, world, tree)
    motion_subspaces(model, scratch.link_pose, scratch, world, tree)
    link_velocities(model, state, scratch, world, tree)
    base = model.tree_first_link[tree]
    for link in range(base, base + model.tree_link_count[tree]):
        now = wp.transform_get_rotation(scratch.link_pose[world, link])
        reported = wp.transform_get_rotation(state.link_pose[world, link])
        omega = scratch.link_omega[world, link]
        velocity = scratch.link_velocity[world, link] + wp.cross(omega, scratch.link_offset[world, link])
        velocity = wp.quat_rotate(reported, wp.quat_rotate_inv(now, velocity))
        omega = wp.quat_rotate(reported, wp.quat_rotate_inv(now, omega))
        state.link_twist[world, link] = Vector6(
            velocity[0], velocity[1], velocity[2], omega[0], omega[1], omega[2]
        )
