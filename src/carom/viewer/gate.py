"""Pausing a simulation, and letting it go step by step."""

from __future__ import annotations

from threading import Condition

# On Windows a Ctrl-C is noticed only between two waits [s].
_LOOK = 0.1


class Gate:
    """What a step has to pass while a simulation is paused. Safe to use from all threads.

    Attributes:
        closed: Steps have to wait. Read without a lock, so that it costs nothing while nobody pauses.
    """

    def __init__(self) -> None:
        self.closed: bool = False
        self._steps = 0
        self._changed = Condition()

    def close(self) -> None:
        """Pauses."""
        with self._changed:
            self.closed = True
            self._steps = 0

    def open(self) -> None:
        """Goes on."""
        with self._changed:
            self.closed = False
            self._changed.notify_all()

    def let_through(self, steps: int = 1) -> None:
        """Lets some steps pass and stays closed after them."""
        with self._changed:
            self._steps += steps
            self._changed.notify_all()

    def wait(self) -> None:
        """Returns when a step may be made."""
        with self._changed:
            while not self._passes():
                self._changed.wait(_LOOK)

    def passes(self) -> bool:
        """Whether a step may be made now; it then counts as made."""
        with self._changed:
            return self._passes()

    def _passes(self) -> bool:
        if not self.closed:
            return True
        if self._steps == 0:
            return False
        self._steps -= 1
        return True
