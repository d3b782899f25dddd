"""Accelerations in the last step, from the motion of bodies before and after it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.description.sensor import SensorKind, SensorSpec
from carom.native.uninterrupted import uninterrupted
from carom.scene.sensors.frames import Frames, Motion, motion, object_frame, placement
from carom.scene.sensors.source import Source
from carom.scene.sensors.vectors import turned_back

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

_COORDINATES = "position", "dof_velocity"


def acceleration(source: Source, body: BodyCore, spec: SensorSpec, before: Motion) -> Array:
    """What a sensor of one of the kinds `OF_STEPS` measures after a step, with the motion before it."""
    frame = object_frame(body, spec)
    after, duration = motion(source, frame), source.parameters.time_step
    if spec.kind is SensorKind.FRAME_ANGULAR_ACCELERATION:
        return (after.angular - before.angular) / duration
    proper = (after.linear - before.linear) / duration - source.parameter("gravity_vector", 0)
    if spec.kind is SensorKind.FRAME_LINEAR_ACCELERATION:
        return proper
    return turned_back(placement(source, frame).orientation, proper)


class LastStep:
    """The motion of a body in the last step of each world, which the step has kept.

    Args:
        source: The worlds.
        body: A body that is followed: one with a sensor of accelerations.

    Attributes:
        is_known: In which worlds there was a step since the body was reset, (count,).
    """

    def __init__(self, source: Source, body: BodyCore) -> None:
        self._source, self._body = source, body
        self._last = source.state("tree_last_step")[:, body.rows.tree]
        self.is_known: np.ndarray = self._last[:, 3] > 0.0

    def acceleration(self, spec: SensorSpec) -> Array:
        """What a sensor of the kinds `OF_STEPS` measured at the end of the step; where there was one."""
        measure = self.accelerations(Frames([object_frame(self._body, spec)]))
        return measure(spec.kind, np.array([0]))[:, 0]

    def accelerations(self, frames: Frames) -> Callable[[SensorKind, np.ndarray], Array]:
        """A function that gives, for a kind and numbers of frames, what sensors of this kind measured.

        Its results are (worlds, sensors, 3).
        """
        source, body = self._source, self._body
        # The present coordinates are set aside for as long as links are found for others.
        with uninterrupted:
            present = [source.state(name).copy() for name in _COORDINATES]
            try:
                self._show("before")
                velocities = source.velocities(body)
                frames.find(source.poses(body), velocities)
                linear, angular = frames.linear, frames.angular
                self._show("after")
                velocities = source.velocities(body)
                frames.find(source.poses(body), velocities)
            finally:
                for name, values in zip(_COORDINATES, present, strict=True):
                    source.engine.arrays.state.numpy[name][:] = values
                source.velocities(body)
        last = self._last[:, None]
        duration = np.where(last[..., 3:] > 0.0, last[..., 3:], 1.0)

        def measure(kind: SensorKind, places: np.ndarray) -> Array:
            if kind is SensorKind.FRAME_ANGULAR_ACCELERATION:
                return (frames.angular[:, places] - angular[:, places]) / duration
            proper = (frames.linear[:, places] - linear[:, places]) / duration - last[..., :3]
            if kind is SensorKind.FRAME_LINEAR_ACCELERATION:
                return proper
            return turned_back(frames.orientation[:, places], proper)

        return measure

    def _show(self, end: str) -> None:
        """Let the body have the coordinates of one end of the step."""
        rows, state = self._body.rows, self._source.engine.arrays.state.numpy
        for name, axis in zip(_COORDINATES, ("position", "dof"), strict=True):
            own = slice(rows.first[axis], rows.first[axis] + rows.count[axis])
            state[name][:, own] = state[f"{name}_{end}"][:, own]
