"""Bodies as mechanisms of nodes, as in PyBullet's stable PD controller.

Differences between PyBullet's controller and its engine are reproduced, so that torques are equal: inertias
are computed from the first collision shape of a link alone, capsules have their axis along y, sliders move
along the x axis of their inertial frame, and a base without shapes is left out if the first link is fixed.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.joints import joint_axes, screw_lead
from carom.algorithms.nodes import Node, skew
from carom.description import Collision
from carom.description.pose import Pose, Quaternion, Vector3
from carom.description.shapes.bounds import Bounds
from carom.description.transform import compose, conjugate, inverse, multiplied, rotate, rpy_from_quaternion
from carom.layouts.codes import DRIVEN, PLANES, SLIDING_JOINTS, JointCode
from carom.layouts.contacts import MARGIN
from carom.layouts.flags import LoadFlags
from carom.model.body_spec import BASE, LinkSpec
from carom.model.bounds import shape_bounds
from carom.native.products import product
from carom.native.trigonometry import cos, sin

if TYPE_CHECKING:
    from carom.scene.body import Body

_NO_TURN = (0.0, 0.0, 0.0, 1.0)
_X, _Z = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
# PyBullet reads the orientation of a slider's axis from the wrong memory. The result is this quaternion,
# whose length is not 1.
_SLIDER_TURN = (0.0, 0.0, 0.0, sqrt(0.5))


@dataclass(frozen=True, slots=True)
class _Frame:
    """The joint frame of a link: its rotation relative to the inertial frame, and `com` in joint axes."""

    turn: Quaternion
    com: Vector3


def extended_nodes(body: Body, *, as_pybullet: bool) -> list[Node]:
    """The nodes of a body, parents before children, the root first.

    With `as_pybullet` they reproduce the differences listed above; otherwise they are those of the body.

    Raises:
        ValueError: A joint is planar.
        DescriptionError: The file of a collision mesh cannot be used.
    """
    if not set(PLANES).isdisjoint(body.joint_types):
        raise ValueError("planar joints have no extended coordinates")
    first_link = 0 if as_pybullet and _base_is_left_out(body) else BASE
    nodes: list[Node] = []
    frames: dict[int, _Frame] = {}
    node_of: dict[int, int] = {}
    for link in range(first_link, body.joint_count):
        spec = body.link_spec(link)
        kind = JointCode.FIXED if link == first_link else JointCode(body.joint_types[link])
        frames[link] = frame = _joint_frame(kind, spec, as_pybullet, is_base=link == BASE)
        parent, rotation, origin = -1, np.eye(3), np.zeros(3)
        if nodes:
            parent = node_of[spec.parent]
            rotation, origin = _placement(body.link_spec(spec.parent), frames[spec.parent], spec, frame)
        node_of[link] = len(nodes)
        lead = 0.0 if link == first_link else screw_lead(body, link)
        rigid = _rigid_body(body, link, frame, as_pybullet)
        armature = 0.0 if link == first_link else body.dynamics(link).joint_armature
        nodes.append(Node(parent, kind, rotation, origin, *rigid, _axes(kind, lead), armature))
    return nodes


def _axes(kind: JointCode, lead: float) -> np.ndarray:
    axes = joint_axes(kind, lead)
    # Sliders move along x.
    return axes[:, :, ::-1] if kind in SLIDING_JOINTS else axes


def _base_is_left_out(body: Body) -> bool:
    return not body.spec.base.collisions and body.joint_count > 0 and body.joint_types[0] == JointCode.FIXED


def _joint_frame(kind: JointCode, spec: LinkSpec, as_pybullet: bool, *, is_base: bool) -> _Frame:
    if is_base:
        return _Frame(_NO_TURN, (0.0, 0.0, 0.0))
    to_inertial = conjugate(spec.inertial_frame.orientation)
    x, y, z = rotate(to_inertial, spec.joint_axis)
    # PyBullet turns z to the axis as it is given, whatever its length.
    size = spec.joint_axis_length if as_pybullet else 1.0
    axis = (x * size, y * size, z * size)
    turn = _NO_TURN
    if kind in DRIVEN and kind not in SLIDING_JOINTS:
        turn = _shortest_turn(_Z, axis, (0.0, -1.0, 0.0, 0.0))
    elif kind in SLIDING_JOINTS:
        turn = _SLIDER_TURN if as_pybullet else _shortest_turn(_X, axis, (0.0, 0.0, 1.0, 0.0))
    return _Frame(turn, _turned(conjugate(turn), rotate(to_inertial, spec.inertial_frame.position)))


def _placement(
    carrier: LinkSpec, carrier_frame: _Frame, spec: LinkSpec, frame: _Frame
) -> tuple[np.ndarray, np.ndarray]:
    """Rotation and origin of the joint frame of a link in the joint frame of its parent link."""
    joint = compose(inverse(carrier.inertial_frame), spec.joint_frame)
    at_rest = compose(joint, Pose((0.0, 0.0, 0.0), spec.inertial_frame.orientation)).orientation
    back = conjugate(carrier_frame.turn)
    rotation = _rotation_by_angles(multiplied(multiplied(back, at_rest), frame.turn))
    x, y, z = _turned(carrier_frame.turn, carrier_frame.com)
    jx, jy, jz = joint.position
    return rotation, np.array(_turned(back, (jx + x, jy + y, jz + z)))


def _rigid_body(
    body: Body, link: int, frame: _Frame, as_pybullet: bool
) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass of a link, and its first moment and inertia about its joint."""
    dynamics, spec = body.dynamics(link), body.link_spec(link)
    moments = dynamics.inertia
    if as_pybullet:
        implicit = bool(body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
        moments = _moments(dynamics.mass, spec.collisions, implicit)
    turn = _rotation_by_angles(conjugate(frame.turn))
    com = np.array(frame.com)
    offset = skew(com)
    about_joint = product(product(turn, np.diag(moments)), turn.T) + product(dynamics.mass * offset, offset.T)
    return dynamics.mass, dynamics.mass * com, about_joint


def _moments(mass: float, collisions: tuple[Collision, ...], implicit_cylinder: bool) -> Vector3:
    """Moments of inertia of the first shape, as if its centre were the centre of mass."""
    if not collisions:
        bounds = Bounds((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)).grown(MARGIN).grown(MARGIN)
    else:
        geometry = collisions[0].geometry
        own = geometry.controller_moments(mass)
        if own is not None:
            return own
        bounds = shape_bounds(geometry, implicit_cylinder=implicit_cylinder).grown(MARGIN)
    x, y, z = bounds.half
    return (mass / 3.0 * (y * y + z * z), mass / 3.0 * (x * x + z * z), mass / 3.0 * (x * x + y * y))


def _shortest_turn(start: Vector3, end: Vector3, opposite: Quaternion) -> Quaternion:
    """The shortest rotation from one unit vector to another; `opposite` if they have opposite directions."""
    cosine = start[0] * end[0] + start[1] * end[1] + start[2] * end[2]
    if cosine < -1.0 + 2.220446049250313e-16:
        return opposite
    s = sqrt((1.0 + cosine) * 2.0)
    x = (start[1] * end[2] - start[2] * end[1]) / s
    y = (start[2] * end[0] - start[0] * end[2]) / s
    z = (start[0] * end[1] - start[1] * end[0]) / s
    return (x, y, z, 0.5 * s)


def _turned(q: Quaternion, v: Vector3) -> Vector3:
    """The product q v q*, which also scales the vector if the quaternion does not have unit length."""
    x, y, z, _ = multiplied(multiplied(q, (*v, 0.0)), conjugate(q))
    return (x, y, z)


def _rotation_by_angles(q: Quaternion) -> np.ndarray:
    """Rotation matrix computed from roll, pitch and yaw, which matters if the length of `q` is not one."""
    roll, pitch, yaw = rpy_from_quaternion(q)
    sr, cr, sp, cp, sy, cy = sin(roll), cos(roll), sin(pitch), cos(pitch), sin(yaw), cos(yaw)
    return np.array(
        [
            [cp * cy, sr * sp * cy - cr * sy, cr * sp * cy + sr * sy],
            [cp * sy, sr * sp * sy + cr * cy, cr * sp * sy - sr * cy],
            [-sp, sr * cp, cr * cp],
        ]
    )
