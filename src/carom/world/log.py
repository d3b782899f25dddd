"""Logs of the state: values after each step, as NumPy arrays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.checks import Array
from carom.errors import StateError
from carom.scene.state_views import VIEWS
from carom.world.face.state import FlatState

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore

_FIRST_ROOM = 256
# Not in `FlatState`, and of the same length as these.
_LIKE = {"motor": "velocity", "pd": "velocity"}


def check_log(names: Sequence[str], every: int) -> None:
    """Raise `ValueError` unless there are arrays of these names, and `every` is a number of steps."""
    unknown = [name for name in names if name not in VIEWS]
    if unknown:
        raise ValueError(f"there is no array {unknown[0]!r}; there are {', '.join(VIEWS)}")
    if every < 1:
        raise ValueError(f"every must be at least 1, not {every}")


class Recording:
    """Rows of arrays of a state after each step, or after every n-th: `Log` and `WorldsLog`.

    Args:
        names: Arrays of `World.state`.
        every: Record every n-th step.
        observers: Whom steps tell; this is one of them from now on.
    """

    def __init__(self, names: Sequence[str], every: int, observers: list[Any]) -> None:
        self._observers = observers
        self._every = every
        self._steps = 0
        self._count = 0
        like = {name: np.asarray(self._present(name)) for name in (*names, "time")}
        self._rows = {name: np.empty((_FIRST_ROOM, *it.shape), it.dtype) for name, it in like.items()}
        observers.append(self)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {', '.join(self._rows)}: {self._count} steps recorded>"

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, name: str) -> Array:
        """The recorded rows of an array, the first step first; a copy.

        Raises:
            KeyError: This array is not recorded.
        """
        return self._rows[name][: self._count].copy()

    def __exit__(self, *_: object) -> None:
        self.stop()

    def stop(self) -> None:
        """Stop recording; recorded rows are kept."""
        if self in self._observers:
            self._observers.remove(self)

    def _present(self, name: str) -> Any:
        """An array as it is now, or the time."""
        raise NotImplementedError

    def _record(self) -> None:
        """Record the state after a step, if it is its turn."""
        self._steps += 1
        if self._steps % self._every:
            return
        self._check()
        if self._count == len(self._rows["time"]):
            self._rows = {
                name: np.concatenate((rows, np.empty_like(rows))) for name, rows in self._rows.items()
            }
        for name, rows in self._rows.items():
            rows[self._count] = self._present(name)
        self._count += 1

    def _check(self) -> None:
        """Raise an error if the arrays can no longer be recorded."""


class Log(Recording):
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
        self._bodies = list(world.bodies.values())
        super().__init__(names, every, world.observers)

    def __enter__(self) -> Log:
        return self

    def before_step(self) -> None:
        """Do nothing: a log records the results of a step."""

    def after_step(self) -> None:
        """Record the state.

        Raises:
            StateError: Bodies were added or removed, so the rows of the arrays have changed.
        """
        self._record()

    def _present(self, name: str) -> Any:
        if name == "time":
            return self._world.time
        if name in _LIKE:
            return getattr(self._world, name)[: len(FlatState(self._world).velocity)]
        return getattr(FlatState(self._world), name)

    def _check(self) -> None:
        if list(self._world.bodies.values()) != self._bodies:
            self.stop()
            raise StateError("bodies were added or removed; the log has been stopped")
