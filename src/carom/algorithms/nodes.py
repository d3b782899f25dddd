"""Bodies as mechanisms of nodes: moving joints, each with the rigid body behind it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.joints import JointFrames, node_axes
from carom.description.pose import Pose
from carom.description.transform import rotation_matrix
from carom.layouts.codes import JointCode
from carom.model.body_spec import BASE
from carom.native.products import dots, product

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


@dataclass(frozen=True, slots=True)
class Node:
    """A joint and the rigid body behind it; the first node is the base.

    Attributes:
        parent: Index of the parent node, -1 for the base.
        kind: Type of the joint; ignored for the base.
        rotation: Rotation from its frame at position 0 to the parent's, (3, 3).
        origin: Origin of its frame at position 0 in the parent's frame [m], (3,).
        mass: [kg].
        moment: Mass times centre of mass, (3,).
        inertia: Inertia about the origin of its frame, (3, 3).
        axes: Angular and linear velocity per unit rate of each dof of the joint, (dofs, 2, 3).
        armature: Inertia of the joint's drive, seen at the joint; of a free base, along and about all axes
            [kg m² or kg].
    """

    parent: int
    kind: JointCode
    rotation: np.ndarray
    origin: np.ndarray
    mass: float
    moment: np.ndarray
    inertia: np.ndarray
    axes: np.ndarray
    armature: float = 0.0


@dataclass(frozen=True, slots=True)
class End:
    """A link, to which points for Jacobians refer.

    Attributes:
        node: Index of the node that it belongs to.
        rotation: Rotation from the axes of its inertial frame to the node's, (3, 3).
        origin: Origin of its link frame, for the base its centre of mass, in the node's frame [m], (3,).
    """

    node: int
    rotation: np.ndarray
    origin: np.ndarray


def body_nodes(body: BodyCore, *, unit_axes: bool = False) -> tuple[list[Node], list[End]]:
    """The nodes of a body, parents first, and its links, the base first.

    With `unit_axes`, hinges and sliders whose axis has another length than 1 are taken as if it had that.
    """
    moving = [link for link, kind in enumerate(body.joint_types) if kind != JointCode.FIXED]
    frames = JointFrames(body, moving)
    ends: list[End] = []
    for link in range(BASE, body.joint_count):
        carrier, frame = frames.of_link(link)
        ends.append(End(1 + carrier, *_parts(frame)))
    dynamics = [body.dynamics(link) for link in range(BASE, body.joint_count)]
    of_links = np.array([each.mass for each in dynamics]), np.array([each.inertia for each in dynamics])
    masses, moments, inertias = node_inertias(body, ends, *of_links)
    at_base = (np.eye(3), np.zeros(3), masses[0], moments[0], inertias[0])
    has_armature = not (body.fixed_base or body.spec.is_held)
    of_base = np.zeros((0, 2, 3)), body.spec.base.armature if has_armature else 0.0
    nodes = [Node(BASE, JointCode.FIXED, *at_base, *of_base)]
    for index, link in enumerate(moving, start=1):
        carrier, frame = frames.of_joint(link)
        kind = JointCode(body.joint_types[link])
        rigid = (masses[index], moments[index], inertias[index])
        of_joint = node_axes(body, link, unit_axes=unit_axes), body.dynamics(link).joint_armature
        nodes.append(Node(1 + carrier, kind, *_parts(frame), *rigid, *of_joint))
    return nodes, ends


def node_inertias(
    body: BodyCore, ends: list[End], masses: np.ndarray, inertias: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mass, moment and inertia of each node, as in `Node`, for masses and inertias of the links.

    Args:
        body: The body.
        ends: Its links, the base first.
        masses: Masses of the links, the base first [kg], (..., links).
        inertias: Their principal moments [kg m²], (..., links, 3).

    Returns:
        (..., nodes), (..., nodes, 3) and (..., nodes, 3, 3).
    """
    count, own = 1 + max(end.node for end in ends), masses.shape[:-1]
    mass, moment, inertia = np.zeros((*own, count)), np.zeros((*own, count, 3)), np.zeros((*own, count, 3, 3))
    for place, end in enumerate(ends):
        com = end.origin + dots(end.rotation, _com_from_joint(body, place - 1))
        offset, of_link = skew(com), masses[..., place, None]
        mass[..., end.node] += masses[..., place]
        moment[..., end.node, :] += of_link * com
        diagonal = inertias[..., place, None, :] * np.eye(3)
        turned = product(product(end.rotation, diagonal), end.rotation.T)
        inertia[..., end.node, :, :] += turned + product(of_link[..., None] * offset, offset.T)
    return mass, moment, inertia


def _parts(frame: Pose) -> tuple[np.ndarray, np.ndarray]:
    return np.array(rotation_matrix(frame.orientation)), np.array(frame.position)


def _com_from_joint(body: BodyCore, link: int) -> np.ndarray:
    if link == BASE:
        return np.zeros(3)
    return body.world.arrays.model.numpy["link_com_from_pivot"][body.first_link + 1 + link]


def skew(v: np.ndarray) -> np.ndarray:
    """The skew-symmetric matrix with `skew(v) @ w` = v × w, (3, 3)."""
    x, y, z = v
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
