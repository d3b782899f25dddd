"""Timing profiles, of scripts that ask for one and of users who hold a key down."""

from __future__ import annotations

import json
from pathlib import Path
from time import perf_counter_ns

from pybullet._clients.log_file import LogFile


class TimingLog:
    """A timing profile for Chrome or Perfetto, of steps and of zones named by scripts.

    `_0.json` is appended to its path, since PyBullet appends the number of the thread.
    """

    def __init__(self, path: Path) -> None:
        self._file = LogFile(Path(f"{path}_0.json"))
        self._events: list[str] = []
        self._start = perf_counter_ns()

    def before_step(self) -> None:
        """Records the beginning of a step."""
        self.begin("stepSimulation")

    def after_step(self) -> None:
        """Records the end of a step."""
        self.end("stepSimulation")

    def begin(self, name: str) -> None:
        """Records the beginning of a zone."""
        self._add("B", name)

    def end(self, name: str) -> None:
        """Records the end of a zone."""
        self._add("E", name)

    def _add(self, phase: str, name: str) -> None:
        now = (perf_counter_ns() - self._start) / 1000.0
        event = {"cat": "timing", "pid": 1, "tid": 0, "ts": now, "ph": phase, "name": name, "args": {}}
        self._events.append(json.dumps(event))

    def close(self) -> None:
        """Writes the file."""
        events = ",\n".join(self._events)
        self._file.write(f'{{"traceEvents":[\n{events}\n],\n"displayTimeUnit": "ns"}}'.encode())
        self._file.close()
