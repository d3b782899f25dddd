"""Gamepads that are plugged in where a page is open."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from threading import Lock
from typing import Any

from carom.native.uninterrupted import uninterrupted

# No gamepad has more axes or buttons; a page cannot fill the memory.
_MAX_PARTS = 64
_MAX_GAMEPADS = 8


@dataclass(frozen=True, slots=True)
class Gamepad:
    """The state of a gamepad, as the browser reports it.

    Attributes:
        name: What the browser calls it.
        axes: Positions of the sticks, from -1 to 1. In the standard layout these are the left stick's (to the
            right, downwards), then the right one's.
        buttons: How far each button is pressed, from 0 to 1; without a sensor for it 0 or 1. In the standard
            layout these are the four at the right hand (lower, right, left, upper), the two upper shoulder
            buttons (left, right), the two triggers below them, and others.
        standard: Whether the browser knows the gamepad, and axes and buttons have the standard layout.
    """

    name: str
    axes: tuple[float, ...] = ()
    buttons: tuple[float, ...] = ()
    standard: bool = False

    def pressed(self, button: int) -> bool:
        """Whether a button is pressed at least half; one that the gamepad does not have is not."""
        return 0 <= button < len(self.buttons) and self.buttons[button] >= 0.5


class Gamepads:
    """The gamepads of all pages. Safe to use from all threads."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._pads: dict[int, list[Gamepad]] = {}

    def take(self, page: int, message: dict[str, Any]) -> None:
        """Sets the gamepads of a page, by its message."""
        pads = [
            Gamepad(
                str(pad["name"]),
                _numbers(pad["axes"], -1.0),
                _numbers(pad["buttons"], 0.0),
                bool(pad["standard"]),
            )
            for pad in message["gamepads"][:_MAX_GAMEPADS]
        ]
        with uninterrupted, self._lock:
            self._pads[page] = pads

    def forget(self, page: int) -> None:
        """Drops the gamepads of a page that has been closed."""
        with uninterrupted, self._lock:
            self._pads.pop(page, None)

    def all(self) -> list[Gamepad]:
        """The present state of all gamepads, those of the page that was opened first at the beginning."""
        with uninterrupted, self._lock:
            return [pad for page in sorted(self._pads) for pad in self._pads[page]]


def _numbers(message: list[Any], lower: float) -> tuple[float, ...]:
    values = [float(value) for value in message[:_MAX_PARTS]]
    return tuple(min(max(value, lower), 1.0) if isfinite(value) else 0.0 for value in values)
