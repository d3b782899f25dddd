"""`floating` joints of files that are read as written."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from carom.description import Joint, JointType, Link
from carom.description.pose import IDENTITY
from carom.formats.robot.context import FileContext


def with_free_root(
    context: FileContext, links: Sequence[Link], joints: Sequence[Joint], root: int
) -> tuple[list[Link], list[Joint], int]:
    """Links, joints and root of a robot without floating joints.

    A root that only stands for the world, with nothing but one floating joint, is left out: the link on the
    joint is the base then, which is free unless the file is loaded with a fixed base. Other floating joints
    are reported, and fixed.
    """
    kept = list(joints)
    for place, (joint, element) in enumerate(zip(joints, context.root.all("joint"), strict=True)):
        if joint.type is not JointType.FLOATING:
            continue
        if _is_of_the_world(links[root], joints, joint, root):
            fewer = [
                replace(it, parent=_after(it.parent, root), child=_after(it.child, root)) for it in joints
            ]
            del fewer[place]
            return [*links[:root], *links[root + 1 :]], fewer, _after(joint.child, root)
        reason = "only those between the world and a robot are built"
        context.leave_out(element, "it is fixed", reason, "type")
        kept[place] = replace(joint, type=JointType.FIXED)
    return list(links), kept, root


def _is_of_the_world(root: Link, joints: Sequence[Joint], joint: Joint, index: int) -> bool:
    """Whether a joint frees all of a robot from a root that stands for the world."""
    is_empty = root.inertial.mass == 0.0 and not (root.collisions or root.visuals)
    return is_empty and [it for it in joints if it.parent == index] == [joint] and joint.frame == IDENTITY


def _after(index: int, removed: int) -> int:
    """The index of a link after that of another was removed."""
    return index - (index > removed)
