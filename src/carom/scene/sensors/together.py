"""All sensors of a body read together: those of the same kind by the same few operations on arrays.

The numbers are those of `reading`, bit for bit. What is rare is read one sensor at a time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.description.sensor import OF_STEPS, POSITIVE, UNBOUNDED, SensorKind, SensorObject, SensorSpec
from carom.scene.sensors.accelerations import LastStep
from carom.scene.sensors.frames import Frame, Frames, object_frame
from carom.scene.sensors.joints import joint_of
from carom.scene.sensors.reading import reading
from carom.scene.sensors.source import Source
from carom.scene.sensors.vectors import turned, turned_back

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

_OF_FRAMES = (
    *(SensorKind.GYRO, SensorKind.VELOCIMETER, SensorKind.FRAME_POSITION, SensorKind.FRAME_QUATERNION),
    *(SensorKind.FRAME_X_AXIS, SensorKind.FRAME_Y_AXIS, SensorKind.FRAME_Z_AXIS),
    *(SensorKind.FRAME_LINEAR_VELOCITY, SensorKind.FRAME_ANGULAR_VELOCITY),
)
_AXES = {SensorKind.FRAME_X_AXIS: 0, SensorKind.FRAME_Y_AXIS: 1, SensorKind.FRAME_Z_AXIS: 2}
_NO_LIMITS: tuple[Array | None, float, float | None] = (None, 0.0, None)
_COORDINATES = {SensorKind.JOINT_POSITION: "position", SensorKind.JOINT_VELOCITY: "dof_velocity"}


class _Group:
    """Sensors of a kind: which, and their places among those of all kinds that are measured alike."""

    def __init__(self, kind: SensorKind) -> None:
        self.kind = kind
        self.sensors: list[int] = []
        self.places: list[int] = []


class Together:
    """Reads all sensors of a body."""

    def __init__(self, body: BodyCore) -> None:
        self._body = body
        self._alone: list[int] = []
        frames: dict[str, list[Frame]] = {"now": [], "step": []}
        self._groups: dict[str, dict[SensorKind, _Group]] = {"now": {}, "step": {}, "joints": {}}
        columns: dict[SensorKind, list[int]] = {kind: [] for kind in _COORDINATES}
        for index, spec in enumerate(body.spec.sensors):
            part = _part_of(spec)
            if not part:
                self._alone.append(index)
                continue
            group = self._groups[part].setdefault(spec.kind, _Group(spec.kind))
            group.sensors.append(index)
            if part == "joints":
                numbers = (
                    body.position_index if spec.kind is SensorKind.JOINT_POSITION else body.velocity_index
                )
                columns[spec.kind].append(numbers[joint_of(body, spec)])
            else:
                group.places.append(len(frames[part]))
                frames[part].append(object_frame(body, spec))
        self._frames = {part: Frames(found) for part, found in frames.items() if found}
        self._columns = {kind: np.array(found) for kind, found in columns.items() if found}
        self._limits = {
            index: _limits(spec) for index, spec in enumerate(body.spec.sensors) if spec.bias or spec.cutoff
        }

    def read(self, source: Source) -> list[Array]:
        """What each sensor shows in each world, (worlds, dim) each."""
        body = self._body
        found: dict[int, Array] = {}
        last = LastStep(source, body) if "step" in self._frames else None
        alone = self._alone
        if last is not None and not last.is_known.all():
            of_steps = (group.sensors for group in self._groups["step"].values())
            alone, last = [*alone, *(index for group in of_steps for index in group)], None
        for index in alone:
            found[index] = reading(source, body, index)
        for index, values in self._measured(source, last):
            bias, lower, upper = self._limits.get(index, _NO_LIMITS)
            shifted = values if bias is None else values + bias
            found[index] = shifted if upper is None else np.clip(shifted, lower, upper)
        return [found[index] for index in range(len(body.spec.sensors))]

    def _measured(self, source: Source, last: LastStep | None) -> Iterator[tuple[int, Array]]:
        """Measurements of sensors of many: their indices, and numbers without bias and cutoff."""
        body = self._body
        if last is not None:
            yield from _split(self._groups["step"], last.accelerations(self._frames["step"]))
        if "now" in self._frames:
            frames = self._frames["now"]
            frames.find(source.poses(body), source.velocities(body))
            yield from _split(self._groups["now"], lambda kind, places: _of_kind(frames, kind, places))
        for kind, columns in self._columns.items():
            values = source.state(_COORDINATES[kind])[:, columns]
            for place, index in enumerate(self._groups["joints"][kind].sensors):
                yield index, values[:, place : place + 1]


def _part_of(spec: SensorSpec) -> str:
    """With which others a sensor is measured; empty for one that is read alone."""
    if spec.is_clocked or spec.noise > 0.0 or spec.reference_type is not SensorObject.NONE:
        return ""
    if spec.kind in OF_STEPS:
        return "step"
    if spec.kind in _COORDINATES:
        return "joints"
    return "now" if spec.kind in _OF_FRAMES else ""


def _limits(spec: SensorSpec) -> tuple[Array | None, float, float | None]:
    """Bias, and bounds of what a sensor shows, as `reading` has them; None for none."""
    bias = np.array(spec.bias) if spec.bias else None
    if not spec.cutoff or spec.kind in UNBOUNDED:
        return bias, -np.inf, None
    return bias, -np.inf if spec.kind in POSITIVE else -spec.cutoff, spec.cutoff


def _of_kind(frames: Frames, kind: SensorKind, places: np.ndarray) -> Array:
    """What sensors of a kind measure of some frames, (worlds, sensors, dim)."""
    turn = frames.orientation[:, places]
    if kind is SensorKind.GYRO:
        return turned_back(turn, frames.angular[:, places])
    if kind is SensorKind.VELOCIMETER:
        return turned_back(turn, frames.linear[:, places])
    if kind is SensorKind.FRAME_QUATERNION:
        return turn
    if kind in _AXES:
        return turned(turn, np.eye(3)[_AXES[kind]])
    values = {
        SensorKind.FRAME_POSITION: frames.position,
        SensorKind.FRAME_LINEAR_VELOCITY: frames.linear,
        SensorKind.FRAME_ANGULAR_VELOCITY: frames.angular,
    }
    return values[kind][:, places]


def _split(
    groups: Mapping[SensorKind, _Group], measure: Callable[[SensorKind, np.ndarray], Array]
) -> Iterator[tuple[int, Array]]:
    """Measurements by the indices of their sensors."""
    for kind, group in groups.items():
        values = measure(kind, np.array(group.places))
        for place, index in enumerate(group.sensors):
            yield index, values[:, place]


def read_together(source: Source, body: BodyCore) -> list[Array]:
    """What each sensor of a body shows in each world, (worlds, dim) each."""
    # `derived` is emptied when inertial frames change; rows move when other bodies are removed.
    made_for = id(body.spec), body.first_link, body.first_position, body.first_velocity
    kept = body.derived.get(Together)
    if kept is None or kept[0] != made_for:
        # With the specification, so that no other has its number.
        kept = body.derived[Together] = made_for, body.spec, Together(body)
    return kept[2].read(source)
