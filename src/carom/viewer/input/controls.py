"""Sliders, buttons, choices and checkboxes of the panel."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from threading import Lock

from carom.native.uninterrupted import uninterrupted
from carom.viewer.items import Choice, Slider
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.protocol import to_page


class Controls:
    """Sliders and buttons by number, among the latest messages. Safe to use from all threads.

    Attributes:
        sliders: The sliders and buttons shown now, by number.
    """

    def __init__(self, latest: LatestMessages) -> None:
        self._latest = latest
        self.sliders: dict[int, Slider] = {}
        self._panels: dict[int, int | None] = {}
        self._changed: dict[int, Callable[[], None] | None] = {}
        self._lock = Lock()
        self._next = 0

    def free_number(self) -> int:
        """A number that no control has or has had."""
        with uninterrupted, self._lock:
            self._next = max(self._next, max(self.sliders, default=-1) + 1)
            self._next += 1
            return self._next - 1

    def add(
        self,
        number: int,
        slider: Slider,
        panel: int | None = None,
        changed: Callable[[], None] | None = None,
    ) -> None:
        """Shows a slider or a button; in a panel of its own, and calling `changed` when a user changes it."""
        self._panels[number], self._changed[number] = panel, changed
        self.sliders[number] = slider
        self._show(number, slider)

    def remove(self, number: int) -> None:
        """Removes a slider or a button; unknown numbers are ignored."""
        for facts in (self.sliders, self._panels, self._changed):
            facts.pop(number, None)
        self._latest.remove(("slider", number), to_page.NO_SLIDER(slider=number))

    def move(self, number: int, value: float) -> None:
        """Sets the value of a slider that the user has moved, clipped to its range."""
        slider = self.sliders.get(number)
        if slider is not None and not slider.is_button and isfinite(value):
            within = min(max(value, slider.lower), slider.upper)
            slider.value = float(round(within)) if isinstance(slider, Choice) else within
            self._show(number, slider)
            self._tell(number)

    def press(self, number: int) -> None:
        """Counts a click of the user on a button."""
        slider = self.sliders.get(number)
        if slider is not None and slider.is_button:
            slider.value += 1.0
            self._show(number, slider)
            self._tell(number)

    def put(self, number: int, value: float) -> None:
        """Sets the value of a control, by code; of one that is gone nothing is shown."""
        slider = self.sliders.get(number)
        if slider is not None:
            slider.value = value
            self._show(number, slider)

    def _tell(self, number: int) -> None:
        changed = self._changed.get(number)
        if changed is not None:
            changed()

    def _show(self, number: int, slider: Slider) -> None:
        header = to_page.SLIDER(
            slider=number,
            name=slider.name,
            button=slider.is_button,
            lower=slider.lower,
            upper=slider.upper,
            value=slider.value,
            **({"options": slider.options} if isinstance(slider, Choice) else {}),
            **({} if (panel := self._panels.get(number)) is None else {"panel": panel}),
        )
        self._latest.put(("slider", number), header)
