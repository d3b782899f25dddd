"""A line with the progress of a build."""

from __future__ import annotations

import time
from typing import TextIO

# Intervals between updates: on a terminal the line is overwritten, in a log each update is a new line.
_TERMINAL_SECONDS = 0.25
_LOG_SECONDS = 5.0


class ProgressLine:
    """Shows the progress of a build on a stream, if there is one."""

    def __init__(self, stream: TextIO | None = None) -> None:
        self._stream = stream
        self._terminal = stream is not None and stream.isatty()
        self._start = self._last = time.monotonic()
        self._length = 0

    def show(self, doing: str, *, now: bool = False) -> None:
        """Show the activity, such as `compiling kernels 7/16`, at most once in an interval, or `now`."""
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
        """End the line, so that later output begins on a new one."""
        if self._stream is not None and self._length:
            self._stream.write("\n")
            self._stream.flush()
            self._length = 0
