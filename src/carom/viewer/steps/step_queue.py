"""Tasks requested by pages, run between two steps of a world."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable
from typing import Any

_log = logging.getLogger("carom")
# Maximum time to wait for a step to end; the queue is then left to the next frame [s].
_PATIENCE = 0.02


class StepQueue:
    """A queue of functions that need the lock of a world's steps. Safe to use from all threads."""

    def __init__(self, lock: Any) -> None:
        self._world_lock = lock
        self._waiting: deque[Callable[[], None]] = deque()

    def add(self, task: Callable[[], None]) -> None:
        """Queues a function to be run between steps; its errors are logged."""
        self._waiting.append(task)

    def run(self) -> None:
        """Runs the queue; if the world is busy, at the next call."""
        if not self._waiting or not self._world_lock.acquire(timeout=_PATIENCE):
            return
        try:
            while self._waiting:
                try:
                    self._waiting.popleft()()
                except Exception:
                    _log.exception("A request from the page has failed.")
        finally:
            self._world_lock.release()
