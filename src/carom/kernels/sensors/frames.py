"""Frames of sensors on links: where they are and how they move.

Poses and velocities of links are those in the workspace, see `place_links`.
"""

import warp as wp

from carom.kernels.dynamics.kinematics import forward_kinematics, link_velocities, motion_subspaces
from carom.kernels.structs import Model, Scratch, State
from carom.kernels.types import Int32, Quaternion, Vector3, func


@func
def place_links(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Fill in poses and velocities of the links of a tree for the coordinates in `state`."""
    forward_kinematics(model, state, scratch.link_pose, world, tree)
    motion_subspaces(model, scratch.link_pose, scratch, world, tree)
    link_velocities(model, state, scratch, world, tree)


@func
def center_of_link(scratch: Scratch, world: Int32, link: Int32) -> Vector3:
    """Centre of mass of a link, in world axes [m]."""
    return wp.transform_get_translation(scratch.link_pose[world, link])


@func
def turn_of_link(scratch: Scratch, world: Int32, link: Int32) -> Quaternion:
    """Orientation of its inertial frame."""
    return wp.transform_get_rotation(scratch.link_pose[world, link])


@func
def center_velocity(scratch: Scratch, world: Int32, link: Int32) -> Vector3:
    """Velocity of the centre of mass of a link [m/s]."""
    arm = scratch.link[world, link].offset
    return scratch.link[world, link].velocity + wp.cross(scratch.link[world, link].omega, arm)


@func
def frame_position(scratch: Scratch, world: Int32, link: Int32, position: Vector3) -> Vector3:
    """Origin of a frame at `position` in the inertial frame of a link."""
    turn = turn_of_link(scratch, world, link)
    return center_of_link(scratch, world, link) + wp.quat_rotate(turn, position)


@func
def frame_velocity(scratch: Scratch, world: Int32, link: Int32, position: Vector3) -> Vector3:
    """Velocity of the origin of such a frame."""
    arm = wp.quat_rotate(turn_of_link(scratch, world, link), position)
    return center_velocity(scratch, world, link) + wp.cross(scratch.link[world, link].omega, arm)
