"""Logs of the state: values after each step, as NumPy arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.errors import StateError

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore

_FIRST_ROOM = 256


class Log:
    """Values of state arrays after each step; get one from `World.log`.

    It is a context manager, and stops when the context is left. `log["position"]` is an array with a
    row for each recorded step, `log["time"]` the times [s].

    Args:
        world: The world.
        names: State arrays of the world, such as `position`.
        every: Record every n-th step.
    """

    def __init__(self, world: WorldCore, names: tuple[str, ...], every: int) -> None:
        self._world = world
        self._every = every
        self._steps = 0
        self._count = 0
        self._bodies = list(world.bodies.values())
        like = {name: getattr(world, name) for name in names} | {"time": np.empty(())}
        self._rows = {name: np.empty((_FIRST_ROOM, *it.shape), it.dtype) for name, it in like.items()}
        world.observers.append(self)

    def __repr__(self) -> str:
        return f"<Log of {', '.join(self._rows)}: {self._count} steps recorded>"

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, name: str) -> Array:
        """The recorded rows of an array, the first step first; a copy.

        Raises:
            KeyError: This array is not recorded.
        """
        return self._rows[name][: self._count].copy()

    def __enter__(self) -> Log:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def stop(self) -> None:
        """Stop recording; recorded rows are kept."""
        if self in self._world.observers:
            self._world.observers.remove(self)

    def before_step(self) -> None:
        """Do nothing: a log records the results of a step."""

    def after_step(self) -> None:
        """Record the state.

        Raises:
            StateError: Bodies were added or removed, so the rows of the arrays have changed.
        """
        self._steps += 1
        if self._steps % self._every:
            return
        if list(self._world.bodies.values()) != self._bodies:
            self.stop()
            raise StateError("bodies were added or removed; the log has been stopped")
        if self._count == len(self._rows["time"]):
            self._rows = {
                name: np.concatenate((rows, np.empty_like(rows))) for name, rows in self._rows.items()
            }
        for name, rows in self._rows.items():
            value = self._world.time if name == "time" else getattr(self._world, name)
            rows[self._count] = value
        self._count += 1
