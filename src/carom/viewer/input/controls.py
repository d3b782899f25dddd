"""Sliders, buttons, choices and checkboxes of the panel."""

from __future__ import annotations

from math import isfinite

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

    def add(self, number: int, slider: Slider) -> None:
        """Shows a slider or a button."""
        self.sliders[number] = slider
        self._show(number, slider)

    def remove(self, number: int) -> None:
        """Removes a slider or a button; unknown numbers are ignored."""
        self.sliders.pop(number, None)
        self._latest.remove(("slider", number), to_page.NO_SLIDER(slider=number))

    def move(self, number: int, value: float) -> None:
        """Sets the value of a slider that the user has moved, clipped to its range."""
        slider = self.sliders.get(number)
        if slider is not None and not slider.is_button and isfinite(value):
            within = min(max(value, slider.lower), slider.upper)
            slider.value = float(round(within)) if isinstance(slider, Choice) else within
            self._show(number, slider)

    def press(self, number: int) -> None:
        """Counts a click of the user on a button."""
        slider = self.sliders.get(number)
        if slider is not None and slider.is_button:
            slider.value += 1.0
            self._show(number, slider)

    def _show(self, number: int, slider: Slider) -> None:
        header = to_page.SLIDER(
            slider=number,
            name=slider.name,
            button=slider.is_button,
            lower=slider.lower,
            upper=slider.upper,
            value=slider.value,
            **({"options": slider.options} if isinstance(slider, Choice) else {}),
        )
        self._latest.put(("slider", number), header)
