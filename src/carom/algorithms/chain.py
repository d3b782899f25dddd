"""The chain of joints between the base of a body and some of its links, for `inverse_kinematics`."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.algorithms.joints import JointFrames, slide_along_z
from carom.layouts.chain import Chain, ChainSizes
from carom.layouts.codes import DOF_COUNT, POSITION_COUNT, SLIDING_JOINTS, JointCode
from carom.model.body_spec import BASE
from carom.native.tables import ArrayTable

if TYPE_CHECKING:
    from carom.scene.body import Body

# Range of random starts of a joint without limits, on both sides of 0 [rad or m].
_UNLIMITED_RANGE = {code: 1.0 if code in SLIDING_JOINTS else pi for code in JointCode}


class BodyChain:
    """The chain to some links of a body, as arrays.

    Attributes:
        arrays: The arrays of `Chain`, filled.
        sizes: The numbers of joints, ends and so on.
    """

    def __init__(self, body: Body, links: Sequence[int]) -> None:
        codes = [JointCode(code) for code in body.joint_types]
        first_coordinate = np.cumsum([0, *(POSITION_COUNT[code] for code in codes)]).tolist()
        first_dof = np.cumsum([0, *(DOF_COUNT[code] for code in codes)]).tolist()
        moving = [link for link in _ancestors(body, links) if codes[link] != JointCode.FIXED]
        self.arrays: ArrayTable = ArrayTable(Chain)
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
                is_angle_of_ball = POSITION_COUNT[code] != DOF_COUNT[code]
                chain["dof_coordinate"][first_dof[joint] + k] = (
                    -1 if is_angle_of_ball else first_coordinate[joint] + k
                )
        frames = JointFrames(body, moving)
        column = 0
        for node, link in enumerate(moving):
            chain["joint_kind"][node] = codes[link]
            carrier, frame = frames.of_joint(link)
            chain["joint_parent"][node] = carrier
            chain["joint_first_coordinate"][node] = first_coordinate[link]
            chain["joint_first_dof"][node] = first_dof[link]
            chain["joint_first_column"][node] = column
            chain["joint_origin"][node] = frame.position
            chain["joint_turn"][node] = frame.orientation
            self._write_axes(body, link, node)
            low, high = _range(body, link, codes[link])
            for k in range(DOF_COUNT[codes[link]]):
                chain["column_dof"][column] = first_dof[link] + k
                chain["column_low"][column], chain["column_high"][column] = low, high
                column += 1
        for end, link in enumerate(links):
            carrier, frame = frames.of_link(link)
            chain["end_joint"][end] = carrier
            chain["end_offset"][end] = frame.position
            chain["end_turn"][end] = frame.orientation

    def _write_axes(self, body: Body, link: int, node: int) -> None:
        model, row = body.world.arrays.model.numpy, body.first_link + 1 + link
        chain = self.arrays.numpy
        chain["joint_axis"][node] = model["link_unit_axis"][row]
        chain["joint_slide"][node] = slide_along_z(body, link)
        chain["joint_planar_axis1"][node] = model["link_planar_axis1"][row]
        chain["joint_planar_axis2"][node] = model["link_planar_axis2"][row]


def _ancestors(body: Body, links: Sequence[int]) -> list[int]:
    """The given links and all links between them and the base, parents first."""
    found = set()
    for link in links:
        while link != BASE and link not in found:
            found.add(link)
            link = body.spec.links[link].parent
    return sorted(found)


def _range(body: Body, link: int, code: JointCode) -> tuple[float, float]:
    spec = body.spec.links[link]
    if spec.limited and DOF_COUNT[code] == 1 and spec.upper - spec.lower < inf:
        return spec.lower, spec.upper
    half = _UNLIMITED_RANGE[code]
    return -half, half
