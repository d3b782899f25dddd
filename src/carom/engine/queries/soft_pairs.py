"""Contacts between nodes and faces of different soft bodies, as the last step left them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.soft import FACES_PER_NODE
from carom.native.products import dots, length

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from carom.model.soft_arrays import SoftArrays
    from carom.model.soft_spec import SoftRows

# Least barycentric coordinate of a foot point: as in the solver, faces extend a little beyond their edges.
_BESIDE = -0.05
_TINY = 1.0e-300


@dataclass(frozen=True, slots=True)
class PairContact:
    """A node that touches a face of another soft body.

    Attributes:
        node: Row of the node.
        own: The soft body of the node.
        other: The soft body of the face.
        foot: Foot point: the point of the face that is nearest to the node [m].
        normal: Unit normal of the face, towards the node.
        gap: Distance less the thickness, which the solver keeps between them [m].
        impulse: Impulse on the node in the last substep [N s].
    """

    node: int
    own: SoftRows
    other: SoftRows
    foot: NDArray[np.float64]
    normal: NDArray[np.float64]
    gap: float
    impulse: NDArray[np.float64]


def touching_pairs(
    soft: SoftArrays, places: NDArray[np.float64], work: Mapping[str, NDArray], nearest: float
) -> Iterator[PairContact]:
    """The nodes that touch faces of other soft bodies: up to a gap of `nearest` [m].

    `places` are the (n, 3) positions of the nodes [m]; in `work` the last step listed the faces near each.
    """
    if len(soft.bodies) < 2:
        return
    corners_of, thickness_of = (soft.table.numpy[name] for name in ("face_nodes", "soft_thickness"))
    for own in soft.bodies:
        first = own.first["node"]
        counts = work["node_faces"][0, first : first + own.count["node"]]
        for node in (np.flatnonzero(counts) + first).tolist():
            start = FACES_PER_NODE * node
            for near in range(start, start + int(work["node_faces"][0, node])):
                face = int(work["near_face"][0, near])
                other = _owner(soft, face)
                if other is None or other is own:
                    continue
                thickness = max(thickness_of[body.first["soft"]] for body in (own, other))
                side = float(work["near_side"][0, near])
                found = _foot(places[corners_of[face][:3]], places[node], side)
                if found is not None:
                    foot, normal = found
                    gap = float(dots(places[node] - foot, normal)) - thickness
                    if gap <= nearest:
                        impulse = work["near_impulse"][0, near].copy()
                        yield PairContact(node, own, other, foot, normal, gap, impulse)


def _owner(soft: SoftArrays, face: int) -> SoftRows | None:
    for body in soft.bodies:
        if body.first["face"] <= face < body.first["face"] + body.count["face"]:
            return body
    return None


def _foot(
    corners: NDArray[np.float64], point: NDArray[np.float64], side: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Foot point on a face and the unit normal towards the point; None if the foot is beside the face."""
    second, third = corners[1] - corners[0], corners[2] - corners[0]
    across = np.cross(second, third)
    square = float(dots(across, across))
    if square <= _TINY:
        return None
    offset = point - corners[0]
    v = float(dots(np.cross(offset, third), across)) / square
    w = float(dots(np.cross(second, offset), across)) / square
    if min(1.0 - v - w, v, w) < _BESIDE:
        return None
    return corners[0] + v * second + w * third, across * (side / length(across))
