"""The chain of joints between the base of a body and some of its links, for `inverse_kinematics`."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.algorithms.reach.structs import Chain, ChainSizes
from carom.description.pose import IDENTITY, Pose, Quaternion, Vector3
from carom.description.transform import compose, conjugate, multiplied, turn_of_z
from carom.model.arrays import ArrayTable
from carom.model.body_spec import BASE
from carom.model.codes import DOF_COUNT, POSITION_COUNT, JointCode

if TYPE_CHECKING:
    from carom.body import Body

_NO_TURN = (0.0, 0.0, 0.0, 1.0)
# Of an unlimited joint: the range that new starts are drawn from, either way from 0 [rad or m].
_UNLIMITED_RANGE = {JointCode.PRISMATIC: 1.0}


class BodyChain:
    """The chain to some links of a body, as arrays.

    Attributes:
        arrays: `Chain`, filled.
        sizes: How many of everything there are.
    """

    def __init__(self, body: Body, links: Sequence[int]) -> None:
        codes = [JointCode(code) for code in body.joint_types]
        first_coordinate = np.cumsum([0, *(POSITION_COUNT[code] for code in codes)]).tolist()
        first_dof = np.cumsum([0, *(DOF_COUNT[code] for code in codes)]).tolist()
        moving = [link for link in _ancestors(body, links) if codes[link] != JointCode.FIXED]
        self.arrays = ArrayTable(Chain, None)
        self.sizes: Any = ChainSizes()
        self.sizes.joints = len(moving)
        self.sizes.ends = len(links)
        self.sizes.columns = sum(DOF_COUNT[codes[link]] for link in moving)
        self.sizes.dofs = first_dof[-1]
        self.sizes.coordinates = first_coordinate[-1]
        self.arrays.reserve(
            {
                "joint": len(moving),
                "end": len(links),
                "column": self.sizes.columns,
                "dof": self.sizes.dofs,
            }
        )
        chain = self.arrays.numpy
        for joint, code in enumerate(codes):
            for k in range(DOF_COUNT[code]):
                is_angle_of_ball = code == JointCode.SPHERICAL
                chain["dof_coordinate"][first_dof[joint] + k] = (
                    -1 if is_angle_of_ball else first_coordinate[joint] + k
                )
        self._turns: list[Quaternion] = []
        node_of = {link: node for node, link in enumerate(moving)}
        column = 0
        for node, link in enumerate(moving):
            carrier, frame = self._seen(*_placement(body, link, node_of, moves=True))
            turn = _turn_of_axis(body, link, codes[link])
            self._turns.append(turn)
            chain["joint_kind"][node] = codes[link]
            chain["joint_parent"][node] = carrier
            chain["joint_first_coordinate"][node] = first_coordinate[link]
            chain["joint_first_dof"][node] = first_dof[link]
            chain["joint_first_column"][node] = column
            chain["joint_origin"][node] = frame.position
            chain["joint_turn"][node] = multiplied(frame.orientation, turn)
            self._write_axes(body, link, node)
            low, high = _range(body, link, codes[link])
            for k in range(DOF_COUNT[codes[link]]):
                chain["column_dof"][column] = first_dof[link] + k
                chain["column_low"][column], chain["column_high"][column] = low, high
                column += 1
        for end, link in enumerate(links):
            carrier, frame = self._seen(*_placement(body, link, node_of, moves=False))
            chain["end_joint"][end] = carrier
            chain["end_offset"][end] = frame.position
            chain["end_turn"][end] = frame.orientation

    def _seen(self, carrier: int, frame: Pose) -> tuple[int, Pose]:
        """A frame on a joint of the chain, seen from the frame whose z axis is that of the joint."""
        if carrier == BASE:
            return carrier, frame
        return carrier, compose(Pose(orientation=conjugate(self._turns[carrier])), frame)

    def _write_axes(self, body: Body, link: int, node: int) -> None:
        model, row = body.world.arrays.model.numpy, body.first_link + 1 + link
        chain = self.arrays.numpy
        chain["joint_axis"][node] = model["link_unit_axis"][row]
        chain["joint_slide"][node] = np.linalg.norm(model["link_axis"][row])
        chain["joint_planar_axis1"][node] = model["link_planar_axis1"][row]
        chain["joint_planar_axis2"][node] = model["link_planar_axis2"][row]


def _ancestors(body: Body, links: Sequence[int]) -> list[int]:
    """The links on the way from the base to the given ones, these included, parents first."""
    found = set()
    for link in links:
        while link != BASE and link not in found:
            found.add(link)
            link = body.spec.links[link].parent
    return sorted(found)


def _placement(body: Body, link: int, node_of: dict[int, int], *, moves: bool) -> tuple[int, Pose]:
    """Where a joint or an end is at position 0.

    Args:
        body: The body.
        link: The link whose joint it is, or which is the end.
        node_of: Place in the chain of the links that move.
        moves: The joint is meant, not the link it carries.

    Returns:
        The joint of the chain that carries it, -1 for the base, and its frame in that joint's.
    """
    frame = IDENTITY
    if not moves and link in node_of:
        return node_of[link], frame
    model = body.world.arrays.model.numpy
    while link != BASE:
        row = body.first_link + 1 + link
        at_joint = Pose(_vector(model["link_pivot_in_parent"][row]), _turn(model["link_joint_rotation"][row]))
        frame = compose(at_joint, frame)
        link = body.spec.links[link].parent
        if link == BASE:
            break
        frame = compose(Pose(_vector(model["link_com_from_pivot"][body.first_link + 1 + link])), frame)
        if link in node_of:
            return node_of[link], frame
    return BASE, frame


def _turn_of_axis(body: Body, link: int, code: JointCode) -> Quaternion:
    """The turn that takes z to the axis of a hinge or slider, in the frame of its link."""
    if code not in (JointCode.REVOLUTE, JointCode.PRISMATIC):
        return _NO_TURN
    return turn_of_z(_vector(body.world.arrays.model.numpy["link_unit_axis"][body.first_link + 1 + link]))


def _range(body: Body, link: int, code: JointCode) -> tuple[float, float]:
    spec = body.spec.links[link]
    if spec.limited and code in (JointCode.REVOLUTE, JointCode.PRISMATIC) and spec.upper - spec.lower < inf:
        return spec.lower, spec.upper
    half = _UNLIMITED_RANGE.get(code, pi)
    return -half, half


def _vector(row: np.ndarray) -> Vector3:
    x, y, z = row.tolist()
    return (x, y, z)


def _turn(row: np.ndarray) -> Quaternion:
    x, y, z, w = row.tolist()
    return (x, y, z, w)
