"""Joints that close loops of links, as constraints."""

from __future__ import annotations

from carom.description import JointLimit
from carom.description.joint import BALL_TYPES, SLIDES
from carom.formats.usd.joints import UsdJoint
from carom.formats.usd.scene import Loop
from carom.formats.usd.stage import Stage
from carom.formats.usd.tree import Tree

_APART = 0.05
"""Distance from the frame of a hinge of the two points on its axis that coincide [m]."""


def read_loops(stage: Stage, tree: Tree) -> list[Loop]:
    """The joints that close loops: fixed ones, balls and hinges; others are reported and left out."""
    found = []
    for joint in tree.loops:
        loop = _loop(stage, tree, joint)
        if loop is None:
            stage.leave_out(
                joint.prim, "it does not close the loop", "only fixed joints, hinges and balls do"
            )
        else:
            found.append(loop)
    return found


def _loop(stage: Stage, tree: Tree, joint: UsdJoint) -> Loop | None:
    first, second = (tree.names[end.part.path] if end.part is not None else "" for end in joint.ends)
    frames = (joint.ends[0].frame, joint.ends[1].frame)
    name = stage.name_of(joint.prim)
    if not joint.motions:
        return Loop(name, (first, second), frames)
    motion = joint.motions[0]
    if len(joint.motions) > 1 or motion.type in SLIDES:
        return None
    limit = JointLimit() if motion.type in BALL_TYPES else motion.limit
    if motion.drive is not None or (limit.lower <= limit.upper and limit.upper - limit.lower < float("inf")):
        stage.leave_out(joint.prim, "it has no limit and no drive", "joints that close loops are constraints")
    if motion.type in BALL_TYPES:
        return Loop(name, (first, second), frames, (0.0,))
    return Loop(name, (first, second), frames, (-_APART, _APART), motion.axis)
