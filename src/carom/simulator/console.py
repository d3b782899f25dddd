"""The console of the simulator: warnings, errors, and what of the files is not simulated."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Iterable
from threading import Lock

from carom.formats.reading.ignored import Ignored
from carom.viewer.simulation.panel import ShownLine, SimulationPanel

_LOGGER = "carom"
_MAX_LINES = 200


class Console:
    """Keeps the newest lines and shows them on the pages. Safe to use from all threads.

    Warnings and errors that Carom logs are lines of it, from `listen` to `close`.

    Args:
        panel: Where they are shown.
    """

    def __init__(self, panel: SimulationPanel) -> None:
        self._panel = panel
        self._lock = Lock()
        self._lines: deque[ShownLine] = deque(maxlen=_MAX_LINES)
        self._ignored: list[ShownLine] = []
        self._handler = _Handler(self)
        self._show()

    def listen(self) -> None:
        """Takes what Carom logs from now on."""
        logging.getLogger(_LOGGER).addHandler(self._handler)

    def close(self) -> None:
        """Takes nothing any more that Carom logs."""
        logging.getLogger(_LOGGER).removeHandler(self._handler)

    @property
    def lines(self) -> list[ShownLine]:
        """What is shown: first what of the files is not simulated, then the other lines, the oldest first."""
        with self._lock:
            return [*self._ignored, *self._lines]

    def say(self, level: str, text: str) -> None:
        """Adds a line; one that is as the last one counts it."""
        with self._lock:
            last = self._lines[-1] if self._lines else None
            if last is not None and (last.level, last.text) == (level, text):
                self._lines[-1] = ShownLine(level, text, last.count + 1)
            else:
                self._lines.append(ShownLine(level, text))
        self._show()

    def show_ignored(self, ignored: Iterable[Ignored]) -> None:
        """Shows what of the present files is not simulated, instead of what was told of others."""
        lines = [ShownLine("ignored", _told(it)) for it in ignored if it.effect != "nothing"]
        with self._lock:
            self._ignored = lines
        self._show()

    def _show(self) -> None:
        self._panel.show_console(self.lines)


class _Handler(logging.Handler):
    def __init__(self, console: Console) -> None:
        super().__init__(logging.WARNING)
        self._console = console

    def emit(self, record: logging.LogRecord) -> None:
        level = "error" if record.levelno >= logging.ERROR else "warning"
        text = record.getMessage()
        if record.exc_info and record.exc_info[1] is not None:
            text = f"{text} {type(record.exc_info[1]).__name__}: {record.exc_info[1]}"
        self._console.say(level, text)


def _told(one: Ignored) -> str:
    attributes = f" {', '.join(one.attributes)}" if one.attributes else ""
    times = f" ({one.count} times)" if one.count > 1 else ""
    where = f"{one.file.name}:{one.line}"
    return f"{one.element}{attributes}{times}, {where}, touches {one.effect}: {one.consequence}; {one.reason}"
