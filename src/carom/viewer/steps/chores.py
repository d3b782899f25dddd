"""What pages ask to be done to a world, between two of its steps."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable
from typing import Any

_log = logging.getLogger("carom")
# How long to wait for a world that is stepping before the chores are put off to the next frame [s].
_PATIENCE = 0.02


class Chores:
    """Functions that wait for the lock of a world. Safe to use from all threads.

    Args:
        lock: Held by whoever steps or changes the world.
    """

    def __init__(self, lock: Any) -> None:
        self._world_lock = lock
        self._waiting: deque[Callable[[], None]] = deque()

    def add(self, chore: Callable[[], None]) -> None:
        """Does something as soon as nobody steps the world; one that fails is logged."""
        self._waiting.append(chore)

    def do(self) -> None:
        """Does what waits; if the world is busy, the next time."""
        if not self._waiting or not self._world_lock.acquire(timeout=_PATIENCE):
            return
        try:
            while self._waiting:
                self._try(self._waiting.popleft())
        finally:
            self._world_lock.release()

    @staticmethod
    def _try(chore: Callable[[], None]) -> None:
        try:
            chore()
        except Exception:
            _log.exception("A request from the page has failed.")
