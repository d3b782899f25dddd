"""Measurements at every step of a world."""

from __future__ import annotations

from typing import TYPE_CHECKING
from weakref import ref

import numpy as np

from carom.scene.sensors.lone_source import LoneSource
from carom.scene.sensors.reading import StepWatch, remembered

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore


class SensorObserver:
    """Fills the memories of a world's sensors; one of `World.observers`."""

    def __init__(self, world: WorldCore) -> None:
        self._world = ref(world)
        self._watch: StepWatch | None = None

    def before_step(self) -> None:
        """Keep the velocities from which accelerations are computed."""
        world = self._world()
        places = [] if world is None else remembered(list(world.bodies.values()))
        self._watch = StepWatch(LoneSource(world), places) if world is not None and places else None

    def after_step(self) -> None:
        """Measure."""
        if self._watch is not None:
            self._watch.finish(np.array([0]))
            self._watch = None
