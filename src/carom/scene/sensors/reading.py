"""What sensors show: measurements with bias, noise, cutoff, delay and period."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.description.sensor import OF_STEPS, POSITIVE, UNBOUNDED, SensorSpec
from carom.scene.sensors.accelerations import LastStep, acceleration
from carom.scene.sensors.frames import Motion, motion, object_frame
from carom.scene.sensors.measure import measured
from carom.scene.sensors.memory import due, push, recall
from carom.scene.sensors.noise import gaussian
from carom.scene.sensors.source import Source

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


def reading(source: Source, body: BodyCore, index: int) -> Array:
    """What a sensor of a body shows in each world, (worlds, dim)."""
    spec = body.spec.sensors[index]
    if not spec.is_remembered:
        return _imperfect(source, body, spec, measured(source, body, spec))
    if not spec.is_clocked:
        return _of_last_step(source, body, index)
    memory = source.state("sensor_memory")[:, _part(body, index)]
    known = memory[:, 0] > 0.0
    shown = recall(memory, spec, source.times)
    if known.all():
        return shown
    if spec.kind in OF_STEPS:
        now = np.zeros((source.count, spec.dim))
    else:
        now = _imperfect(source, body, spec, measured(source, body, spec))
    return np.where(known[:, None], shown, now)


def _of_last_step(source: Source, body: BodyCore, index: int) -> Array:
    """What a sensor of one of the kinds `OF_STEPS` shows, from the motion that the last step has kept."""
    spec = body.spec.sensors[index]
    last = LastStep(source, body)
    if last.is_known.all():
        return _imperfect(source, body, spec, last.acceleration(spec))
    shown = np.zeros((source.count, spec.dim))
    memory = source.state("sensor_memory")[:, _part(body, index)]
    # Files from versions in which steps kept no motion have measurements instead.
    shown = np.where(memory[:, :1] > 0.0, recall(memory, spec, source.times), shown)
    if last.is_known.any():
        values = _imperfect(source, body, spec, last.acceleration(spec))
        shown = np.where(last.is_known[:, None], values, shown)
    return shown


class StepWatch:
    """Fills the memories of sensors: make one before a step, and call `finish` after it."""

    def __init__(self, source: Source, places: Sequence[tuple[BodyCore, int]]) -> None:
        """Look at the sensors in `places`, bodies and indices, all of which have a memory."""
        self._source = source
        self._places = places
        self._before: list[Motion | None] = []
        for body, index in places:
            spec = body.spec.sensors[index]
            frame = object_frame(body, spec) if spec.kind in OF_STEPS else None
            before = None if frame is None else motion(source, frame)
            self._before.append(before and Motion(before.linear.copy(), before.angular.copy()))

    def finish(self, worlds: np.ndarray) -> None:
        """Measure in the worlds that have made a step; `times` of the source are those after it."""
        source, times = self._source, self._source.times
        for (body, index), before in zip(self._places, self._before, strict=True):
            spec, part = body.spec.sensors[index], _part(body, index)
            memory = source.state("sensor_memory")[:, part]
            ready = due(memory, spec, times)
            chosen = worlds[ready[worlds]]
            if not len(chosen):
                continue
            if before is None:
                values = measured(source, body, spec)
            else:
                values = acceleration(source, body, spec, before)
            values = _imperfect(source, body, spec, values)
            filled = push(memory[chosen], spec, times[chosen], values[chosen])
            source.engine.arrays.state.numpy["sensor_memory"][chosen, part] = filled


def forget(source: Source, body: BodyCore, worlds: np.ndarray | slice) -> None:
    """Empty the memories of all sensors of a body in some worlds."""
    first, count = body.rows.first["sensor"], body.rows.count["sensor"]
    if count:
        state = source.engine.arrays.state.numpy
        state["sensor_memory"][worlds, first : first + count] = 0.0
        state["tree_last_step"][worlds, body.rows.tree] = 0.0


def remembered(bodies: Sequence[BodyCore]) -> list[tuple[BodyCore, int]]:
    """The sensors of bodies that are measured at each step: their bodies and indices."""
    return [
        (body, index)
        for body in bodies
        if body.rows.count["sensor"]
        for index, spec in enumerate(body.spec.sensors)
        if spec.is_clocked
    ]


def _part(body: BodyCore, index: int) -> slice:
    """Where the memory of a sensor is."""
    first = body.rows.first["sensor"] + sum(spec.memory for spec in body.spec.sensors[:index])
    return slice(first, first + body.spec.sensors[index].memory)


def _imperfect(source: Source, body: BodyCore, spec: SensorSpec, values: Array) -> Array:
    """Measurements with bias and noise, within the cutoff."""
    if spec.bias:
        values = values + np.array(spec.bias)
    if spec.noise > 0.0:
        steps = np.rint(source.times / source.parameters.time_step).astype(np.int64)
        key = f"{body.id} {spec.name}"
        values = values + spec.noise * gaussian(key, spec.seed, source.seeds, steps, spec.dim)
    if spec.cutoff > 0.0 and spec.kind not in UNBOUNDED:
        lower = -np.inf if spec.kind in POSITIVE else -spec.cutoff
        values = np.clip(values, lower, spec.cutoff)
    return values
