"""Pausing a simulation, single steps, and slow motion."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from threading import Condition
from time import monotonic

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
            self._changed.notify_all()

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
            self._changed.notify_all()

    def call_back(self) -> None:
        """Ends a wait without a step, if the waiting script reads user input."""
        with self._changed:
            self._calls += 1
            self._changed.notify_all()

    def wait(self, clock: Callable[[], float], *, listening: bool = False) -> bool:
        """Waits until a step may be made and is due at the set speed.

        It looks again when something changes: a step that is due in an hour is made at once when the speed
        is set free, and not at all when the simulation is paused meanwhile.

        Args:
            clock: Tells the simulated time of the step [s]; users may go back in time meanwhile.
            listening: While the simulation is paused also return, without a step, at `call_back`.

        Returns:
            Whether a step may be made; it then counts as made.
        """
        with self._changed:
            calls, heard = self._calls, False
            try:
                while (left := self._time_left(clock)) > 0.0:
                    heard, before = listening and self.closed, heard
                    self.listeners += heard - before
                    if heard and self._calls != calls:
                        return False
                    self._changed.wait(min(left, _LOOK))
                return self._passes()
            finally:
                self.listeners -= heard

    def _time_left(self, clock: Callable[[], float]) -> float:
        """How long a step has to wait [s]; infinite while the simulation is paused."""
        if self.closed:
            return inf if self._steps == 0 else 0.0
        return 0.0 if self.speed is None else self._delay(clock(), self.speed)

    def _delay(self, time: float, speed: float) -> float:
        """How long it is until a step at this simulated time [s] is due at a speed."""
        now = monotonic()
        if self._origin is None or time < self._origin[0]:
            self._origin = (time, now)
        due = self._origin[1] + (time - self._origin[0]) / speed
        if now - due > _MAX_LAG:
            self._origin = (time, now)
        return due - now

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
