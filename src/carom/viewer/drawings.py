"""Lines, points and texts that scripts draw."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock
from time import monotonic
from typing import Any

import numpy as np

from carom.native.change import Change
from carom.native.uninterrupted import uninterrupted
from carom.viewer.items import DebugItem, DebugLine, DebugPoints, DebugText
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.protocol import to_page


class Drawings:
    """Drawn items by number, among the latest messages. Safe to use from all threads.

    Attributes:
        items: The items shown now, by number.
    """

    def __init__(self, latest: LatestMessages) -> None:
        self._latest = latest
        self._lock = Lock()
        self._ends: dict[int, float] = {}
        # Those that pages have been told of.
        self._shown: set[int] = set()
        self.items: dict[int, DebugItem] = {}

    def draw(self, number: int, item: DebugItem) -> None:
        """Shows an item, replacing one of the same number."""
        with uninterrupted, self._lock:
            self.items[number] = item
            self._ends.pop(number, None)
            if item.life_time > 0.0:
                self._ends[number] = monotonic() + item.life_time
            self._shown.add(number)
            header, payload = _described(number, item)
            self._latest.put(("item", number), header, payload)

    def remove(self, number: int) -> None:
        """Removes an item; unknown numbers are ignored."""
        with uninterrupted, self._lock:
            self._remove(number)
            self._tell()

    @contextmanager
    def changing(self) -> Iterator[None]:
        """No other thread changes items while a change is made that `note_clear` belongs to."""
        with uninterrupted, self._lock:
            try:
                yield
            finally:
                self._tell()

    def note_clear(self, change: Change) -> None:
        """Removes all items with a change, which is made within `changing`."""
        change.refill(self.items, {})
        change.refill(self._ends, {})

    def expire(self) -> None:
        """Removes items whose life time has passed."""
        if not self._ends and len(self._shown) == len(self.items):
            return
        with uninterrupted, self._lock:
            now = monotonic()
            for number in [number for number, end in self._ends.items() if end <= now]:
                self._remove(number)
            self._tell()

    def _remove(self, number: int) -> None:
        self.items.pop(number, None)
        self._ends.pop(number, None)

    def _tell(self) -> None:
        """Tells pages what is gone; if that is broken off, the next frame does it."""
        for number in self._shown - self.items.keys():
            self._latest.remove(("item", number), to_page.NO_ITEM(item=number))
            self._shown.discard(number)


def _described(number: int, item: DebugItem) -> tuple[dict[str, Any], bytes]:
    at = {"item": number, "body": item.parent_body, "link": item.parent_link + 1}
    if isinstance(item, DebugLine):
        return to_page.LINE(**at, start=item.start, end=item.end, colour=item.colour, width=item.width), b""
    if isinstance(item, DebugText):
        look = {"colour": item.colour, "size": item.size, "orientation": item.orientation}
        return to_page.TEXT(**at, text=item.text, position=item.position, **look), b""
    assert isinstance(item, DebugPoints)
    payload = np.array([item.positions, item.colours], dtype="<f4").tobytes()
    return to_page.POINTS(**at, size=item.size, count=len(item.positions)), payload
