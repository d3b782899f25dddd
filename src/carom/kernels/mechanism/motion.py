"""Inverse dynamics of a mechanism in users' coordinates."""

import math

import warp as wp

from carom.kernels.joints.coordinates import quaternion_at, vector_at
from carom.kernels.joints.nodes import has_quaternion
from carom.kernels.maths.rotation import rotation_matrix
from carom.kernels.mechanism.dynamics import newton_euler, turned_back
from carom.kernels.structs import MechanismSizes, MechanismTable
from carom.kernels.types import Int32, Quaternion, Reals, Vector3, func, kernel, real
from carom.layouts.codes import BASE_POSITIONS
from carom.layouts.mechanism import BASE_MOTION, POSE

NOT_FINITE = real(math.inf)
# Sine of the pitch above which Bullet sets the roll to 0.
GIMBAL_LOCK = real(0.99999)


@func
def direction(x: real, y: real):
    """Cosine and sine of `atan2(y, x)`."""
    length = wp.sqrt(x * x + y * y)
    cosine, sine = real(1.0), real(0.0)
    if length > 0.0:
        cosine, sine = x / length, y / length
    return cosine, sine


@func
def turned_back_in_opposite_order(q: Quaternion, v: Vector3) -> Vector3:
    """Components of a vector in a frame rotated by a quaternion's yaw, pitch and roll, in the wrong order.

    PyBullet converts the orientation of a floating base to these angles and back in the opposite order. The
    result is wrong only for a base rotated about more than one axis.
    """
    x, y, z, w = q[0], q[1], q[2], q[3]
    sp = -2.0 * (x * z - w * y)
    cp = real(0.0)
    cr, sr = real(1.0), real(0.0)
    if wp.abs(sp) >= GIMBAL_LOCK:
        sp = wp.sign(sp)
        c, s = direction(sp * y, -sp * x)
        cy, sy = c * c - s * s, 2.0 * c * s
    else:
        cp = wp.sqrt((1.0 - sp) * (1.0 + sp))
        cr, sr = direction(w * w - x * x - y * y + z * z, 2.0 * (y * z + w * x))
        cy, sy = direction(w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z))
    unrolled = Vector3(v[0], cr * v[1] + sr * v[2], cr * v[2] - sr * v[1])
    level = Vector3(cp * unrolled[0] - sp * unrolled[2], unrolled[1], sp * unrolled[0] + cp * unrolled[2])
    return Vector3(cy * level[0] + sy * level[1], cy * level[1] - sy * level[0], level[2])


@func
def rotation_by_angles(roll: real, pitch: real, yaw: real) -> Quaternion:
    """The rotation by a roll about x, then a pitch about y, then a yaw about z, all fixed axes."""
    sr, cr = wp.sin(0.5 * roll), wp.cos(0.5 * roll)
    sp, cp = wp.sin(0.5 * pitch), wp.cos(0.5 * pitch)
    sy, cy = wp.sin(0.5 * yaw), wp.cos(0.5 * yaw)
    return Quaternion(
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


@func
def take_positions(
    sizes: MechanismSizes, mechanism: MechanismTable, question: Reals, first: Int32, by_angles: Int32
):
    """Copy the positions of the joints from the question of `motion_kernel`, from `first` on, to `input`.

    If `by_angles` is 1, positions of spherical joints are roll, pitch and yaw instead of a quaternion.
    """
    joint_dofs = sizes.dofs - sizes.base_dofs
    if by_angles == 0 or sizes.coordinates == joint_dofs:
        for i in range(sizes.coordinates):
            mechanism.input[BASE_MOTION + i] = question[first + i]
        return
    for node in range(1, sizes.nodes):
        given = first + mechanism.node[node].first_dof - sizes.base_dofs
        q = BASE_MOTION + mechanism.node[node].first_position
        if has_quaternion(mechanism, node):
            turn = rotation_by_angles(question[given], question[given + 1], question[given + 2])
            for i in range(4):
                mechanism.input[q + i] = turn[i]
        else:
            for i in range(mechanism.node[node].dof_count):
                mechanism.input[q + i] = question[given + i]


@func
def gravity_in_base(question: Reals, first: Int32, opposite_order: Int32) -> Vector3:
    """Gravity in the axes of a free base; not finite if the length of its quaternion is 0 or NaN."""
    gravity = vector_at(question, first)
    turn = quaternion_at(question, first + POSE + 3)
    if not wp.length_sq(turn) > 0.0:
        return Vector3(NOT_FINITE, NOT_FINITE, NOT_FINITE)
    if opposite_order == 1:
        return turned_back_in_opposite_order(turn, gravity)
    return turned_back(rotation_matrix(wp.normalize(turn)), gravity)


@func
def forces_of_motion(
    sizes: MechanismSizes, mechanism: MechanismTable, question: Reals, first: Int32, as_pybullet: Int32
):
    """Compute in `output` what `motion_kernel` does, for a question that begins at `first`."""
    positions = first + POSE
    acceleration = -vector_at(question, first)
    omega, alpha, own = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    unused = real(0.0)
    if sizes.base_dofs > 0:
        positions += BASE_POSITIONS
    rates = positions + sizes.dofs - sizes.base_dofs if as_pybullet == 1 else positions + sizes.coordinates
    if sizes.base_dofs > 0:
        omega = vector_at(question, rates)
        alpha = vector_at(question, rates + sizes.dofs)
        own = vector_at(question, rates + sizes.dofs + 3)
        acceleration = own - gravity_in_base(question, first, as_pybullet)
        # Position and velocity of the base have no influence, but have to be finite, too.
        idle = vector_at(question, first + POSE) + vector_at(question, rates + 3)
        unused = 0.0 * (idle[0] + idle[1] + idle[2])
    take_positions(sizes, mechanism, question, positions, as_pybullet)
    newton_euler(sizes, mechanism, omega, alpha, acceleration, question, rates, rates + sizes.dofs)
    if sizes.base_dofs > 0:
        unused += 0.0 * mechanism.output[0]
        for axis in range(3):
            torque = mechanism.output[axis]
            mechanism.output[axis] = mechanism.output[3 + axis] + unused
            mechanism.output[3 + axis] = torque
            if sizes.has_armature != 0:
                mechanism.output[axis] += mechanism.dof_armature[3 + axis] * own[axis]
                mechanism.output[3 + axis] += mechanism.dof_armature[axis] * alpha[axis]


@kernel
def motion_kernel(sizes: MechanismSizes, mechanism: MechanismTable, question: Reals, as_pybullet: Int32):
    """Compute in `output` the generalized forces that cause a motion; for a free base, force before torque.

    The question is gravity in the axes of the base; positions; rates; accelerations. With a free base,
    gravity is in world axes; position and quaternion of the base come before the other positions, its angular
    velocity and its velocity, in its own axes, before the other rates, and their derivatives likewise. If
    `as_pybullet` is 1, gravity acts on a free base in the same direction as in PyBullet, and positions of
    spherical joints are roll, pitch and yaw.
    """
    forces_of_motion(sizes, mechanism, question, 0, as_pybullet)
