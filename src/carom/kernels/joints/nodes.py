"""Joints of mechanisms: `MechanismTable`, whose node frames have the axis of a hinge or slider along z."""

import warp as wp

from carom.kernels.joints.coordinates import quaternion_at, vector_at
from carom.kernels.maths.rotation import axis_rotation, rotation_matrix
from carom.kernels.structs import DofAxis, MechanismTable
from carom.kernels.types import Int32, Matrix3, Reals, Vector3, func, real
from carom.layouts.codes import PLANAR, PRISMATIC, REVOLUTE, SCREW, SPHERICAL
from carom.layouts.mechanism import BASE_MOTION


@func
def turned_about_z(r: Matrix3, angle: real) -> Matrix3:
    """The product of a rotation matrix and a rotation about z."""
    s, c = wp.sin(angle), wp.cos(angle)
    return Matrix3(
        r[0, 0] * c + r[0, 1] * s, r[0, 1] * c - r[0, 0] * s, r[0, 2],
        r[1, 0] * c + r[1, 1] * s, r[1, 1] * c - r[1, 0] * s, r[1, 2],
        r[2, 0] * c + r[2, 1] * s, r[2, 1] * c - r[2, 0] * s, r[2, 2],
    )  # fmt: skip


@func
def along(axis: DofAxis, torque: Vector3, force: Vector3) -> real:
    """Generalized force of a dof with a torque and a force."""
    return wp.dot(axis.angular, torque) + wp.dot(axis.linear, force)


@func
def has_quaternion(mechanism: MechanismTable, node: Int32) -> bool:
    """Whether the position of a joint is a quaternion, and its velocity angular, in the axes of its node."""
    return mechanism.node[node].joint_type == SPHERICAL


@func
def joint_turn(mechanism: MechanismTable, node: Int32) -> Matrix3:
    """Rotation from a node's frame to its parent's, at the joint positions in `input`."""
    turn = mechanism.node[node].turn
    kind = mechanism.node[node].joint_type
    q = BASE_MOTION + mechanism.node[node].first_position
    if kind == REVOLUTE or kind == SCREW:
        return turned_about_z(turn, mechanism.input[q])
    if kind == SPHERICAL:
        return turn * rotation_matrix(wp.normalize(quaternion_at(mechanism.input, q)))
    if kind == PLANAR:
        axis = wp.normalize(mechanism.dof[mechanism.node[node].first_dof].angular)
        return turn * rotation_matrix(axis_rotation(axis, mechanism.input[q]))
    return turn


@func
def joint_origin(mechanism: MechanismTable, node: Int32) -> Vector3:
    """Origin of a node's frame in its parent's, at the joint positions in `input`."""
    origin = mechanism.node[node].origin
    kind = mechanism.node[node].joint_type
    q = BASE_MOTION + mechanism.node[node].first_position
    dof = mechanism.node[node].first_dof
    if kind == PRISMATIC or kind == SCREW:
        return origin + mechanism.node[node].turn * (mechanism.dof[dof].linear * mechanism.input[q])
    if kind == PLANAR:
        # The translations are measured along axes that do not turn with the joint.
        slide = (
            mechanism.dof[dof + 1].linear * mechanism.input[q + 1]
            + mechanism.dof[dof + 2].linear * mechanism.input[q + 2]
        )
        return origin + mechanism.node[node].turn * slide
    return origin


@func
def joint_motion(
    mechanism: MechanismTable,
    node: Int32,
    angular: Vector3,
    change: Vector3,
    linear: Vector3,
    joints: Reals,
    rates: Int32,
    accelerations: Int32,
):
    """Add the motion of a joint to that which the parent gives its node, in the node's frame.

    That is angular velocity, its derivative, and linear acceleration at the node's origin. `joints`, `rates`
    and `accelerations` are as in `mechanism.dynamics.newton_euler`.
    """
    dof = mechanism.node[node].first_dof
    if mechanism.node[node].joint_type == REVOLUTE:
        per_rate = mechanism.dof[dof].angular[2]
        spin = per_rate * joints[rates + dof]
        spin_up = per_rate * joints[accelerations + dof] if accelerations >= 0 else 0.0
        return (
            Vector3(angular[0], angular[1], angular[2] + spin),
            Vector3(change[0] + angular[1] * spin, change[1] - angular[0] * spin, change[2] + spin_up),
            linear,
        )
    if mechanism.node[node].joint_type == PRISMATIC:
        axis = mechanism.dof[dof].linear
        linear += wp.cross(2.0 * angular, axis * joints[rates + dof])
        if accelerations >= 0:
            linear += axis * joints[accelerations + dof]
        return angular, change, linear
    if mechanism.node[node].joint_type == SPHERICAL:
        own = vector_at(joints, rates + dof)
        if accelerations >= 0:
            change += vector_at(joints, accelerations + dof)
        return angular + own, change + wp.cross(angular, own), linear
    joint_omega, joint_velocity = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    for other in range(dof, dof + mechanism.node[node].dof_count):
        rate = joints[rates + other]
        joint_omega += mechanism.dof[other].angular * rate
        joint_velocity += mechanism.dof[other].linear * rate
        if accelerations >= 0:
            change += mechanism.dof[other].angular * joints[accelerations + other]
            linear += mechanism.dof[other].linear * joints[accelerations + other]
    return (
        angular + joint_omega,
        change + wp.cross(angular, joint_omega),
        linear + wp.cross(2.0 * angular + joint_omega, joint_velocity),
    )


@func
def joint_forces(mechanism: MechanismTable, node: Int32, torque: Vector3, force: Vector3):
    """Write the generalized forces of a joint for torque and force on its node to `output`."""
    dof = mechanism.node[node].first_dof
    if mechanism.node[node].joint_type == REVOLUTE:
        mechanism.output[dof] = mechanism.dof[dof].angular[2] * torque[2]
    elif mechanism.node[node].joint_type == PRISMATIC:
        mechanism.output[dof] = wp.dot(mechanism.dof[dof].linear, force)
    elif mechanism.node[node].joint_type == SPHERICAL:
        for k in range(3):
            mechanism.output[dof + k] = torque[k]
    else:
        for other in range(dof, dof + mechanism.node[node].dof_count):
            mechanism.output[other] = along(mechanism.dof[other], torque, force)
