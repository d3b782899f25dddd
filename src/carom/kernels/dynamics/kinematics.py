"""Forward kinematics: poses and velocities of links, motion subspaces of joints."""

import warp as wp

from carom.kernels.joints.coordinates import load_quaternion, three_numbers
from carom.kernels.joints.trees import joint_pose, joint_subspace
from carom.kernels.maths.rotation import canonical, rotation_matrix
from carom.kernels.solver.activity import is_absent
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import (
    Int32,
    Transform,
    TransformRows,
    Vector3,
    Vector6,
    func,
    kernel,
)


@func
def forward_kinematics(model: Model, state: State, poses: TransformRows, world: Int32, tree: Int32):
    """Fill `poses` with the world poses of a tree's inertial frames, from its coordinates."""
    base = model.tree[tree].first_link
    q = model.tree[tree].first_position
    position = three_numbers(state.position, world, q)
    orientation = canonical(load_quaternion(state, world, q + 3))
    poses[world, base] = Transform(position, orientation)

    for link in range(base + 1, base + model.tree[tree].link_count):
        parent = model.link[link].parent
        # The parent of most links is the link before, whose pose is still in the variables.
        if parent != link - 1:
            position = wp.transform_get_translation(poses[world, parent])
            orientation = wp.transform_get_rotation(poses[world, parent])
        pivot = position + wp.quat_rotate(orientation, model.link[link].pivot_in_parent)
        # Most is computed in the parent's frame, without waiting for the parent's world pose.
        turn, slide, pivot = joint_pose(model, state, world, link, orientation, pivot)
        orientation = canonical(orientation * turn)
        position = pivot + wp.quat_rotate(orientation, model.link[link].com_from_pivot + slide)
        poses[world, link] = Transform(position, orientation)


@func
def base_subspace(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Motion subspaces of a free base: rotation about each world axis, then translation along each."""
    zero = Vector3(0.0, 0.0, 0.0)
    first = model.tree[tree].first_velocity
    for axis in range(3):
        unit = Vector3(0.0, 0.0, 0.0)
        unit[axis] = 1.0
        scratch.dof[world, first + axis].angular = unit
        scratch.dof[world, first + axis].linear = zero
        scratch.dof[world, first + 3 + axis].angular = zero
        scratch.dof[world, first + 3 + axis].linear = unit


@func
def motion_subspaces(model: Model, poses: TransformRows, scratch: Scratch, world: Int32, tree: Int32):
    """Motion subspace of each active dof: angular and linear velocity of its link per unit rate.

    Linear velocities are those at the tree's reference point, the centre of mass of its base. Rotation
    matrices and centres of mass of the links are filled in, too.
    """
    base = model.tree[tree].first_link
    reference = wp.transform_get_translation(poses[world, base])
    if model.tree[tree].fixed == 0:
        base_subspace(model, scratch, world, tree)

    for link in range(base, base + model.tree[tree].link_count):
        pose = poses[world, link]
        rotation = rotation_matrix(wp.transform_get_rotation(pose))
        offset = wp.transform_get_translation(pose) - reference
        scratch.link[world, link].rotation = rotation
        scratch.link[world, link].offset = offset
        joint_subspace(model, scratch, world, link, rotation, offset)


@func
def base_omega(model: Model, state: State, world: Int32, tree: Int32) -> Vector3:
    """Angular velocity of a tree's base [rad/s]."""
    return three_numbers(state.dof_velocity, world, model.tree[tree].first_velocity)


@func
def base_velocity(model: Model, state: State, world: Int32, tree: Int32) -> Vector3:
    """Velocity of the centre of mass of a tree's base [m/s]."""
    return three_numbers(state.dof_velocity, world, model.tree[tree].first_velocity + 3)


@func
def has_late_links(model: Model, tree: Int32) -> bool:
    """Whether the velocities of a tree's links are late, see `kernels.late.velocities`."""
    return model.tree[tree].late_count > 0


@func
def link_velocities(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Compute the velocities of all links of a tree at its reference point, from the rates of the dofs."""
    base = model.tree[tree].first_link
    scratch.link[world, base].omega = base_omega(model, state, world, tree)
    scratch.link[world, base].velocity = base_velocity(model, state, world, tree)
    for link in range(base + 1, base + model.tree[tree].link_count):
        parent = model.link[link].parent
        omega = scratch.link[world, parent].omega
        velocity = scratch.link[world, parent].velocity
        first = model.link[link].first_dof
        for dof in range(first, first + model.link[link].dof_count):
            rate = state.dof_velocity[world, dof]
            omega += scratch.dof[world, dof].angular * rate
            velocity += scratch.dof[world, dof].linear * rate
        scratch.link[world, link].omega = omega
        scratch.link[world, link].velocity = velocity


@kernel
def forward_kinematics_kernel(model: Model, state: State, tree: Int32, first_world: Int32):
    """Update the link poses of one tree from its coordinates."""
    forward_kinematics(model, state, state.link_pose, first_world + wp.tid(), tree)


@func
def update_link_poses(
    settings: Settings, model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32
):
    """Update the link poses of a tree that is present; the last ones are saved if bounds look ahead."""
    if is_absent(state, world, tree):
        return
    if settings.looks_ahead != 0:
        base = model.tree[tree].first_link
        for link in range(base, base + model.tree[tree].link_count):
            scratch.link_pose[world, link] = state.link_pose[world, link]
    forward_kinematics(model, state, state.link_pose, world, tree)


@kernel
def link_poses_kernel(settings: Settings, model: Model, state: State, scratch: Scratch, first_world: Int32):
    """Update the link poses of all trees that are present from their coordinates."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        update_link_poses(settings, model, state, scratch, world, tree)


@kernel
def link_twist_kernel(model: Model, state: State, scratch: Scratch, tree: Int32, first_world: Int32):
    """Compute the velocities of the links of one tree, in world axes, for its present coordinates.

    As in Bullet they are rotated to world axes by the orientations of `State.link_pose`, which after a step
    are those at the start of its last substep.
    """
    world = first_world + wp.tid()
    forward_kinematics(model, state, scratch.link_pose, world, tree)
    motion_subspaces(model, scratch.link_pose, scratch, world, tree)
    link_velocities(model, state, scratch, world, tree)
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        now = wp.transform_get_rotation(scratch.link_pose[world, link])
        reported = wp.transform_get_rotation(state.link_pose[world, link])
        omega = scratch.link[world, link].omega
        velocity = scratch.link[world, link].velocity + wp.cross(omega, scratch.link[world, link].offset)
        velocity = wp.quat_rotate(reported, wp.quat_rotate_inv(now, velocity))
        omega = wp.quat_rotate(reported, wp.quat_rotate_inv(now, omega))
        state.link_twist[world, link] = Vector6(
            velocity[0], velocity[1], velocity[2], omega[0], omega[1], omega[2]
        )
