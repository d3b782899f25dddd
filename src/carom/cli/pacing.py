"""Sleeping that keeps a script in step with real time, which a recording has no need of."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread


class Pacing:
    """Whether the script has stepped since it slept last: then its next sleep is skipped.

    Only that sleep: a script that waits for something else, or for a simulation in real time, which steps in
    another thread, sleeps as it says.
    """

    def __init__(self) -> None:
        self._stepped = False

    def step(self) -> None:
        """Note a step."""
        if current_thread() is main_thread():
            self._stepped = True

    @contextmanager
    def skipping(self) -> Iterator[None]:
        """Skip such sleeps of the main thread while the context lasts."""
        sleep = time.sleep

        def sleep_unless_pacing(seconds: float, /) -> None:
            if current_thread() is not main_thread() or not self._stepped:
                sleep(seconds)
                return
            self._stepped = False
            # Which still refuses what is no time.
            sleep(min(seconds, 0.0))

        time.sleep = sleep_unless_pacing
        try:
            yield
        finally:
            time.sleep = sleep
