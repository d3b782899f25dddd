"""Callbacks of controls, in a thread of their own."""

from __future__ import annotations

import logging
from collections.abc import Callable, Hashable
from queue import SimpleQueue
from threading import Lock, Thread, current_thread
from typing import Any

from carom.native.uninterrupted import uninterrupted

_log = logging.getLogger("carom")
_PATIENCE = 5.0


class Calls:
    """Calls what users have set off, one after the other. Safe to use from all threads.

    A slider that moves on while its callback runs is called once more, with where it is then. Errors are
    logged, and the next callback is called.
    """

    def __init__(self) -> None:
        self._lock = Lock()
        self._due: SimpleQueue[Hashable] = SimpleQueue()
        self._waiting: dict[Hashable, Callable[[], Any]] = {}
        self._thread: Thread | None = None
        self._stopped = False

    def put(self, key: Hashable, call: Callable[[], Any]) -> None:
        """Calls a function soon; in place of one of the same key that still waits."""
        with uninterrupted, self._lock:
            if self._stopped:
                return
            fresh = key not in self._waiting
            self._waiting[key] = call
            if self._thread is None:
                self._thread = Thread(target=self._run, name="carom callbacks", daemon=True)
                self._thread.start()
        if fresh:
            self._due.put(key)

    def stop(self) -> None:
        """Calls nothing any more, once the callback that runs has ended."""
        with uninterrupted, self._lock:
            self._stopped = True
            self._waiting.clear()
            thread = self._thread
        self._due.put(None)
        if thread is not None and thread is not current_thread():
            thread.join(_PATIENCE)

    def _run(self) -> None:
        while (key := self._due.get()) is not None:
            with uninterrupted, self._lock:
                call = self._waiting.pop(key, None)
            if call is None:
                continue
            try:
                call()
            except Exception:
                _log.exception("A callback of the window has failed.")
