"""Going back in time: to the start, or to a mark set by a user."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.errors import StateError
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.protocol import to_page

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.restorable import Restorable
    from carom.scene.snapshot import Snapshot

_MAX_MARKS = 32


class Moments:
    """Saved states of a world. Its methods are called between steps.

    The start is the state before the first step with the present bodies.
    """

    def __init__(self, world: Restorable, latest: LatestMessages) -> None:
        self._world = world
        self._latest = latest
        self._start: Snapshot | None = None
        self._bodies: list[BodyCore] = []
        self._marks: dict[int, Snapshot] = {}
        self._next = 0

    @property
    def start_is_known(self) -> bool:
        """Whether the start state of the present bodies is saved."""
        return self._start is not None and self._bodies == list(self._world.bodies.values())

    def keep_start(self) -> None:
        """Saves the present state as the start, and drops the marks, unless the bodies are the same."""
        if self.start_is_known:
            return
        self._start = self._world.snapshot()
        self._bodies = list(self._world.bodies.values())
        for number in self._marks:
            self._remove(number)
        self._marks.clear()

    def reset(self) -> None:
        """Restores the start state; does nothing before the first step."""
        if self._start is not None and self.start_is_known:
            self._world.restore(self._start)

    def mark(self) -> None:
        """Saves the present state, and drops the oldest mark if there are too many."""
        if len(self._marks) >= _MAX_MARKS:
            oldest = next(iter(self._marks))
            del self._marks[oldest]
            self._remove(oldest)
        state = self._world.snapshot()
        self._marks[self._next] = state
        header = to_page.MARK(mark=self._next, time=float(state.time))
        self._latest.put(("mark", self._next), header)
        self._next += 1

    def restore(self, number: int) -> None:
        """Restores a mark; a mark of removed bodies is dropped."""
        state = self._marks.get(number)
        if state is None:
            return
        try:
            self._world.restore(state)
        except StateError:
            del self._marks[number]
            self._remove(number)
            raise

    def _remove(self, number: int) -> None:
        self._latest.remove(("mark", number), to_page.NO_MARK(mark=number))
