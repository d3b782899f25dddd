"""A line with the progress of a build."""

from __future__ import annotations

import time
from typing import TextIO

# On a terminal the line is written over; elsewhere, in a log, there is one now and then.
_TERMINAL_SECONDS = 0.25
_LOG_SECONDS = 5.0


class ProgressLine:
    """Shows the progress of a build.

    Args:
        stream: Where to; None for nowhere.
    """

    def __init__(self, stream: TextIO | None = None) -> None:
        self._stream = stream
        self._terminal = stream is not None and stream.isatty()
        self._start = self._last = time.monotonic()
        self._length = 0

    def show(self, doing: str, *, now: bool = False) -> None:
        """Show what is being done, at intervals.

        Args:
            doing: `compiling kernels 7/16`.
            now: At once.
        """
        time_now = time.monotonic()
        wait = _TERMINAL_SECONDS if self._terminal else _LOG_SECONDS
        if self._stream is None or (not now and time_now - self._last < wait):
            return
        self._last = time_now
        line = f"carom: {doing}, {time_now - self._start:.0f} s"
        if self._terminal:
            self._stream.write(f"\r{line.ljust(self._length)}")
            self._length = len(line)
        else:
            self._stream.write(f"{line}\n")
        self._stream.flush()

    def end(self) -> None:
        """Leave the line as it is and begin another."""
        if self._stream is not None and self._length:
            self._stream.write("\n")
            self._stream.flush()
            self._length = 0
