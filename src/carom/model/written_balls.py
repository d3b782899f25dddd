"""Spherical joints of robots that are read as written."""

from __future__ import annotations

from carom.description import Inertial, Joint, JointType, Link
from carom.description.pose import IDENTITY
from carom.model.tree import TreeNode, depth_first


def hang_balls(root: TreeNode) -> None:
    """Give each spherical joint a massless link of its own where its link has other principal axes, in place.

    The engine's spherical joints turn inertial frames, as Bullet's do; in files they turn links. The link is
    then fixed to one named `LINK@JOINT`.
    """
    for node in depth_first(root):
        joint = node.joint
        if joint is None or joint.type is not JointType.SPHERICAL or _has_own_axes(node.link):
            continue
        moved = TreeNode(node.link, node.index, children=node.children)
        moved.joint = Joint(f"{node.link.name}@fixed", JointType.FIXED, joint.child, joint.child, IDENTITY)
        node.link = Link(f"{node.link.name}@{joint.name}", Inertial(mass=0.0))
        node.children = [moved]


def _has_own_axes(link: Link) -> bool:
    """Whether the principal axes of a link are its own."""
    _, xy, xz, _, yz, _ = link.inertial.tensor
    return link.inertial.frame.orientation == IDENTITY.orientation and not any((xy, xz, yz))
