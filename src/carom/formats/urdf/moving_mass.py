"""The rule for joints that move nothing with mass.

Nothing determines the acceleration of such a joint: the mass matrix is singular. MuJoCo refuses these files
as well. What would be a guess (a small mass, a fixed joint) is left to the author or to the caller.
"""

from __future__ import annotations

from collections.abc import Sequence

from carom.description import Joint, JointType, Link
from carom.formats.robot.context import FileContext, shown

_MOST_NAMES = 4


def refuse_motion_without_mass(context: FileContext, links: Sequence[Link], joints: Sequence[Joint]) -> None:
    """Raise `DescriptionError` if all links that a joint moves are without mass and moments of inertia.

    Moments alone are enough for a joint that turns.
    """
    children: list[list[Joint]] = [[] for _ in links]
    for joint in joints:
        children[joint.parent].append(joint)
    for number, joint in enumerate(joints):
        if joint.type is JointType.FIXED:
            continue
        moved = _moved(joint, children)
        turns = joint.type is not JointType.PRISMATIC
        if any(_resists(links[index], turns=turns) for index in moved):
            continue
        names = ", ".join(shown(links[index].name) for index in moved[:_MOST_NAMES])
        more = "" if len(moved) <= _MOST_NAMES else f" and {len(moved) - _MOST_NAMES} more"
        raise context.error(
            list(context.root.all("joint"))[number],
            f"it moves only links without mass ({names}{more}), so nothing determines its acceleration; give "
            "one of them an <inertial>, make the joint fixed, or load the file with default_mass, the mass "
            "in kg of links that state none",
        )


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
