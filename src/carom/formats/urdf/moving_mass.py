"""The rule for joints that move nothing with mass.

Nothing determines the acceleration of such a joint: its row of the mass matrix is zero. The solver leaves
those joints at the rate they have, which is zero at first, and no force or motor moves them; everything else
moves as if they were fixed. They can be placed, so kinematics is right. What would be a guess (a small mass)
is left to the author of the file or to the caller.
"""

from __future__ import annotations

from collections.abc import Sequence

from carom.description import Joint, JointType, Link
from carom.description.joint import SLIDES
from carom.formats.robot.context import FileContext, shown

_MAX_NAMES = 4
_CONSEQUENCE = "no force or motor moves the joint"


def report_motion_without_mass(context: FileContext, links: Sequence[Link], joints: Sequence[Joint]) -> None:
    """Report each joint that moves only links without mass and moments of inertia.

    Moments alone are enough for a joint that turns.
    """
    children: list[list[Joint]] = [[] for _ in links]
    for joint in joints:
        children[joint.parent].append(joint)
    for joint, element in zip(joints, list(context.root.all("joint")), strict=True):
        if joint.type is JointType.FIXED or joint.armature > 0.0:
            continue
        moved = _moved(joint, children)
        turns = joint.type not in SLIDES
        if any(_resists(links[index], turns=turns) for index in moved):
            continue
        names = ", ".join(shown(links[index].name) for index in moved[:_MAX_NAMES])
        more = "" if len(moved) <= _MAX_NAMES else f" and {len(moved) - _MAX_NAMES} more"
        reason = f"it moves only links without mass ({names}{more}); give one mass, or load with default_mass"
        context.leave_out(element, _CONSEQUENCE, reason)


def _moved(joint: Joint, children: Sequence[Sequence[Joint]]) -> list[int]:
    """The links that a joint moves."""
    moved, pending = [], [joint.child]
    while pending:
        link = pending.pop()
        moved.append(link)
        pending.extend(below.child for below in children[link])
    return moved


def _resists(link: Link, *, turns: bool) -> bool:
    return link.inertial.mass > 0.0 or (turns and any(link.inertial.tensor))
