"""Frames of the moving joints of a body, with links that are fixed to each other merged.

The origin of a frame is at the joint. For hinges and sliders its z axis is the joint axis; for other joints
it has the axes of the link's inertial frame. The frame of the base is its inertial frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.description.pose import IDENTITY, Pose, Quaternion, Vector3
from carom.description.transform import compose, conjugate, multiplied, turn_of_z
from carom.model.body_spec import BASE

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

_NO_TURN = (0.0, 0.0, 0.0, 1.0)


class JointFrames:
    """Poses of joints and links, at position 0, in the frames of their parent joints.

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
