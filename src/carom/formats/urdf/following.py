"""Joints that mimic others: which of them can."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from carom.description import Joint, JointType
from carom.description.joint import JOINT_CODE
from carom.formats.robot.context import FileContext, shown
from carom.layouts.codes import DOF_COUNT

_FREE = "the joint moves freely"


def checked_followers(context: FileContext, joints: Sequence[Joint]) -> list[Joint]:
    """The joints, without each `<mimic>` that cannot be simulated; these are reported.

    So are those that follow themselves, a joint that the file does not have, or one that has not one
    coordinate. A follower of a fixed joint is held at its offset.
    """
    by_name = {joint.name: joint for joint in joints}
    elements = list(context.root.all("joint"))
    result = []
    for joint, element in zip(joints, elements, strict=True):
        reason = None if joint.mimic is None else _problem(joint, by_name.get(joint.mimic.joint))
        if joint.mimic is not None and reason is not None:
            consequence = "none: the joint is fixed" if joint.type is JointType.FIXED else _FREE
            context.leave_out(element.first("mimic") or element, consequence, reason)
        result.append(joint if reason is None else replace(joint, mimic=None))
    return result


def _problem(follower: Joint, leader: Joint | None) -> str | None:
    """Why a joint cannot follow another; None if it can."""
    name = "" if follower.mimic is None else follower.mimic.joint
    if leader is None:
        return f"there is no joint {shown(name)}"
    if leader is follower:
        return "it follows itself"
    for joint in (follower, leader):
        if DOF_COUNT[JOINT_CODE[joint.type]] > 1:
            return f"{shown(joint.name)} is neither revolute nor prismatic"
    return "a fixed joint cannot follow" if follower.type is JointType.FIXED else None
