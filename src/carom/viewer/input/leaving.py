"""Closing a simulation: at once by the close button, or by ESC after the script has seen the key."""

from __future__ import annotations

from collections.abc import Callable
from threading import Timer

ESCAPE = 27
# How long a script that asks for keys may take to see ESC before the window closes anyway [s].
_PATIENCE = 1.0


class Leaving:
    """Ends a simulation when the user presses ESC. Safe to use from all threads.

    PyBullet closes its window within a frame of ESC, and a loop that asks for keys may see the key before.
    Here a script that asks for keys always gets the key first.

    Args:
        close: Ends the simulation; called once or more.
    """

    def __init__(self, close: Callable[[], None]) -> None:
        self._close = close
        self._timer: Timer | None = None

    @property
    def pending(self) -> bool:
        """Whether ESC was pressed, and the script has not seen it yet."""
        return self._timer is not None

    def escape(self, *, listening: bool) -> None:
        """The user has pressed ESC.

        Args:
            listening: The script asks for keys.
        """
        if not listening:
            self._close()
        elif self._timer is None:
            self._timer = Timer(_PATIENCE, self._close)
            self._timer.daemon = True
            self._timer.start()

    def told(self, events: dict[int, int]) -> None:
        """The script has read these keys."""
        if self._timer is not None and ESCAPE in events:
            self._timer.cancel()
            self._close()

    def cancel(self) -> None:
        """The simulation has ended in another way."""
        if self._timer is not None:
            self._timer.cancel()
