"""Mouse events as PyBullet reports them."""

from __future__ import annotations

from collections import deque

from carom.viewer.input.keys import DOWN, RELEASED, TRIGGERED

MOVED, CLICKED = 1, 2
_NO_BUTTON = -1
# Limit for scripts that never read the events; others read them many times a second.
_MAX_EVENTS = 1000

MouseEvent = tuple[int, float, float, int, int]


class Mouse:
    """Motions and clicks of the mouse on all pages. Safe to use from all threads."""

    def __init__(self) -> None:
        self._events: deque[MouseEvent] = deque(maxlen=_MAX_EVENTS)

    def move(self, x: float, y: float) -> None:
        """Records a motion of the mouse to a pixel, counted from the upper left corner."""
        self._events.append((MOVED, x, y, _NO_BUTTON, 0))

    def button(self, x: float, y: float, button: int, *, down: bool) -> None:
        """Records the press or release of a button: 0 left, 1 middle, 2 right."""
        self._events.append((CLICKED, x, y, button, DOWN | TRIGGERED if down else RELEASED))

    def events(self) -> list[MouseEvent]:
        """Type, x, y, button and state of the events since the last call."""
        events = []
        while self._events:
            events.append(self._events.popleft())
        return events
