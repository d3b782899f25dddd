"""How far a recording has got, for whoever waits for it."""

from __future__ import annotations

from time import monotonic
from typing import TextIO

# Time between two reports [s]: on a terminal, whose line is written over, and elsewhere.
_OFTEN = 0.2
_SELDOM = 5.0


class Progress:
    """Reports simulated time while a script is recorded.

    Args:
        stream: Where to write.
        seconds: Simulated time after which the script is ended [s]; None if it ends by itself.
    """

    def __init__(self, stream: TextIO, seconds: float | None) -> None:
        self._stream = stream
        self._of = "" if seconds is None else f" of {seconds:g}"
        self._rewrites = stream.isatty()
        self._interval = _OFTEN if self._rewrites else _SELDOM
        self._due = 0.0
        self._elapsed = 0.0
        self._shown = False

    def show(self, elapsed: float) -> None:
        """Report the simulated time of a world so far [s], if a report is due; the longest of several."""
        self._elapsed = max(self._elapsed, elapsed)
        now = monotonic()
        if now < self._due:
            return
        self._due = now + self._interval
        self._write(f"Recorded {self._elapsed:.1f}{self._of} s of simulated time; Ctrl-C ends it")

    def end(self) -> None:
        """Leave the line that is written over."""
        if self._shown and self._rewrites:
            self._stream.write("\n")
            self._stream.flush()

    def _write(self, sentence: str) -> None:
        self._stream.write(f"\r{sentence}" if self._rewrites else f"{sentence}\n")
        self._stream.flush()
        self._shown = True
