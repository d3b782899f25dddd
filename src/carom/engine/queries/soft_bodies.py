"""Collision queries of soft bodies: faces hit by rays, contacts of nodes and faces, bounds."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.engine.queries.contact_search import ContactColumns
from carom.engine.queries.ray_cast import Points, RayTuple
from carom.engine.queries.soft_pairs import touching_pairs
from carom.layouts.soft import TOUCHES_PER_FACE, TOUCHES_PER_NODE
from carom.native.kernels import find_touches_kernel
from carom.native.launch import KernelStructs, Launch
from carom.native.made_once import made_once
from carom.native.products import dots, length
from carom.native.tables import ArrayTable

if TYPE_CHECKING:
    from carom.engine.contact_arrays import ContactArrays
    from carom.engine.queries.present_poses import PresentPoses
    from carom.model.soft_spec import SoftRows

# Point of the soft body [m], shape, gap beyond the margin [m], unit normal towards the soft body, force on it
# [N].
_Touch = tuple[np.ndarray, int, float, np.ndarray, np.ndarray]
_NOTHING: RayTuple = (-1, -1, 1.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
_BASE = -1
# The collision group of rays, for the masks of shapes.
_RAY_GROUP = 1
# A node counts as touching up to this gap beyond its margin [m].
_GAP = 1.0e-4
# What belongs to the impulses of the last substep on faces.
_OF_LAST_SUBSTEP = ("node_touches", "face_touches", "touch_shape", "touch_weights")
# Forces up to this are rounding errors [N].
_ROUNDING = 1.0e-9
# Number of ray-face pairs handled at a time, to save memory.
_CHUNK = 1 << 20
_TINY = 1.0e-300


class SoftQueries:
    """The collision queries of the soft bodies of a world; `places` are body and link of each link row."""

    def __init__(
        self,
        structs: KernelStructs,
        contact_arrays: ContactArrays,
        state: ArrayTable,
        work: ArrayTable,
        places: Sequence[tuple[int, int]],
        present_poses: PresentPoses,
    ) -> None:
        self._structs = structs
        self._soft = contact_arrays.soft
        self._shapes = contact_arrays.shapes.table.numpy
        self._state = state.numpy
        self._work = work.numpy
        self._places = places
        self._present_poses = present_poses

    @made_once
    def _find_touches(self) -> Launch:
        return self._structs.launch(find_touches_kernel, world=0)

    def _link_row(self, soft: SoftRows) -> int:
        return soft.rows.first["link"]

    def _nodes(self, soft: SoftRows) -> slice:
        return slice(soft.first["node"], soft.first["node"] + soft.count["node"])

    # Rays

    def cast(self, starts: Points, ends: Points, mask: int) -> list[list[RayTuple]]:
        """All hits of each ray on faces of soft bodies, the nearest first; points are (n, 3), world axes [m].

        Cloth is hit from both sides, solids from outside only. As with shapes, a ray that starts inside a
        solid does not hit it. `mask` is that of the collision groups that are hit.
        """
        start = np.asarray(starts, dtype=np.float64).reshape(-1, 3)
        way = np.asarray(ends, dtype=np.float64).reshape(-1, 3) - start
        hits: list[list[RayTuple]] = [[] for _ in range(len(start))]
        for soft in self._soft.bodies:
            link = self._link_row(soft)
            if not (self._shapes["link_group"][link] & mask and self._shapes["link_mask"][link] & _RAY_GROUP):
                continue
            nodes = self._state["node_position"][0, self._nodes(soft)]
            near = np.flatnonzero(_meets_box(start, way, nodes.min(axis=0), nodes.max(axis=0)))
            corners = nodes[soft.spec.faces]
            size = max(1, _CHUNK // max(1, len(corners)))
            for at in range(0, len(near), size):
                rays = near[at : at + size]
                found = _crossings(start[rays], way[rays], corners, both_sides=not len(soft.spec.tetras))
                for ray, fraction, normal in zip(*found, strict=True):
                    number = int(rays[ray])
                    x, y, z = (start[number] + fraction * way[number]).tolist()
                    nx, ny, nz = normal.tolist()
                    hits[number].append(
                        (self._places[link][0], _BASE, float(fraction), (x, y, z), (nx, ny, nz))
                    )
        for of_ray in hits:
            of_ray.sort(key=lambda hit: hit[2])
        return hits

    # Contacts

    def contacts(
        self, body_a: int, link_a: int, body_b: int, link_b: int, time_step: float
    ) -> ContactColumns:
        """The contacts of nodes and faces with shapes, and of nodes with other soft bodies.

        For the arguments see `Queries.contacts`. Body a is the soft body that the node or face belongs to,
        unless the query names the other body as `body_a`. The distance of a contact is that from the surface
        minus the margin, or minus the thickness if the surface is that of a soft body. The forces are those
        of the last substep.
        """
        kept = {name: self._work[name][0].copy() for name in _OF_LAST_SUBSTEP}
        with self._present_poses:
            self._find_touches()
        same_shape = kept["touch_shape"] == self._work["touch_shape"][0]
        pushes = self._pushes_on_nodes(kept, same_shape, time_step)
        rows: list[tuple[Any, ...]] = []
        for soft in self._soft.bodies:
            own = self._places[self._link_row(soft)][0]
            touches = chain(self._touches(soft, pushes), self._face_touches(soft, same_shape, time_step))
            for place, shape, distance, normal, force in touches:
                other, link = self._places[int(self._shapes["shape_link"][shape])]
                on_b = place - (distance + soft.spec.margin) * normal
                sides = _sides((own, _BASE), (other, link), body_a, link_a, body_b, link_b)
                if sides is not None:
                    rows.append(_row(sides, place, on_b, normal, distance, force))
        # The next query needs them as well, to make out whose the impulses are.
        for name, values in kept.items():
            self._work[name][0] = values
        places = self._state["node_position"][0]
        for pair in touching_pairs(self._soft, places, self._work, _GAP):
            own, other = (self._places[self._link_row(soft)] for soft in (pair.own, pair.other))
            sides = _sides(own, other, body_a, link_a, body_b, link_b)
            if sides is not None:
                force = pair.impulse / time_step
                rows.append(_row(sides, places[pair.node], pair.foot, pair.normal, pair.gap, force))
        return ContactColumns(len(rows), tuple(zip(*rows, strict=True)))

    def _pushes_on_nodes(
        self, last: dict[str, np.ndarray], same_shape: np.ndarray, time_step: float
    ) -> np.ndarray:
        """(n, 3) forces on nodes [N], without their shares of those on faces that are listed themselves.

        `last` has the touches of the last substep. The shares stay where a face has no such touch any more,
        and in scenes of `Worlds`, where the workspace of the last substep is not there.
        """
        work = self._work
        pushes = self._state["node_push"][0].copy()
        behind_nodes = TOUCHES_PER_NODE * len(last["node_touches"])
        for soft in self._soft.bodies:
            first = soft.first["face"]
            faces = slice(first, first + soft.count["face"])
            counts = np.minimum(work["face_touches"][0, faces], last["face_touches"][faces])
            for face in np.flatnonzero(counts).tolist():
                start = behind_nodes + TOUCHES_PER_FACE * (first + face)
                corners = soft.spec.faces[face] + soft.first["node"]
                for touch in range(start, start + int(counts[face])):
                    if same_shape[touch]:
                        force = work["touch_impulse"][0, touch] / time_step
                        pushes[corners] -= _shares(last, corners, touch)[:, None] * force
        # What is left of a force that was all on faces is rounding.
        pushes[np.abs(pushes).max(axis=1) < _ROUNDING] = 0.0
        return pushes

    def _touches(self, soft: SoftRows, pushes: np.ndarray) -> list[_Touch]:
        """Contacts of the nodes of a soft body with shapes."""
        work, found = self._work, []
        nodes = self._nodes(soft)
        touching = np.flatnonzero(work["node_touches"][0, nodes]) + nodes.start
        for node in touching.tolist():
            first = TOUCHES_PER_NODE * node
            rows = slice(first, first + int(work["node_touches"][0, node]))
            gaps = work["touch_offset"][0, rows] - soft.spec.margin
            normals = work["touch_normal"][0, rows]
            push = pushes[node]
            along = dots(normals, push)
            # If a node touches several shapes, the one whose normal is closest to the force gets all of it.
            strongest = int(along.argmax())
            for touch, gap in enumerate(gaps.tolist()):
                force = push if touch == strongest and along[strongest] > 0.0 else np.zeros(3)
                if gap <= _GAP or force.any():
                    shape = int(work["touch_shape"][0, first + touch])
                    place = self._state["node_position"][0, node]
                    found.append((place, shape, gap, normals[touch].copy(), force))
        return found

    def _face_touches(self, soft: SoftRows, same_shape: np.ndarray, time_step: float) -> list[_Touch]:
        """Contacts of the faces of a soft body with shapes.

        `same_shape` tells of each touch whether it is with the same shape as in the last substep, whose
        impulse is still there.
        """
        work, found = self._work, []
        first = soft.first["face"]
        counts = work["face_touches"][0, first : first + soft.count["face"]]
        behind_nodes = TOUCHES_PER_NODE * work["node_touches"].shape[1]
        for face in np.flatnonzero(counts).tolist():
            start = behind_nodes + TOUCHES_PER_FACE * (first + face)
            corners = self._state["node_position"][0, self._nodes(soft)][soft.spec.faces[face]]
            for touch in range(start, start + int(counts[face])):
                gap = float(work["touch_offset"][0, touch]) - soft.spec.margin
                force = work["touch_impulse"][0, touch] * (same_shape[touch] / time_step)
                if gap <= _GAP or force.any():
                    place = (work["touch_weights"][0, touch][:, None] * corners).sum(axis=0)
                    shape = int(work["touch_shape"][0, touch])
                    found.append((place, shape, gap, work["touch_normal"][0, touch].copy(), force))
        return found

    # Bounds

    def overlapping(self, lower: Sequence[float], upper: Sequence[float]) -> list[int]:
        """Link rows of the soft bodies whose bounds, including margins, overlap a box."""
        found = []
        for soft in self._soft.bodies:
            nodes, margin = self._state["node_position"][0, self._nodes(soft)], soft.spec.margin
            if (nodes.min(axis=0) - margin <= upper).all() and (nodes.max(axis=0) + margin >= lower).all():
                found.append(self._link_row(soft))
        return found


def _shares(last: dict[str, np.ndarray], corners: np.ndarray, touch: int) -> np.ndarray:
    """(3,) shares of the force of a touch of a face: `shares_of_corners` in `kernels.soft.feedback`."""
    weights, shape = last["touch_weights"][touch], last["touch_shape"][touch]
    firsts, counts = TOUCHES_PER_NODE * corners, last["node_touches"][corners]
    touching = [
        shape in last["touch_shape"][first : first + count]
        for first, count in zip(firsts.tolist(), counts.tolist(), strict=True)
    ]
    shares = np.where(touching, weights, 0.0)
    return shares / shares.sum() if shares.sum() > 0.0 else weights


def nth_hit(rigid: Sequence[RayTuple], soft: Sequence[RayTuple], number: int, separation: float) -> RayTuple:
    """The n-th hit of a ray, counted from 0.

    Args:
        rigid: The first n + 1 hits on shapes, nearest first; those without a hit have body -1.
        soft: All hits on soft bodies, nearest first.
        number: The number n.
        separation: After a hit, further hits on the same soft body within this fraction of the ray are
            ignored.
    """
    last: dict[int, float] = {}
    hits = [hit for hit in rigid if hit[0] >= 0]
    for hit in soft:
        if hit[0] not in last or hit[2] > last[hit[0]] + max(separation, 0.0):
            hits.append(hit)
            last[hit[0]] = hit[2]
    hits.sort(key=lambda hit: hit[2])
    return hits[number] if number < len(hits) else _NOTHING


def _meets_box(start: np.ndarray, way: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """Whether each ray crosses a box (slab test)."""
    # A ray parallel to a slab never crosses its planes: it starts inside the slab, or it misses the box.
    step = np.where(np.abs(way) < _TINY, _TINY, way)
    with np.errstate(over="ignore"):
        enters, leaves = (lower - start) / step, (upper - start) / step
    first, last = np.minimum(enters, leaves).max(axis=1), np.maximum(enters, leaves).min(axis=1)
    return (first <= last) & (last >= 0.0) & (first <= 1.0)


def _crossings(
    start: np.ndarray, way: np.ndarray, corners: np.ndarray, *, both_sides: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Intersections of rays with triangles (Möller and Trumbore, 1997).

    Returns:
        (k,) indices of rays; (k,) fractions; (k, 3) unit normals on the side the ray comes from.
    """
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    cross = np.cross(way[:, None], second[None])
    determinant = (first[None] * cross).sum(axis=2)
    # The determinant is positive where a ray hits the front side of a face.
    usable = np.abs(determinant) > _TINY if both_sides else determinant > _TINY
    scale = 1.0 / np.where(usable, determinant, 1.0)
    offset = start[:, None] - corners[None, :, 0]
    u = (offset * cross).sum(axis=2) * scale
    turned = np.cross(offset, first[None])
    v = (way[:, None] * turned).sum(axis=2) * scale
    fraction = (second[None] * turned).sum(axis=2) * scale
    hit = usable & (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (fraction >= 0.0) & (fraction <= 1.0)
    ray, face = np.nonzero(hit)
    normal = np.cross(first, second)[face]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    normal *= np.where(determinant[ray, face] > 0.0, 1.0, -1.0)[:, None]
    return ray, fraction[ray, face], normal


_Place = tuple[int, int]


def _sides(
    own: _Place, other: _Place, body_a: int, link_a: int, body_b: int, link_b: int
) -> tuple[_Place, _Place, float] | None:
    """Bodies a and b with their links, and -1 if exchanged, else 1; None if the query excludes them."""
    a, b, sign = own, other, 1.0
    if body_a >= 0 and body_a == other[0] and body_a != own[0]:
        a, b, sign = b, a, -1.0
    if _is_other(a, body_a, link_a) or _is_other(b, body_b, link_b):
        return None
    return a, b, sign


def _row(
    sides: tuple[_Place, _Place, float],
    node: np.ndarray,
    foot: np.ndarray,
    normal: np.ndarray,
    distance: float,
    force: np.ndarray,
) -> tuple[Any, ...]:
    """The entries of `ContactColumns` for a contact of a node with a surface; `force` acts on the node."""
    a, b, sign = sides
    on_a, on_b = (node, foot) if sign > 0.0 else (foot, node)
    along = float(dots(force, normal))
    friction = force - along * normal
    size = length(friction)
    first = friction / size if size > 0.0 else _across(normal)
    second = np.cross(normal, first)
    return (
        a[0], b[0], a[1], b[1], _tuple(on_a), _tuple(on_b), _tuple(sign * normal), distance,
        along, size, _tuple(sign * first), 0.0, _tuple(sign * second),
    )  # fmt: skip


def _is_other(place: tuple[int, int], body: int, link: int) -> bool:
    """Whether a body and link do not match a query; a negative body or a link below -1 matches any."""
    return (body >= 0 and place[0] != body) or (link >= _BASE and place[1] != link)


def _across(normal: np.ndarray) -> np.ndarray:
    """A unit vector perpendicular to a vector."""
    aside = np.eye(3)[int(np.abs(normal).argmin())]
    across = np.cross(normal, aside)
    return across / length(across)


def _tuple(vector: np.ndarray) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
