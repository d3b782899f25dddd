"""Data of `getJointInfo`: joints as their file describes them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.description.pose import Pose, Quaternion, Vector3
from carom.description.transform import (
    compose,
    conjugate,
    inverse,
    multiplied,
    quaternion_from_matrix,
    rotate,
    rotation_matrix,
)

if TYPE_CHECKING:
    from carom.model.body_spec import LinkSpec
    from carom.scene.body import Body

JointInfo = tuple[
    int,
    bytes,
    int,
    int,
    int,
    int,
    float,
    float,
    float,
    float,
    float,
    float,
    bytes,
    Vector3,
    Vector3,
    Quaternion,
    int,
]

_HAS_MOTOR = 1
_NOT_AVAILABLE = b"not available"


def joint_info(body: Body, index: int) -> JointInfo:
    """The 17 fields of `getJointInfo` for one joint."""
    link = body.spec.links[index]
    has_motor = body.velocity_count[index] == 1
    q, u = body.position_index[index], body.velocity_index[index]
    parent = body.spec.link(link.parent)
    in_parent = compose(inverse(parent.inertial_frame), link.joint_frame)
    return (
        index,
        link.joint_name.encode() or _NOT_AVAILABLE,
        body.joint_types[index],
        q - body.first_position if q >= 0 else -1,
        u - body.first_velocity if u >= 0 else -1,
        _HAS_MOTOR if has_motor else 0,
        float(link.damping),
        float(link.friction),
        float(link.lower),
        float(link.upper),
        float(link.effort),
        float(link.velocity),
        link.name.encode() or _NOT_AVAILABLE,
        _axis_in_inertial_frame(link) if has_motor else (0.0, 0.0, 0.0),
        in_parent.position,
        _rotation_from_parent(in_parent, link.inertial_frame),
        link.parent,
    )


def _axis_in_inertial_frame(link: LinkSpec) -> Vector3:
    """The axis of a link's joint in the link's inertial frame, with the length that it has in the file."""
    x, y, z = rotate(conjugate(link.inertial_frame.orientation), link.joint_axis)
    length = link.joint_axis_length
    return (x * length, y * length, z * length)


def _rotation_from_parent(joint_frame: Pose, inertial_frame: Pose) -> Quaternion:
    """Rotation of vectors from the parent's inertial frame to the link's, at joint position 0.

    Both factors are quaternions computed from rotation matrices, because this decides the result's sign.
    """
    return multiplied(_inverse_rotation(inertial_frame), _inverse_rotation(joint_frame))


def _inverse_rotation(pose: Pose) -> Quaternion:
    return quaternion_from_matrix(rotation_matrix(conjugate(pose.orientation)))
