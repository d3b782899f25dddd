"""Going back in time: to the start, or to a moment a user has marked."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.errors import StateError
from carom.viewer.board import Board

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.snapshot import Snapshot
    from carom.world.world import World

_MOST_MARKS = 32


class Moments:
    """States of a world to go back to. Its methods are called while nobody steps the world.

    The start is the state before the first step, or before the first one with the bodies there are now.

    Args:
        world: The world.
        board: Where pages learn of the marks.
    """

    def __init__(self, world: World, board: Board) -> None:
        self._world = world
        self._board = board
        self._start: Snapshot | None = None
        self._bodies: list[Body] = []
        self._marks: dict[int, Snapshot] = {}
        self._next = 0

    @property
    def start_is_known(self) -> bool:
        """Whether the bodies there are now have been stepped from a state that is kept."""
        return self._start is not None and self._bodies == list(self._world.bodies.values())

    def keep_start(self) -> None:
        """Keeps the present state as the start, and gives up the marks, unless the bodies are those of it."""
        if self.start_is_known:
            return
        self._start = self._world.snapshot()
        self._bodies = list(self._world.bodies.values())
        for number in self._marks:
            self._take_down(number)
        self._marks.clear()

    def reset(self) -> None:
        """Goes back to the start; before the first step there is no other state."""
        if self._start is not None and self.start_is_known:
            self._world.restore(self._start)

    def mark(self) -> None:
        """Keeps the present state, and forgets the oldest one if there are too many."""
        if len(self._marks) >= _MOST_MARKS:
            oldest = next(iter(self._marks))
            del self._marks[oldest]
            self._take_down(oldest)
        state = self._world.snapshot()
        self._marks[self._next] = state
        header = {"type": "mark", "mark": self._next, "time": float(state.time)}
        self._board.put(("mark", self._next), header)
        self._next += 1

    def restore(self, number: int) -> None:
        """Goes back to a mark; one whose bodies are gone is given up."""
        state = self._marks.get(number)
        if state is None:
            return
        try:
            self._world.restore(state)
        except StateError:
            del self._marks[number]
            self._take_down(number)
            raise

    def _take_down(self, number: int) -> None:
        self._board.take_down(("mark", number), {"type": "no mark", "mark": number})
