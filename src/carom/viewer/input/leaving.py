"""Closing a simulation: at once by the close button, or by ESC after the script has seen the key."""

from __future__ import annotations

from collections.abc import Callable
from threading import Timer

ESCAPE = 27
# Maximum time for a script that reads keys to see ESC; then the simulation ends anyway [s].
_PATIENCE = 1.0


class Leaving:
    """Ends a simulation by `close` when the user presses ESC. Safe to use from all threads.

    PyBullet closes its window within a frame of ESC, and a loop that reads keys may see the key before.
    Here a script that reads keys always gets the key first. `close` may be called more than once.
    """

    def __init__(self, close: Callable[[], None]) -> None:
        self._close = close
        self._timer: Timer | None = None

    @property
    def pending(self) -> bool:
        """Whether ESC was pressed, and the script has not seen it yet."""
        return self._timer is not None

    def escape(self, *, listening: bool) -> None:
        """Ends the simulation after ESC: at once, or when the script, if `listening`, has seen the key."""
        if not listening:
            self._close()
        elif self._timer is None:
            self._timer = Timer(_PATIENCE, self._close)
            self._timer.daemon = True
            self._timer.start()

    def take_events(self, events: dict[int, int]) -> None:
        """Ends the simulation if ESC is among the key events that the script has read."""
        if self._timer is not None and ESCAPE in events:
            self._timer.cancel()
            self._close()

    def cancel(self) -> None:
        """Stops waiting for the script, because the simulation has ended in another way."""
        if self._timer is not None:
            self._timer.cancel()
