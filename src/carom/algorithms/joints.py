"""Joints on the host: their axes, and the frames of those that move. In kernels, `carom.kernels.joints`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.description.pose import IDENTITY, Pose, Quaternion, Vector3
from carom.description.transform import compose, conjugate, multiplied, turn_of_z
from carom.layouts.codes import JointCode
from carom.model.body_spec import BASE
from carom.native.products import dots, length

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

_NO_TURN = (0.0, 0.0, 0.0, 1.0)
# Axes whose length differs from 1 by less are rounded ones of length 1.
_UNIT = 1e-12


def _row(body: BodyCore, link: int) -> int:
    return body.first_link + 1 + link


def joint_axes(kind: JointCode, lead: float = 0.0) -> np.ndarray:
    """Velocities, angular and linear, per unit rate of a joint whose axis has length 1 and is along z.

    Args:
        kind: Its type; a planar joint has no such axes.
        lead: How far a screw goes along its axis per radian [m].

    Returns:
        (dofs, 2, 3); a fixed joint has none.
    """
    axes = np.zeros((3 if kind == JointCode.SPHERICAL else 1, 2, 3))
    match kind:
        case JointCode.REVOLUTE:
            axes[0, 0, 2] = 1.0
        case JointCode.PRISMATIC:
            axes[0, 1, 2] = 1.0
        case JointCode.SPHERICAL:
            axes[:, 0, :] = np.eye(3)
        case JointCode.SCREW:
            axes[0, :, 2] = 1.0, lead
        case _:
            return axes[:0]
    return axes


def node_axes(body: BodyCore, link: int, *, unit_axes: bool = False) -> np.ndarray:
    """The same of a joint of a body in the frame of its node, whose z axis is that of a single dof.

    With `unit_axes`, a hinge or slider whose axis has another length than 1 is taken as if it had that.
    """
    kind = JointCode(body.joint_types[link])
    model, row = body.world.arrays.model.numpy, _row(body, link)
    match kind:
        case JointCode.SPHERICAL:
            return joint_axes(kind)
        case JointCode.PLANAR:
            return link_axes(body, link)
        case JointCode.SCREW:
            return joint_axes(kind, screw_lead(body, link))
        case _:
            if unit_axes and has_long_axis(body, link):
                return joint_axes(kind)
            return joint_axes(kind) * length(model["link_axis"][row])


def link_axes(body: BodyCore, link: int) -> np.ndarray:
    """The same of a joint of a body along the axes of its link's inertial frame, (dofs, 2, 3)."""
    kind = JointCode(body.joint_types[link])
    model, row, none = body.world.arrays.model.numpy, _row(body, link), np.zeros(3)
    axis, slide = model["link_axis"][row], model["link_planar_axis1"][row]
    match kind:
        case JointCode.REVOLUTE:
            return np.array([(axis, none)])
        case JointCode.PRISMATIC:
            return np.array([(none, axis)])
        case JointCode.PLANAR:
            return np.array([(axis, none), (none, slide), (none, model["link_planar_axis2"][row])])
        case JointCode.SCREW:
            return np.array([(axis, slide)])
        case _:
            return joint_axes(kind)


def screw_lead(body: BodyCore, link: int) -> float:
    """How far a link goes along the axis of its joint per radian, if that is a screw [m]; otherwise 0."""
    if body.joint_types[link] != JointCode.SCREW:
        return 0.0
    model, row = body.world.arrays.model.numpy, _row(body, link)
    return float(dots(model["link_planar_axis1"][row], model["link_unit_axis"][row]))


def slide_along_z(body: BodyCore, link: int) -> float:
    """How far a link goes along z of its node per unit of the position of a slider or screw."""
    if body.joint_types[link] == JointCode.SCREW:
        return screw_lead(body, link)
    return length(body.world.arrays.model.numpy["link_axis"][_row(body, link)])


def has_long_axis(body: BodyCore, link: int) -> bool:
    """Whether a joint is a hinge or slider whose axis is longer or shorter than 1."""
    if body.joint_types[link] not in (JointCode.REVOLUTE, JointCode.PRISMATIC):
        return False
    return abs(length(body.world.arrays.model.numpy["link_axis"][_row(body, link)]) - 1.0) > _UNIT


def vector_of(row: np.ndarray) -> Vector3:
    """A row of three numbers as a tuple."""
    x, y, z = row.tolist()
    return x, y, z


class JointFrames:
    """Poses of joints and links, at position 0, in the frames of their parent joints.

    Links that are fixed to each other are merged. The origin of a frame is at the joint. For hinges and
    sliders its z axis is the joint axis; for other joints it has the axes of the link's inertial frame. The
    frame of the base is its inertial frame.

    Joints of the links in `moving`, parents first, count as moving.
    """

    def __init__(self, body: BodyCore, moving: Sequence[int]) -> None:
        self._body = body
        self._model = body.world.arrays.model.numpy
        self._place_of = {link: place for place, link in enumerate(moving)}
        self._turns = {link: self._turn_of_axis(link) for link in moving}

    def of_joint(self, link: int) -> tuple[int, Pose]:
        """Index of the moving link that carries a joint (-1: base), and the joint's frame in that link's."""
        carrier, frame = self._seen(*self._placement(link, moves=True))
        turned = multiplied(frame.orientation, self._turns[link])
        return self._place(carrier), Pose(frame.position, turned)

    def of_link(self, link: int) -> tuple[int, Pose]:
        """The same for the frame at a link's joint with the axes of its inertial frame; -1 is the base."""
        carrier, frame = self._seen(*self._placement(link, moves=False))
        return self._place(carrier), frame

    def _place(self, carrier: int) -> int:
        return BASE if carrier == BASE else self._place_of[carrier]

    def _seen(self, carrier: int, frame: Pose) -> tuple[int, Pose]:
        """Convert a frame from the inertial axes of its parent to the parent's frame."""
        if carrier == BASE:
            return carrier, frame
        return carrier, compose(Pose(orientation=conjugate(self._turns[carrier])), frame)

    def _placement(self, link: int, *, moves: bool) -> tuple[int, Pose]:
        """The parent link of a joint, or the link itself, and the frame at that link's joint."""
        frame = IDENTITY
        if not moves and link in self._place_of:
            return link, frame
        while link != BASE:
            row = self._row(link)
            pivot = _vector(self._model["link_pivot_in_parent"][row])
            frame = compose(Pose(pivot, _turn(self._model["link_joint_rotation"][row])), frame)
            link = self._body.spec.links[link].parent
            if link == BASE:
                break
            frame = compose(Pose(_vector(self._model["link_com_from_pivot"][self._row(link)])), frame)
            if link in self._place_of:
                return link, frame
        return BASE, frame

    def _turn_of_axis(self, link: int) -> Quaternion:
        """The rotation from z to the axis of a hinge or slider, in the inertial frame of its link."""
        if self._body.velocity_count[link] != 1:
            return _NO_TURN
        return turn_of_z(_vector(self._model["link_unit_axis"][self._row(link)]))

    def _row(self, link: int) -> int:
        return self._body.first_link + 1 + link


def _vector(row: np.ndarray) -> Vector3:
    x, y, z = row.tolist()
    return (x, y, z)


def _turn(row: np.ndarray) -> Quaternion:
    x, y, z, w = row.tolist()
    return (x, y, z, w)
