"""URDF_MERGE_FIXED_LINKS: merging links on fixed joints into their parents."""

from __future__ import annotations

from dataclasses import replace

from carom.description import Inertial, Joint, JointType, Pose
from carom.description.eigen import diagonalize
from carom.description.pose import IDENTITY
from carom.description.transform import compose, dot
from carom.model.tree import TreeNode


def merge_fixed_links(root: TreeNode, *, fixed_base: bool) -> None:
    """Merges every link on a fixed joint into its parent, in place, and renumbers the nodes.

    The rules are PyBullet's, so that masses and link order agree. The parent takes over the shapes, but not
    the contact parameters. Inertial frames in the file are ignored: masses are added as if each centre of
    mass lay at the origin of its link, and tensors as if the axes of all links were parallel. The last child
    takes the place of a merged one. Links merged into a fixed base add no mass.
    """
    pending = [root]
    while pending:
        node = pending.pop()
        is_static = node is root and (fixed_base or root.link.inertial.mass == 0.0)
        _merge_children(node, is_static)
        pending.extend(node.children)
    _number(root)


def _merge_children(node: TreeNode, is_static: bool) -> None:
    inertial = replace(node.link.inertial, frame=IDENTITY)
    collisions = list(node.link.collisions)
    visuals = list(node.link.visuals)
    is_merged = False
    i = 0
    while i < len(node.children):
        child = node.children[i]
        joint = child.joint
        if joint is None or joint.type is not JointType.FIXED:
            i += 1
            continue
        is_merged = True
        frame = joint.frame
        if not is_static:
            inertial = _joined(inertial, child.link.inertial, frame)
        collisions += [replace(it, frame=compose(frame, it.frame)) for it in child.link.collisions]
        visuals += [replace(it, frame=compose(frame, it.frame)) for it in child.link.visuals]
        last = node.children.pop()
        if last is not child:
            node.children[i] = last
        for grandchild in child.children:
            grandchild.joint = _moved(grandchild.joint, frame)
            node.children.append(grandchild)
    if is_merged:
        node.link = replace(
            node.link, inertial=inertial, collisions=tuple(collisions), visuals=tuple(visuals)
        )


def _moved(joint: Joint | None, frame: Pose) -> Joint | None:
    return None if joint is None else replace(joint, frame=compose(frame, joint.frame))


def _joined(own: Inertial, merged: Inertial, frame: Pose) -> Inertial:
    """Mass and principal moments of two bodies together; the second is at the origin of `frame`."""
    mass = own.mass + merged.mass
    if mass == 0.0:
        return own
    bodies = ((own.mass, own.frame, own.tensor), (merged.mass, frame, merged.tensor))
    x, y, z = (sum(m * pose.position[k] for m, pose, _ in bodies) / mass for k in range(3))
    total = [[0.0] * 3 for _ in range(3)]
    for m, pose, (ixx, ixy, ixz, iyy, iyz, izz) in bodies:
        tensor = ((ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz))
        offset = (pose.position[0] - x, pose.position[1] - y, pose.position[2] - z)
        for i in range(3):
            for j in range(3):
                parallel = (dot(offset, offset) if i == j else 0.0) - offset[i] * offset[j]
                total[i][j] += tensor[i][j] + m * parallel
    rows = ((total[0][0], total[0][1], total[0][2]), (total[1][0], total[1][1], total[1][2]))
    (a, b, c), _ = diagonalize((*rows, (total[2][0], total[2][1], total[2][2])), 1e-5, 20)
    return Inertial(mass, Pose((x, y, z)), (a, 0.0, 0.0, b, 0.0, c))


def _number(root: TreeNode) -> None:
    """Numbers the children of a node consecutively, before their own children."""
    root.index = 0
    count = 1
    pending = [root]
    while pending:
        node = pending.pop()
        for child in node.children:
            child.index = count
            count += 1
        pending.extend(reversed(node.children))
