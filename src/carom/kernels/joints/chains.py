"""Joints of the chains of inverse kinematics: `Chain`, whose frames have the axis of a hinge along z."""

import warp as wp

from carom.kernels.joints.coordinates import quaternion_at
from carom.kernels.maths.rotation import axis_rotation
from carom.kernels.structs import Chain, Search
from carom.kernels.types import Int32, Quaternion, Reals, Vector3, func, real
from carom.layouts.codes import PLANAR, PRISMATIC, REVOLUTE, SCREW, SPHERICAL


@func
def turned_about_z(rotation: Quaternion, angle: real) -> Quaternion:
    """A rotation followed by a rotation about its own z axis by `angle` [rad]."""
    s, c = wp.sin(0.5 * angle), wp.cos(0.5 * angle)
    return Quaternion(
        rotation[0] * c + rotation[1] * s,
        rotation[1] * c - rotation[0] * s,
        rotation[2] * c + rotation[3] * s,
        rotation[3] * c - rotation[2] * s,
    )


@func
def z_axis(rotation: Quaternion) -> Vector3:
    """The z axis of a frame."""
    return Vector3(
        2.0 * (rotation[0] * rotation[2] + rotation[3] * rotation[1]),
        2.0 * (rotation[1] * rotation[2] - rotation[3] * rotation[0]),
        1.0 - 2.0 * (rotation[0] * rotation[0] + rotation[1] * rotation[1]),
    )


@func
def has_quaternion(chain: Chain, joint: Int32) -> bool:
    """Whether the position of a joint is a quaternion, which its step turns about axes of its own."""
    return chain.joint[joint].kind == SPHERICAL


@func
def joint_frame(chain: Chain, joint: Int32, coordinates: Reals):
    """Origin and rotation of a joint's frame in that of its parent, at its position in `coordinates`."""
    origin = chain.joint[joint].origin
    rotation = chain.joint[joint].turn
    kind = chain.joint[joint].kind
    q = chain.joint[joint].first_coordinate
    if kind == REVOLUTE:
        rotation = turned_about_z(rotation, coordinates[q])
    elif kind == PRISMATIC:
        origin += z_axis(rotation) * (chain.joint[joint].slide * coordinates[q])
    elif kind == SPHERICAL:
        rotation = rotation * quaternion_at(coordinates, q)
    elif kind == PLANAR:
        origin += wp.quat_rotate(
            rotation,
            chain.joint[joint].planar_axis1 * coordinates[q + 1]
            + chain.joint[joint].planar_axis2 * coordinates[q + 2],
        )
        rotation = rotation * axis_rotation(chain.joint[joint].axis, coordinates[q])
    elif kind == SCREW:
        origin += z_axis(rotation) * (chain.joint[joint].slide * coordinates[q])
        rotation = turned_about_z(rotation, coordinates[q])
    return origin, rotation


@func
def write_column(search: Search, entry: Int32, oriented: Int32, linear: Vector3, angular: Vector3):
    """Set a column of the Jacobian: the effect of one degree of freedom on an end."""
    search.entry_jacobian[entry] = linear
    if oriented == 1:
        search.entry_jacobian[entry + 1] = angular


@func
def joint_columns(
    chain: Chain,
    search: Search,
    joint: Int32,
    coordinates: Reals,
    position: Vector3,
    entry: Int32,
    blocks: Int32,
    oriented: Int32,
):
    """Write the columns of a joint in the Jacobian of an end at `position`, from the joint's frame.

    The first begins at `entry`, each of the others `blocks` after the one before.
    """
    zero = Vector3(0.0, 0.0, 0.0)
    kind = chain.joint[joint].kind
    rotation = search.joint[joint].rotation
    axis = z_axis(rotation)
    arm = position - search.joint[joint].position
    if kind == REVOLUTE:
        write_column(search, entry, oriented, wp.cross(axis, arm), axis)
    elif kind == PRISMATIC:
        write_column(search, entry, oriented, axis * chain.joint[joint].slide, zero)
    elif kind == SPHERICAL:
        for k in range(3):
            unit = Vector3(0.0, 0.0, 0.0)
            unit[k] = 1.0
            axis = wp.quat_rotate(rotation, unit)
            write_column(search, entry + k * blocks, oriented, wp.cross(axis, arm), axis)
    elif kind == PLANAR:
        axis = wp.quat_rotate(rotation, chain.joint[joint].axis)
        write_column(search, entry, oriented, wp.cross(axis, arm), axis)
        angle = coordinates[chain.joint[joint].first_coordinate]
        unturned = rotation * axis_rotation(chain.joint[joint].axis, -angle)
        first = wp.quat_rotate(unturned, chain.joint[joint].planar_axis1)
        second = wp.quat_rotate(unturned, chain.joint[joint].planar_axis2)
        write_column(search, entry + blocks, oriented, first, zero)
        write_column(search, entry + 2 * blocks, oriented, second, zero)
    elif kind == SCREW:
        write_column(search, entry, oriented, wp.cross(axis, arm) + axis * chain.joint[joint].slide, axis)
