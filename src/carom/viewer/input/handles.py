"""Frames that the user moves with the mouse."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from threading import Lock
from typing import Any

from carom.native.uninterrupted import uninterrupted
from carom.viewer.items import Handle
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.protocol import to_page


class Handles:
    """Handles by number, among the latest messages. Safe to use from all threads."""

    def __init__(self, latest: LatestMessages) -> None:
        self._latest = latest
        self._handles: dict[int, Handle] = {}
        self._told: dict[int, Callable[[Handle], None]] = {}
        self._lock = Lock()
        self._next = 0

    def add(
        self,
        name: str,
        position: Sequence[float],
        orientation: Sequence[float],
        moved: Callable[[Handle], None] | None = None,
    ) -> Handle:
        """Adds a handle and shows it; `moved` is called when a user has moved it.

        See `Handle.move_to` for its pose and errors.
        """
        with uninterrupted, self._lock:
            number = self._next
            self._next += 1
        handle = Handle(name, ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)), partial(self._show, number))
        self._handles[number] = handle
        if moved is not None:
            self._told[number] = moved
        try:
            handle.move_to(position, orientation)
        except ValueError:
            del self._handles[number]
            raise
        return handle

    def move(self, number: int, position: Sequence[float], orientation: Sequence[float]) -> None:
        """Sets the pose of a handle, moved by the user; unknown handles and invalid poses are ignored."""
        if number in self._handles:
            handle = self._handles[number]
            with suppress(ValueError):
                handle.move_to(position, orientation)
                if number in self._told:
                    self._told[number](handle)

    def take(self, page: int, message: dict[str, Any]) -> None:
        """Sets the pose of a handle, by the message of a page."""
        position = tuple(map(float, message["position"]))
        self.move(int(message["handle"]), position, tuple(map(float, message["orientation"])))

    def _show(self, number: int) -> None:
        handle = self._handles[number]
        position, orientation = handle.pose
        header = to_page.HANDLE(handle=number, name=handle.name, position=position, orientation=orientation)
        self._latest.put(("handle", number), header)
