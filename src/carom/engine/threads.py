"""Threads that run native functions in parallel."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from concurrent.futures import ThreadPoolExecutor

# To wake up another thread takes about as long as the kinematics of so many worlds.
WORLDS_PER_THREAD = 64


class Threads:
    """Runs functions that release the GIL, each in a thread of its own.

    Args:
        count: Number of functions.
    """

    def __init__(self, count: int) -> None:
        self._count = count
        self._pool: ThreadPoolExecutor | None = None
        self._process = os.getpid()

    def run(self, functions: Sequence[Callable[[], None]]) -> None:
        """Run all functions, one of them in this thread, and return when all have ended."""
        first, *others = functions
        if not others:
            first()
            return
        if self._pool is None or self._process != os.getpid():
            from concurrent.futures import ThreadPoolExecutor

            # A forked process does not have the threads of its parent.
            self._pool = ThreadPoolExecutor(self._count - 1, "carom-worlds")
            self._process = os.getpid()
        started = [self._pool.submit(function) for function in others]
        try:
            first()
        finally:
            for thread in started:
                thread.result()
