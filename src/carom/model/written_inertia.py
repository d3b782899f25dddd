"""Inertia of links as their file states it, also of links that are merged or on spherical joints."""

from __future__ import annotations

from dataclasses import replace

from carom.description import Inertial, Joint, JointType, Link, Pose
from carom.description.eigen import diagonalize
from carom.description.joint import BALL_TYPES
from carom.description.pose import IDENTITY, Vector3
from carom.description.transform import (
    NO_ROTATION,
    Matrix3,
    compose,
    dot,
    matrix_product,
    quaternion_from_matrix,
    rotation_matrix,
    transposed,
)
from carom.logger import Logger
from carom.model.tree import TreeNode, depth_first

_log = Logger(__name__)
# Off-diagonal entries of this share of the diagonal are zero; Jacobi's method gets there in a few rotations.
_PRECISION = 1e-17
_MAX_ROTATIONS = 60
# Moments that no body has are rounding if they are wrong by less than this share.
_ROUNDING = 1e-6


def written_inertia(inertial: Inertial, link_name: str) -> tuple[Vector3, Pose]:
    """Principal moments from the tensor of a link, and the inertial frame turned to its principal axes.

    The tensor is used as it is, with a warning if no body has it: a negative moment, or one that is larger
    than the sum of the others.

    Returns:
        Moments [kg m²] along the axes of the returned frame, and that frame in the link frame.
    """
    ixx, ixy, ixz, iyy, iyz, izz = inertial.tensor
    moments, axes = (ixx, iyy, izz), NO_ROTATION
    if ixy != 0.0 or ixz != 0.0 or iyz != 0.0:
        tensor = ((ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz))
        moments, axes = diagonalize(tensor, _PRECISION, _MAX_ROTATIONS)
    total = sum(moments)
    if min(moments) < -_ROUNDING * abs(total) or 2.0 * max(moments) > (1.0 + _ROUNDING) * total:
        _log.warning(
            "link %r: no body has the inertia tensor %s; it is used as it is", link_name, inertial.tensor
        )
    if axes is NO_ROTATION:
        return moments, inertial.frame
    turned = matrix_product(rotation_matrix(inertial.frame.orientation), axes)
    return moments, Pose(inertial.frame.position, quaternion_from_matrix(turned))


def has_massless_base(root: TreeNode) -> bool:
    """Whether neither the root nor any link that is fixed to it has a mass."""
    pending = [root]
    while pending:
        node = pending.pop()
        if node.link.inertial.mass > 0.0:
            return False
        pending.extend(child for child in node.children if _is_fixed(child))
    return True


def merge_rigidly(root: TreeNode, *, fixed_base: bool) -> None:
    """Merge every link on a fixed joint into its parent, in place; masses, centres and tensors add up.

    A link that the fluid sees otherwise than as the box of its inertia stays.

    The parent takes over the shapes, but not the contact parameters. Links merged into a fixed base add no
    mass. Children of a merged link take its place.
    """
    pending = [root]
    while pending:
        node = pending.pop()
        _absorb(node, without_mass=fixed_base and node is root)
        pending.extend(node.children)
    for index, node in enumerate(depth_first(root)):
        node.index = index


def _absorb(node: TreeNode, *, without_mass: bool) -> None:
    """Merge all links that are fixed to a node, directly or through others, into it."""
    children = list(reversed(node.children))
    node.children = []
    while children:
        child = children.pop()
        joint = child.joint
        if joint is None or joint.type is not JointType.FIXED or child.link.fluid is not None:
            node.children.append(child)
            continue
        own, other, frame = node.link, child.link, joint.frame
        node.link = replace(
            own,
            inertial=own.inertial if without_mass else _sum(own.inertial, other.inertial, frame),
            collisions=(
                *own.collisions,
                *(replace(it, frame=compose(frame, it.frame)) for it in other.collisions),
            ),
            visuals=(*own.visuals, *(replace(it, frame=compose(frame, it.frame)) for it in other.visuals)),
        )
        for grandchild in reversed(child.children):
            if grandchild.joint is not None:
                grandchild.joint = replace(grandchild.joint, frame=compose(frame, grandchild.joint.frame))
            children.append(grandchild)


def _sum(own: Inertial, other: Inertial, frame: Pose) -> Inertial:
    """Inertia of two links together, in the link frame of the first; `frame` is that of the second in it."""
    if other.mass == 0.0 and not any(other.tensor):
        return own
    parts = [(own.mass, own.frame, own.tensor), (other.mass, compose(frame, other.frame), other.tensor)]
    mass = own.mass + other.mass
    shares = [m / mass for m, _, _ in parts] if mass else [0.5, 0.5]
    centre = [
        sum(share * pose.position[k] for share, (_, pose, _) in zip(shares, parts, strict=True))
        for k in range(3)
    ]
    total = [[0.0] * 3 for _ in range(3)]
    for m, pose, tensor in parts:
        turned = _in_parent(tensor, pose)
        x, y, z = (pose.position[k] - centre[k] for k in range(3))
        offset = (x, y, z)
        for i in range(3):
            for j in range(3):
                parallel = (dot(offset, offset) if i == j else 0.0) - offset[i] * offset[j]
                total[i][j] += turned[i][j] + m * parallel
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = total
    position = (centre[0], centre[1], centre[2])
    return Inertial(mass, Pose(position, IDENTITY.orientation), (ixx, ixy, ixz, iyy, iyz, izz))


def _in_parent(tensor: tuple[float, float, float, float, float, float], pose: Pose) -> Matrix3:
    """A tensor in the axes of the frame in which a pose is given."""
    ixx, ixy, ixz, iyy, iyz, izz = tensor
    axes = rotation_matrix(pose.orientation)
    own = ((ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz))
    return matrix_product(matrix_product(axes, own), transposed(axes))


def _is_fixed(node: TreeNode) -> bool:
    return node.joint is not None and node.joint.type is JointType.FIXED


def hang_balls(root: TreeNode) -> None:
    """Give each spherical joint a massless link of its own where its link has other principal axes, in place.

    The engine's spherical joints turn inertial frames, as Bullet's do; in files they turn links. The link is
    then fixed to one named `LINK@JOINT`.
    """
    for node in depth_first(root):
        joint = node.joint
        if joint is None or joint.type not in BALL_TYPES or _has_own_axes(node.link):
            continue
        moved = TreeNode(node.link, node.index, children=node.children)
        moved.joint = Joint(f"{node.link.name}@fixed", JointType.FIXED, joint.child, joint.child, IDENTITY)
        node.link = Link(f"{node.link.name}@{joint.name}", Inertial(mass=0.0))
        node.children = [moved]


def _has_own_axes(link: Link) -> bool:
    """Whether the principal axes of a link are its own."""
    _, xy, xz, _, yz, _ = link.inertial.tensor
    return link.inertial.frame.orientation == IDENTITY.orientation and not any((xy, xz, yz))
