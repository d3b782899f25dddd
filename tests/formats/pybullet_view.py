"""A body as PyBullet's getJointInfo and getDynamicsInfo show it, for comparison with recorded answers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from carom.description import JointType, Pose, Robot
from carom.description.pose import Quaternion
from carom.description.transform import (
    compose,
    conjugate,
    inverse,
    multiplied,
    quaternion_from_matrix,
    rotate,
    rotation_matrix,
    transposed,
)
from carom.model.body_spec import BASE, BodySpec, LinkSpec

TYPE_CODES = {
    JointType.REVOLUTE: 0,
    JointType.CONTINUOUS: 0,
    JointType.PRISMATIC: 1,
    JointType.SPHERICAL: 2,
    JointType.PLANAR: 3,
    JointType.FIXED: 4,
}
_POSITIONS = {0: 1, 1: 1, 2: 4, 3: 3, 4: 0}
_VELOCITIES = {0: 1, 1: 1, 2: 3, 3: 3, 4: 0}


def joint_infos(body: BodySpec) -> list[list[Any]]:
    """getJointInfo of every joint."""
    rows = []
    q, u = 7, 6
    for index, link in enumerate(body.links):
        code = TYPE_CODES[link.joint_type]
        moves = code != 4
        parent = body.base if link.parent == BASE else body.links[link.parent]
        pivot = compose(inverse(parent.inertial_frame), link.joint_frame)
        rows.append(
            [
                index,
                link.joint_name,
                code,
                q if moves else -1,
                u if moves else -1,
                1 if code in (0, 1) else 0,
                link.damping,
                link.friction,
                link.lower,
                link.upper,
                link.effort,
                link.velocity,
                link.name,
                _reported_axis(link, code),
                list(pivot.position),
                list(multiplied(_turned_back(link.inertial_frame), _turned_back(pivot))),
                link.parent,
            ]
        )
        q += _POSITIONS[code]
        u += _VELOCITIES[code]
    return rows


def _turned_back(pose: Pose) -> Quaternion:
    """Inverse of the orientation, with the sign PyBullet's way through a matrix gives it."""
    return quaternion_from_matrix(transposed(rotation_matrix(pose.orientation)))


def _reported_axis(link: LinkSpec, code: int) -> list[float]:
    if code not in (0, 1):
        return [0.0, 0.0, 0.0]
    axis = rotate(conjugate(link.inertial_frame.orientation), link.joint_axis)
    return [value * link.joint_axis_length for value in axis]


def dynamics_infos(body: BodySpec) -> list[list[Any]]:
    """The parts of getDynamicsInfo that come from the file, of the base and every link."""
    return [
        [
            link.mass,
            0.5 if link.contact.lateral_friction is None else link.contact.lateral_friction,
            list(link.inertia),
            list(link.inertial_frame.position),
            list(link.inertial_frame.orientation),
            link.contact.restitution or 0.0,
            link.contact.rolling_friction or 0.0,
            link.contact.spinning_friction or 0.0,
            -1.0 if link.contact.damping is None else link.contact.damping,
            -1.0 if link.contact.stiffness is None else link.contact.stiffness,
        ]
        for link in (body.base, *body.links)
    ]


def with_plain_capsules(robot: Robot) -> Robot:
    """A robot whose capsules are capsules: URDF cannot say that they are PyBullet's swept spheres."""
    links = tuple(
        replace(link, collisions=tuple(replace(shape, ends_frame=None) for shape in link.collisions))
        for link in robot.links
    )
    return replace(robot, links=links)
