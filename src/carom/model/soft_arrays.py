"""Writing soft bodies to rows of `SoftModel`, and removing these rows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.layouts.soft import ANCHORS, BODIES, FREE, HELD, HELD_UNDAMPED, SoftModel
from carom.model.body_rows import TreeRows
from carom.native.change import Change
from carom.native.products import determinants, inverses
from carom.native.tables import ArrayTable

if TYPE_CHECKING:
    from carom.model.soft_spec import Anchor, SoftRows, SoftSpec

_AXES = ("soft", "node", "spring", "tetra", "face")
# Fields that contain row numbers, and the axis of these rows; values are updated when rows are removed.
_INDEX_FIELDS = {
    "soft_tree": "tree",
    "soft_first_node": "node",
    "soft_first_spring": "spring",
    "soft_first_tetra": "tetra",
    "soft_first_face": "face",
    "spring_a": "node",
    "spring_b": "node",
    "tetra_nodes": "node",
    "face_nodes": "node",
}


class SoftArrays:
    """The soft bodies of a world, in step with the rows of the trees that represent them.

    Attributes:
        table: The arrays.
        used: Rows in use, by axis.
        bodies: The soft bodies in the order of their rows.
        anchors: The anchors of their nodes, by number.
    """

    def __init__(self) -> None:
        self.table: ArrayTable = ArrayTable(SoftModel, references=_INDEX_FIELDS)
        self.table.reserve({"count": 2})
        self.used: dict[str, int] = dict.fromkeys(_AXES, 0)
        self.bodies: list[SoftRows] = []
        self.anchors: dict[int, Anchor] = {}

    def append(self, spec: SoftSpec, rows: TreeRows) -> SoftRows:
        """Add a soft body whose tree and nodes were appended to the arrays of the world just before.

        This is no change but is seen at once: soft bodies are added to drafts of worlds.
        """
        count = {
            "soft": 1,
            "node": len(spec.nodes),
            "spring": len(spec.springs),
            "tetra": len(spec.tetras),
            "face": len(spec.faces),
        }
        self.table.reserve({axis: self.used[axis] + number for axis, number in count.items()})
        from carom.model.soft_spec import SoftRows

        soft = SoftRows(rows, spec, {axis: self.used[axis] for axis in _AXES}, count)
        self._write(soft)
        for axis, number in count.items():
            self.used[axis] += number
        self.bodies.append(soft)
        self.table.numpy["count_soft"][BODIES] = len(self.bodies)
        return soft

    def _write(self, soft: SoftRows) -> None:
        numpy, spec, first = self.table.numpy, soft.spec, soft.first
        row = first["soft"]
        numpy["soft_tree"][row] = soft.rows.tree
        for axis in ("node", "spring", "tetra", "face"):
            numpy[f"soft_first_{axis}"][row] = first[axis]
            numpy[f"soft_{axis}_count"][row] = soft.count[axis]
        numpy["soft_margin"][row] = spec.margin
        numpy["soft_thickness"][row] = spec.thickness()
        numpy["soft_self_collision"][row] = spec.self_collision
        numpy["soft_gravity_factor"][row] = spec.gravity_factor
        numpy["soft_mu"][row] = spec.mu
        numpy["soft_lam"][row] = spec.lam
        numpy["soft_damping"][row] = spec.damping
        frequencies = spec.frequencies()
        numpy["soft_frequency"][row] = frequencies.max(initial=0.0)
        rows = {axis: slice(first[axis], first[axis] + soft.count[axis]) for axis in _AXES}
        numpy["node_inverse_mass"][rows["node"]] = 1.0 / spec.masses
        numpy["node_anchored"][rows["node"]] = FREE
        numpy["node_rest"][rows["node"]] = spec.nodes - np.average(spec.nodes, axis=0, weights=spec.masses)
        ends = spec.springs + first["node"]
        numpy["spring_a"][rows["spring"]], numpy["spring_b"][rows["spring"]] = ends[:, 0], ends[:, 1]
        numpy["spring_frequency"][rows["spring"]] = frequencies[spec.springs].max(axis=1)
        numpy["spring_all_directions"][rows["spring"]] = spec.damps_all_directions
        from carom.model.soft_spec import DAMPING, LENGTH, STIFFNESS

        for name, column in (("length", LENGTH), ("stiffness", STIFFNESS), ("damping", DAMPING)):
            numpy[f"spring_{name}"][rows["spring"]] = spec.spring_terms[:, column]
        if len(spec.tetras):
            edges = spec.edge_matrices()
            numpy["tetra_nodes"][rows["tetra"]] = spec.tetras + first["node"]
            numpy["tetra_inverse"][rows["tetra"]] = inverses(edges)
            numpy["tetra_volume"][rows["tetra"]] = determinants(edges) / 6.0
            numpy["tetra_frequency"][rows["tetra"]] = frequencies[spec.tetras].max(axis=1)
        numpy["face_nodes"][rows["face"], :3] = spec.faces + first["node"]

    def write_anchors(self) -> None:
        """Update the arrays from the present anchors."""
        change = Change()
        self.note_anchors(change)
        change.commit()

    def note_anchors(self, change: Change) -> None:
        """The same with a change, for the anchors that there are after it; it makes room for them at once."""
        if not self.bodies and not self.table.numpy["count_soft"][ANCHORS]:
            return
        anchors = change.content(self.anchors).values()
        held = [(anchor, anchor.body) for anchor in anchors if anchor.body is not None]
        change.make_room([self.table], {"anchor": len(held)})
        numpy = change.arrays(self.table.numpy)
        for soft in self.bodies:
            nodes = slice(soft.first["node"], soft.first["node"] + soft.count["node"])
            numpy["node_inverse_mass"][nodes] = 1.0 / soft.spec.masses
            numpy["node_anchored"][nodes] = FREE
        numpy["count_soft"][ANCHORS] = len(held)
        for row, (anchor, body) in enumerate(held):
            node = anchor.soft.first["node"] + anchor.node
            numpy["node_anchored"][node] = HELD if anchor.damped else HELD_UNDAMPED
            numpy["anchor_node"][row] = node
            numpy["anchor_tree"][row] = body.tree
            numpy["anchor_link"][row] = body.first["link"] + 1 + anchor.link
            numpy["anchor_pivot"][row] = anchor.pivot
            numpy["anchor_late_force"][row] = anchor.late_force
        for anchor in anchors:
            if anchor.body is None:
                numpy["node_inverse_mass"][anchor.soft.first["node"] + anchor.node] = 0.0

    def remove(self, change: Change, rows: TreeRows) -> None:
        """Remove the soft rows and anchors of a body, soft or not, with a change; its tree still has rows."""
        if not self.bodies:
            return
        gone = next((soft for soft in self.bodies if soft.rows is rows), None)
        count: dict[str, int] = dict.fromkeys(_AXES, 0) if gone is None else gone.count
        first = {} if gone is None else gone.first
        self.table.cut(change, {**first, "tree": rows.tree}, {**count, "tree": 1}, self.used)
        change.set(self, "used", {axis: self.used[axis] - number for axis, number in count.items()})
        later = [] if gone is None else self.bodies[self.bodies.index(gone) + 1 :]
        for soft in later:
            change.set(soft, "first", {axis: row - count[axis] for axis, row in soft.first.items()})
        bodies = [soft for soft in self.bodies if soft is not gone]
        anchors = {
            number: anchor
            for number, anchor in self.anchors.items()
            if anchor.soft is not gone and anchor.body is not rows
        }
        change.set(self, "bodies", bodies)
        change.set(self, "anchors", anchors)
        change.write(self.table.numpy["count_soft"][BODIES : BODIES + 1], len(bodies))

    def struct(self) -> Any:
        """A C struct whose fields are views of the arrays."""
        return self.table.struct()
