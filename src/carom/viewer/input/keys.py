"""Keys as PyBullet reports them: codes, and their events since the last query."""

from __future__ import annotations

from collections import defaultdict
from threading import Lock
from time import monotonic

from carom.native.uninterrupted import uninterrupted

DOWN, TRIGGERED, RELEASED = 1, 2, 4
# A script that has read the keys within this time is expected to read them again [s].
_ATTENTION = 1.0

# Keys without a character, by their names in browser events; those of both rows have successive codes.
_FUNCTION_KEYS = [f"F{number}" for number in range(1, 16)]
_OTHER_KEYS = (
    "ArrowLeft ArrowRight ArrowUp ArrowDown PageUp PageDown End Home Insert Delete "
    "Backspace Shift Control Alt Enter"
)
_NAMED = {name: code for code, name in enumerate([*_FUNCTION_KEYS, *_OTHER_KEYS.split()], 65280)}
_NAMED |= {"Escape": 27, "Tab": 9}


def key_code(key: str, place: str) -> int | None:
    """PyBullet's code of a key; None for keys without a code.

    Letters have the code of the lower-case character, and digits that of the digit, regardless of Shift and
    Caps Lock. `key` and `place` are `key` and `code` of the browser's event.
    """
    if key in _NAMED:
        return _NAMED[key]
    if place.startswith("Digit") and place[5:].isdecimal():
        return ord(place[5])
    if len(key) == 1:
        lower = key.lower()
        return ord(lower) if len(lower) == 1 else ord(key)
    return None


class Keyboard:
    """The keys of all pages together. Safe to use from all threads."""

    def __init__(self) -> None:
        self._lock = Lock()
        # Codes of the keys held on each page; a key is up if no page holds it.
        self._held: defaultdict[int, dict[str, int]] = defaultdict(dict)
        self._states: dict[int, int] = {}
        self._asked = -_ATTENTION

    @property
    def is_asked(self) -> bool:
        """Whether a script reads the keys regularly."""
        return monotonic() - self._asked < _ATTENTION

    def press(self, page: int, key: str, place: str) -> None:
        """Records a key press on a page; repeats of a held key are ignored."""
        code = key_code(key, place)
        if code is None:
            return
        with uninterrupted, self._lock:
            if not self._is_held(code):
                self._states[code] = self._states.get(code, 0) | DOWN | TRIGGERED
            self._held[page][place or key] = code

    def release(self, page: int, key: str, place: str) -> None:
        """Records a key release on a page."""
        with uninterrupted, self._lock:
            code = self._held[page].pop(place or key, None)
            if code is not None:
                self._let_go(code)

    def release_all(self, page: int) -> None:
        """Releases all keys of a page that has lost the focus or was closed: it reports no more releases."""
        with uninterrupted, self._lock:
            for code in self._held.pop(page, {}).values():
                self._let_go(code)

    def events(self) -> dict[int, int]:
        """Events since the last call, by key: the sum of `DOWN`, `TRIGGERED` and `RELEASED`.

        A key that was pressed and released between two calls is triggered and released.
        """
        self._asked = monotonic()
        with uninterrupted, self._lock:
            states = self._states
            self._states = {code: DOWN for code, state in states.items() if state & DOWN}
            return states

    def _is_held(self, code: int) -> bool:
        return any(code in held.values() for held in self._held.values())

    def _let_go(self, code: int) -> None:
        if not self._is_held(code):
            self._states[code] = self._states.get(code, 0) & ~DOWN | RELEASED
