"""Pausing a simulation, single steps, and slow motion."""

from __future__ import annotations

from threading import Condition
from time import monotonic, sleep

# Maximum length of one wait [s]: on Windows, Ctrl-C is handled only between two waits.
_LOOK = 0.1
# Maximum delay that a simulation slower than its set speed catches up [s].
_MAX_LAG = 0.1


class PauseControl:
    """A gate for steps while a simulation is paused or slowed down. Safe to use from all threads.

    Attributes:
        closed: Whether steps have to wait. Read without a lock, so that it costs nothing while not paused.
        speed: Maximum speed, simulated time / real time; None for any.
        listeners: Number of waits that end at `call_back`.
    """

    def __init__(self) -> None:
        self.closed: bool = False
        self.speed: float | None = None
        self.listeners: int = 0
        self._steps = 0
        self._calls = 0
        self._changed = Condition()
        # Simulated and real time at which the speed limit started [s].
        self._origin: tuple[float, float] | None = None

    def close(self) -> None:
        """Pauses the simulation."""
        with self._changed:
            self.closed = True
            self._steps = 0

    def open(self) -> None:
        """Continues the simulation."""
        with self._changed:
            self.closed = False
            self._origin = None
            self._changed.notify_all()

    def let_through(self) -> None:
        """Allows a step, and stays paused after it."""
        with self._changed:
            self._steps += 1
            self._changed.notify_all()

    def set_speed(self, speed: float | None) -> None:
        """Limits the speed, simulated time / real time; None for no limit."""
        with self._changed:
            self.speed = speed
            self._origin = None

    def call_back(self) -> None:
        """Ends a wait without a step, if the waiting script reads user input."""
        with self._changed:
            self._calls += 1
            self._changed.notify_all()

    def wait(self, *, listening: bool = False) -> bool:
        """Waits until a step may be made, or, if `listening`, until `call_back`.

        Returns whether a step may be made; it then counts as made.
        """
        with self._changed:
            calls = self._calls
            self.listeners += listening
            try:
                while not self._passes():
                    if listening and self._calls != calls:
                        return False
                    self._changed.wait(_LOOK)
                return True
            finally:
                self.listeners -= listening

    def keep_pace(self, time: float) -> None:
        """Waits until a step at this simulated time [s] is due at the set speed."""
        speed = self.speed
        if speed is None:
            return
        now = monotonic()
        if self._origin is None or time < self._origin[0]:
            self._origin = (time, now)
        due = self._origin[1] + (time - self._origin[0]) / speed
        if now - due > _MAX_LAG:
            self._origin = (time, now)
        elif due > now:
            sleep(due - now)

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
