"""Bodies as trees of nodes for `ExtendedModel`, as PyBullet's stable PD controller makes them.

What PyBullet does differently from its own engine is kept, so that its torques are met: inertias come
from the first collision shape of a link alone, capsules have their axis along y, sliders move along the
x axis of their inertial frame, and a base without shapes is left out when a fixed link can stand in.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin, sqrt
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from carom.description import Box, Capsule, Collision, Sphere
from carom.description.pose import Pose, Quaternion, Vector3
from carom.description.transform import compose, conjugate, inverse, multiplied, rotate, rpy_from_quaternion
from carom.model.body_spec import BASE, LinkSpec
from carom.model.bounds import MARGIN, Bounds, shape_bounds
from carom.model.codes import JointCode
from carom.model.flags import LoadFlags

if TYPE_CHECKING:
    from carom.body import Body

ROOT_COORDINATES = 7
_COORDINATES = {
    JointCode.REVOLUTE: 1,
    JointCode.PRISMATIC: 1,
    JointCode.SPHERICAL: 4,
    JointCode.FIXED: 0,
}
_NO_TURN = (0.0, 0.0, 0.0, 1.0)
_X, _Z = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
# PyBullet looks for the axis of a slider where there is none; what it finds is half a quaternion.
_SLIDER_TURN = (0.0, 0.0, 0.0, sqrt(0.5))


@dataclass(frozen=True, slots=True)
class Node:
    """A link and the joint that carries it.

    Attributes:
        parent: Index of the parent node, -1 for the root.
        kind: Of the joint; the root's does not matter.
        first: Its first coordinate.
        count: How many it has.
        rotation: Turns vectors from the joint frame at coordinate 0 to the parent's joint frame.
        origin: Origin of the joint frame in the parent's joint frame [m].
        inertia: Spatial inertia about the origin of the joint frame, (6, 6).
    """

    parent: int
    kind: JointCode
    first: int
    count: int
    rotation: np.ndarray
    origin: np.ndarray
    inertia: np.ndarray


# Nodes of bodies, with and without the peculiarities, and the masses and inertias they were made with.
_remembered: WeakKeyDictionary[Body, dict[bool, tuple[list[tuple[float, Vector3]], list[Node]]]]
_remembered = WeakKeyDictionary()


@dataclass(frozen=True, slots=True)
class _Frame:
    """The joint frame of a link: turned against its inertial frame, which is `com` away in joint axes."""

    turn: Quaternion
    com: Vector3


def extended_nodes(body: Body, *, as_pybullet: bool) -> list[Node]:
    """The nodes of a body.

    Args:
        body: The body.
        as_pybullet: With the peculiarities named above; otherwise as the body is.

    Returns:
        Parents before children, the root first.

    Raises:
        ValueError: A joint is planar.
        DescriptionError: The file of a collision mesh cannot be used.
    """
    links = [body.dynamics(link) for link in range(BASE, body.joint_count)]
    masses = [(link.mass, link.inertia) for link in links]
    remembered = _remembered.setdefault(body, {})
    if as_pybullet not in remembered or remembered[as_pybullet][0] != masses:
        remembered[as_pybullet] = (masses, _make_nodes(body, as_pybullet))
    return remembered[as_pybullet][1]


def _make_nodes(body: Body, as_pybullet: bool) -> list[Node]:
    if JointCode.PLANAR in body.joint_types:
        raise ValueError("planar joints have no extended coordinates")
    first_link = 0 if as_pybullet and _base_is_left_out(body) else BASE
    nodes: list[Node] = []
    frames: dict[int, _Frame] = {}
    node_of: dict[int, int] = {}
    first = 0
    for link in range(first_link, body.joint_count):
        spec = body.link_spec(link)
        kind = JointCode.FIXED if link == BASE else JointCode(body.joint_types[link])
        frames[link] = frame = _joint_frame(kind, spec, as_pybullet, is_base=link == BASE)
        parent, rotation, origin = -1, np.eye(3), np.zeros(3)
        if nodes:
            parent = node_of[spec.parent]
            rotation, origin = _placement(body.link_spec(spec.parent), frames[spec.parent], spec, frame)
        count = _COORDINATES[kind] if nodes else ROOT_COORDINATES
        node_of[link] = len(nodes)
        nodes.append(
            Node(parent, kind, first, count, rotation, origin, _inertia(body, link, frame, as_pybullet))
        )
        first += count
    return nodes


def _base_is_left_out(body: Body) -> bool:
    return not body.spec.base.collisions and body.joint_count > 0 and body.joint_types[0] == JointCode.FIXED


def _joint_frame(kind: JointCode, spec: LinkSpec, as_pybullet: bool, *, is_base: bool) -> _Frame:
    if is_base:
        return _Frame(_NO_TURN, (0.0, 0.0, 0.0))
    to_inertial = conjugate(spec.inertial_frame.orientation)
    axis = rotate(to_inertial, spec.joint_axis)
    turn = _NO_TURN
    if kind == JointCode.REVOLUTE:
        turn = _shortest_turn(_Z, axis, (0.0, -1.0, 0.0, 0.0))
    elif kind == JointCode.PRISMATIC:
        turn = _SLIDER_TURN if as_pybullet else _shortest_turn(_X, axis, (0.0, 0.0, 1.0, 0.0))
    return _Frame(turn, _turned(conjugate(turn), rotate(to_inertial, spec.inertial_frame.position)))


def _placement(
    carrier: LinkSpec, carrier_frame: _Frame, spec: LinkSpec, frame: _Frame
) -> tuple[np.ndarray, np.ndarray]:
    """Rotation and origin of the joint frame of a link in the joint frame of the link that carries it."""
    joint = compose(inverse(carrier.inertial_frame), spec.joint_frame)
    at_rest = compose(joint, Pose((0.0, 0.0, 0.0), spec.inertial_frame.orientation)).orientation
    back = conjugate(carrier_frame.turn)
    rotation = _rotation_by_angles(multiplied(multiplied(back, at_rest), frame.turn))
    x, y, z = _turned(carrier_frame.turn, carrier_frame.com)
    jx, jy, jz = joint.position
    return rotation, np.array(_turned(back, (jx + x, jy + y, jz + z)))


def _inertia(body: Body, link: int, frame: _Frame, as_pybullet: bool) -> np.ndarray:
    """Spatial inertia of a link about its joint."""
    dynamics, spec = body.dynamics(link), body.link_spec(link)
    moments = dynamics.inertia
    if as_pybullet:
        implicit = bool(body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
        moments = _moments(dynamics.mass, spec.collisions, implicit)
    turn = _rotation_by_angles(conjugate(frame.turn))
    offset = skew(np.array(frame.com))
    inertia = np.zeros((6, 6))
    inertia[:3, :3] = turn @ np.diag(moments) @ turn.T + dynamics.mass * offset @ offset.T
    inertia[:3, 3:] = dynamics.mass * offset
    inertia[3:, :3] = dynamics.mass * offset.T
    inertia[3:, 3:] = dynamics.mass * np.eye(3)
    return inertia


def _moments(mass: float, collisions: tuple[Collision, ...], implicit_cylinder: bool) -> Vector3:
    """Moments of the first shape, where it is, as if it were at the centre of mass."""
    geometry = collisions[0].geometry if collisions else None
    match geometry:
        case Sphere(radius):
            moment = 0.4 * mass * radius * radius
            return (moment, moment, moment)
        case Capsule(radius, length):
            return _capsule_moments(mass, radius, length)
        case Box(half_extents):
            x, y, z = half_extents
        case None:
            x, y, z = Bounds((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)).grown(MARGIN).grown(MARGIN).half
        case _:
            x, y, z = shape_bounds(geometry, implicit_cylinder=implicit_cylinder).grown(MARGIN).half
    return (mass / 3.0 * (y * y + z * z), mass / 3.0 * (x * x + z * z), mass / 3.0 * (x * x + y * y))


def _capsule_moments(mass: float, radius: float, length: float) -> Vector3:
    """Moments of a capsule along y."""
    cylinder, half_ball = radius * radius * length, 2.0 / 3.0 * radius**3
    density = mass / (cylinder + 2.0 * half_ball)
    cylinder, half_ball = cylinder * density, half_ball * density
    across = cylinder * (radius * radius / 4.0 + length * length / 12.0) + 2.0 * half_ball * (
        0.4 * radius * radius + 0.375 * radius * length + 0.5 * length * length
    )
    return (across, (0.5 * cylinder + 0.8 * half_ball) * radius * radius, across)


def skew(v: np.ndarray) -> np.ndarray:
    """Matrices of the vector product from the left, (..., 3, 3)."""
    matrices = np.zeros((*v.shape, 3))
    matrices[..., 2, 1], matrices[..., 0, 2], matrices[..., 1, 0] = v[..., 0], v[..., 1], v[..., 2]
    return matrices - np.swapaxes(matrices, -1, -2)


def _shortest_turn(start: Vector3, end: Vector3, opposite: Quaternion) -> Quaternion:
    """The shortest rotation from one unit vector to another; `opposite` when they are opposed."""
    cosine = start[0] * end[0] + start[1] * end[1] + start[2] * end[2]
    if cosine < -1.0 + 2.220446049250313e-16:
        return opposite
    s = sqrt((1.0 + cosine) * 2.0)
    x = (start[1] * end[2] - start[2] * end[1]) / s
    y = (start[2] * end[0] - start[0] * end[2]) / s
    z = (start[0] * end[1] - start[1] * end[0]) / s
    return (x, y, z, 0.5 * s)


def _turned(q: Quaternion, v: Vector3) -> Vector3:
    """Q v q*, which also scales when the quaternion is not of unit length."""
    x, y, z, _ = multiplied(multiplied(q, (*v, 0.0)), conjugate(q))
    return (x, y, z)


def _rotation_by_angles(q: Quaternion) -> np.ndarray:
    """Rotation matrix by way of yaw, pitch and roll; the way matters when the length is not one."""
    roll, pitch, yaw = rpy_from_quaternion(q)
    sr, cr, sp, cp, sy, cy = sin(roll), cos(roll), sin(pitch), cos(pitch), sin(yaw), cos(yaw)
    return np.array(
        [
            [cp * cy, sr * sp * cy - cr * sy, cr * sp * cy + sr * sy],
            [cp * sy, sr * sp * sy + cr * cy, cr * sp * sy - sr * cy],
            [-sp, sr * cp, cr * cp],
        ]
    )
