"""The table from which a kernel reads the sensors of a body: `carom.layouts.queries.SensorTable`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.description.sensor import (
    DISTANCE_KINDS,
    OF_STEPS,
    POSITIVE,
    SUBTREE_KINDS,
    UNBOUNDED,
    SensorKind,
    SensorObject,
    SensorSpec,
)
from carom.description.site import SiteShape
from carom.layouts.codes import ConstraintKind
from carom.layouts.queries import SensorTable
from carom.scene.sensors.frames import Frame, object_frame, reference_frame
from carom.scene.sensors.joints import actuator_of, joint_of
from carom.scene.sensors.subtrees import subtree_rows
from carom.scene.tendons.moment_arms import pulling

if TYPE_CHECKING:
    from carom.native.tables import ArrayTable
    from carom.scene.core.body_core import BodyCore
    from carom.scene.sensors.source import Source

OF_LOADS: tuple[SensorKind, ...] = (SensorKind.FORCE, SensorKind.TORQUE)
OF_LIMITS: tuple[SensorKind, ...] = (SensorKind.JOINT_LIMIT_POSITION, SensorKind.JOINT_LIMIT_VELOCITY)
_KINDS = {kind: number for number, kind in enumerate(SensorKind)}
_SHAPES = {shape: number for number, shape in enumerate(SiteShape)}
_OF_ACTUATORS = (SensorKind.ACTUATOR_POSITION, SensorKind.ACTUATOR_VELOCITY)
_OF_POSITIONS = (SensorKind.JOINT_POSITION, SensorKind.BALL_QUATERNION, *OF_LIMITS)
# Those that no kernel reads.
OTHERS: tuple[SensorKind, ...] = (
    SensorKind.RANGE_FINDER,
    SensorKind.TENDON_POSITION,
    SensorKind.TENDON_VELOCITY,
    SensorKind.TENDON_ACTUATOR_FORCE,
    SensorKind.CONTACT,
    *DISTANCE_KINDS,
)


def is_in_table(body: BodyCore, spec: SensorSpec) -> bool:
    """Whether the kernel reads a sensor: not with a clock, nor along rays, of tendons, contacts, distances.

    Neither does it read the forces of actuators in a joint on which tendons and sites act as well.
    """
    if spec.is_clocked or spec.kind in OTHERS:
        return False
    if spec.kind is SensorKind.JOINT_ACTUATOR_FORCE:
        return not pulling(body, joint_of(body, spec))
    return spec.kind not in _OF_ACTUATORS or bool(body.spec.actuators[actuator_of(body, spec)].joint)


def bounds_of(spec: SensorSpec) -> tuple[float, float]:
    """The bounds of what a sensor shows; infinite for none."""
    if not spec.cutoff or spec.kind in UNBOUNDED:
        return -np.inf, np.inf
    return -np.inf if spec.kind in POSITIVE else -spec.cutoff, spec.cutoff


class SensorRows:
    """The rows of some sensors of a body.

    Attributes:
        table: The table.
        values: What they show in each world, which the kernel writes, (worlds, width).
        given: The length of a substep, for the kernel, (1,).
        slices: The place of each sensor among the numbers of a world.
        width: Count of these numbers.
        limits: Rows in the table of sensors of limits, with the rows of their links.
        of_steps: Whether some are of accelerations.
        of_loads: Whether some are of forces that joints transmit.

    Args:
        source: The worlds.
        body: The body.
        indices: The sensors.
    """

    def __init__(self, source: Source, body: BodyCore, indices: list[int]) -> None:
        self._source, self._body = source, body
        specs = [body.spec.sensors[index] for index in indices]
        self.slices: list[slice] = []
        self.width: int = 0
        for spec in specs:
            self.slices.append(slice(self.width, self.width + spec.dim))
            self.width += spec.dim
        self.of_steps: bool = any(spec.kind in OF_STEPS for spec in specs)
        self.of_loads: bool = any(spec.kind in OF_LOADS for spec in specs)
        self.limits: list[tuple[int, int]] = []
        self._members: list[int] = []
        self._trees = [body.rows.tree]
        # All is found before there is a table, which has to have room for the members.
        found = [self._row(number, spec) for number, spec in enumerate(specs)]
        self.table: ArrayTable = source.engine.table(SensorTable)
        count = source.count
        self.table.reserve(
            {
                "sensor": max(len(specs), 1),
                "tree": len(self._trees),
                "member": max(len(self._members), 1),
                "number": 1,
                "value": max(count * self.width, 1),
            }
        )
        arrays = self.table.numpy
        for number, row in enumerate(found):
            for name, value in row.items():
                arrays[f"sensor_{name}"][number] = value
        arrays["tree_number"][: len(self._trees)] = self._trees
        arrays["member_row"][: len(self._members)] = self._members
        self.values: np.ndarray = arrays["value_shown"][: count * self.width].reshape(count, self.width)
        self.given: np.ndarray = arrays["number_given"][:1]

    @property
    def numbers(self) -> dict[str, int]:
        """The numbers that the kernel is given."""
        return {
            "tree": self._trees[0],
            "sensor_count": len(self.slices),
            "tree_count": len(self._trees),
            "of_steps": int(self.of_steps),
            "of_loads": int(self.of_loads),
            "width": self.width,
        }

    def find_limits(self) -> None:
        """Write the rows of the limits of joints; they change with constraints."""
        kinds, links = (self._source.topology(f"constraint_{name}") for name in ("kind", "link"))
        used = self._source.engine.arrays.used["constraint"]
        rows = np.flatnonzero(kinds[:used] == ConstraintKind.LIMIT)
        # Of several of a link the first counts.
        found = dict(zip(links[rows][::-1].tolist(), rows[::-1].tolist(), strict=True))
        places = self.table.numpy["sensor_other_row"]
        for number, link in self.limits:
            places[number] = found.get(link, -1)

    def _row(self, number: int, spec: SensorSpec) -> dict[str, Any]:
        bias = np.zeros(4)
        bias[: spec.dim] = spec.bias or 0.0
        # Noise comes before the bounds.
        lower, upper = (-np.inf, np.inf) if spec.noise > 0.0 else bounds_of(spec)
        row: dict[str, Any] = {
            "kind": _KINDS[spec.kind],
            "link": -1,
            "reference_link": -1,
            "first_value": self.slices[number].start,
            "dim": spec.dim,
            "bias": bias,
            "lower": lower,
            "upper": upper,
            **self._object(number, spec),
        }
        if spec.kind not in OF_STEPS:
            reference = reference_frame(self._source.bodies, self._body, spec)
            if reference is not None:
                self._add_frame(row, reference, "reference_")
        return row

    def _object(self, number: int, spec: SensorSpec) -> dict[str, Any]:
        """What is written of the object of a sensor."""
        body, kind = self._body, spec.kind
        if kind in SUBTREE_KINDS:
            return self._of_members(subtree_rows(body, spec))
        if kind is SensorKind.JOINT_ACTUATOR_FORCE:
            first = body.rows.first["actuator"]
            of_joint = [it.joint == spec.object for it in body.spec.actuators]
            return self._of_members([first + place for place, own in enumerate(of_joint) if own])
        if spec.object_type is SensorObject.JOINT:
            joint = joint_of(body, spec)
            link = body.first_link + 1 + joint
            if kind in OF_LIMITS:
                self.limits.append((number, link))
            places = body.position_index if kind in _OF_POSITIONS else body.velocity_index
            return {"link": link, "row": places[joint], "turn": body.link_inertial_frame(joint).orientation}
        if spec.object_type is SensorObject.ACTUATOR:
            actuator = actuator_of(body, spec)
            row = {"row": body.rows.first["actuator"] + actuator}
            if kind in _OF_ACTUATORS:
                joint = [link.joint_name for link in body.spec.links].index(
                    body.spec.actuators[actuator].joint
                )
                is_position = kind is SensorKind.ACTUATOR_POSITION
                row["other_row"] = (body.position_index if is_position else body.velocity_index)[joint]
            return row
        row = {}
        if spec.object_type is not SensorObject.NONE:
            self._add_frame(row, object_frame(body, spec), "")
        if kind is SensorKind.MAGNETOMETER:
            row["vector"] = spec.magnetic_field
        elif kind is SensorKind.TOUCH:
            site = next(site for site in body.spec.sites if site.name == spec.object)
            row.update(shape=_SHAPES[site.shape], vector=site.size)
        return row

    def _of_members(self, rows: list[int]) -> dict[str, Any]:
        first = len(self._members)
        self._members += rows
        return {"row": first, "row_count": len(rows)}

    def _add_frame(self, row: dict[str, Any], frame: Frame, which: str) -> None:
        row[f"{which}link"] = frame.row
        row[f"{which}position"] = frame.pose.position
        row[f"{which}turn"] = frame.pose.orientation
        if frame.body.rows.tree not in self._trees:
            self._trees.append(frame.body.rows.tree)
