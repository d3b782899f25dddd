"""Forward kinematics of a chain: poses of its ends, their errors, and their Jacobian."""

import warp as wp

from carom.kernels.maths.rotation import axis_rotation, rotation_vector
from carom.kernels.mechanism.dynamics import quaternion_at
from carom.kernels.structs import Chain, ChainSizes, Search
from carom.kernels.types import Int32, Quaternion, Reals, Vector3, func, real
from carom.layouts.codes import PLANAR, PRISMATIC, REVOLUTE, SPHERICAL


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
def place(sizes: ChainSizes, chain: Chain, search: Search, coordinates: Reals):
    """Forward kinematics: compute the frames of all joints of a chain."""
    # The frame of the last joint stays in local variables: most often it is the parent of the next joint.
    last_position = Vector3(0.0, 0.0, 0.0)
    last_rotation = Quaternion(0.0, 0.0, 0.0, 1.0)
    for joint in range(sizes.joints):
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
        parent = chain.joint[joint].parent
        if parent >= 0:
            if parent != joint - 1:
                last_position = search.joint[parent].position
                last_rotation = search.joint[parent].rotation
            origin = last_position + wp.quat_rotate(last_rotation, origin)
            rotation = last_rotation * rotation
        search.joint[joint].position = origin
        search.joint[joint].rotation = rotation
        last_position = origin
        last_rotation = rotation


@func
def end_position(chain: Chain, search: Search, end: Int32) -> Vector3:
    """Position of an end in the frame of the base [m]."""
    joint = chain.end_joint[end]
    position = chain.end_offset[end]
    if joint >= 0:
        position = search.joint[joint].position + wp.quat_rotate(search.joint[joint].rotation, position)
    return position


@wp.struct
class Errors:
    """The errors of the ends."""

    distance: real  # the largest [m]
    angle: real  # the largest [rad]
    squares: real  # sum of the squares of all errors


@func
def measure_errors(sizes: ChainSizes, chain: Chain, search: Search, oriented: Int32) -> Errors:
    """Fill `block_error` with the vectors from the ends to their targets; returns their lengths."""
    distance, angle, squares = real(0.0), real(0.0), real(0.0)
    stride = 1 + oriented
    for end in range(sizes.ends):
        way = search.end_target_position[end] - end_position(chain, search, end)
        search.block_error[end * stride] = way
        distance = wp.max(distance, wp.length(way))
        squares += wp.dot(way, way)
        if oriented == 1:
            rotation = chain.end_turn[end]
            joint = chain.end_joint[end]
            if joint >= 0:
                rotation = search.joint[joint].rotation * rotation
            turn = rotation_vector(search.end_target_rotation[end] * wp.quat_inverse(rotation))
            search.block_error[end * stride + 1] = turn
            angle = wp.max(angle, wp.length(turn))
            squares += wp.dot(turn, turn)
    errors = Errors()
    errors.distance = distance
    errors.angle = angle
    errors.squares = squares
    return errors


@func
def write_column(search: Search, entry: Int32, oriented: Int32, linear: Vector3, angular: Vector3):
    """Set a column of the Jacobian: the effect of one degree of freedom on an end."""
    search.entry_jacobian[entry] = linear
    if oriented == 1:
        search.entry_jacobian[entry + 1] = angular


@func
def fill_jacobian(sizes: ChainSizes, chain: Chain, search: Search, coordinates: Reals, oriented: Int32):
    """Compute the Jacobian of the ends from the current joint frames."""
    stride = 1 + oriented
    blocks = stride * sizes.ends
    zero = Vector3(0.0, 0.0, 0.0)
    if sizes.ends > 1:
        for entry in range(blocks * sizes.columns):
            search.entry_jacobian[entry] = zero
    for end in range(sizes.ends):
        position = end_position(chain, search, end)
        joint = chain.end_joint[end]
        while joint >= 0:
            kind = chain.joint[joint].kind
            entry = chain.joint[joint].first_column * blocks + end * stride
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
            joint = chain.joint[joint].parent


@func
def turned(coordinates: Reals, q: Int32, rate: Vector3) -> Quaternion:
    """The quaternion at `q` after a rotation by the rotation vector `rate`, in its own axes."""
    angle = wp.length(rate)
    scale = wp.sin(0.5 * angle) / angle if angle > 1.0e-9 else 0.5
    change = Quaternion(rate[0] * scale, rate[1] * scale, rate[2] * scale, wp.cos(0.5 * angle))
    return wp.normalize(quaternion_at(coordinates, q) * change)


@func
def turn_joints(sizes: ChainSizes, chain: Chain, search: Search, start: Reals, result: Reals):
    """Turn the spherical joints from the positions `start` on by the steps of their dofs."""
    for joint in range(sizes.joints):
        if chain.joint[joint].kind == SPHERICAL:
            dof = chain.joint[joint].first_dof
            q = chain.joint[joint].first_coordinate
            rate = Vector3(search.dof[dof].step, search.dof[dof + 1].step, search.dof[dof + 2].step)
            quaternion = turned(start, q, rate)
            for k in range(4):
                result[q + k] = quaternion[k]


@func
def advance(sizes: ChainSizes, chain: Chain, search: Search, start: Reals, result: Reals):
    """Add the steps of all dofs to the positions `start` and write the positions to `result`."""
    for dof in range(sizes.dofs):
        coordinate = chain.dof_coordinate[dof]
        if coordinate >= 0:
            result[coordinate] = start[coordinate] + search.dof[dof].step
    turn_joints(sizes, chain, search, start, result)


@func
def copy(count: Int32, source: Reals, target: Reals):
    """Copy `count` numbers."""
    for index in range(count):
        target[index] = source[index]
