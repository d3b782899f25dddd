"""Logs of many worlds: values after each step, as NumPy arrays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.scene.state_views import VIEWS
from carom.world.log import Recording

if TYPE_CHECKING:
    from carom.worlds.face.keeping import WorldsKeeping


class WorldsLog(Recording):
    """Values of state arrays of all worlds after each step; get one from `Worlds.log`.

    It is a context manager, and stops when the context is left. `log["position"]` is an array (steps, count,
    n), `log["time"]` the times [s], (steps, count).

    Args:
        worlds: The worlds.
        names: Arrays of `Worlds.state`, such as `position`.
        every: Record every n-th step.
    """

    def __init__(self, worlds: WorldsKeeping, names: Sequence[str], every: int) -> None:
        self._worlds = worlds
        super().__init__(names, every, worlds.observers)

    def __enter__(self) -> WorldsLog:
        return self

    @property
    def each_step(self) -> bool:
        """It is told of each step."""
        return True

    def before_steps(self) -> None:
        """Do nothing: a log records the results of a step."""

    def after_steps(self) -> None:
        """Record the states."""
        self._record()

    def _present(self, name: str) -> Any:
        if name == "time":
            return self._worlds.time
        arrays = self._worlds._engine.arrays
        field = VIEWS[name]
        return np.asarray(arrays.state.numpy[field])[:, : arrays.used[arrays.state.axis_of(field)]]
