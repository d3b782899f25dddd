"""Forward kinematics of a chain: poses of its ends, their errors, and their Jacobian."""

import warp as wp

from carom.kernels.joints.chains import has_quaternion, joint_columns, joint_frame
from carom.kernels.joints.coordinates import quaternion_at
from carom.kernels.maths.rotation import rotation_vector
from carom.kernels.structs import Chain, ChainSizes, Search
from carom.kernels.types import Int32, Quaternion, Reals, Vector3, func, real


@func
def place(sizes: ChainSizes, chain: Chain, search: Search, coordinates: Reals):
    """Forward kinematics: compute the frames of all joints of a chain."""
    # The frame of the last joint stays in local variables: most often it is the parent of the next joint.
    last_position = Vector3(0.0, 0.0, 0.0)
    last_rotation = Quaternion(0.0, 0.0, 0.0, 1.0)
    for joint in range(sizes.joints):
        origin, rotation = joint_frame(chain, joint, coordinates)
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
            entry = chain.joint[joint].first_column * blocks + end * stride
            joint_columns(chain, search, joint, coordinates, position, entry, blocks, oriented)
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
        if has_quaternion(chain, joint):
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
