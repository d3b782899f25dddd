"""The controls, texts and images of people's own, by number, among the latest messages."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from carom.viewer.items import Slider
from carom.viewer.panels.calls import Calls
from carom.viewer.panels.control import Called, Image, Number, Text
from carom.viewer.protocol import to_page

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.viewer.input.controls import Controls
    from carom.viewer.latest_messages import LatestMessages
    from carom.viewer.protocol.message import Message

_TEXTS = {to_page.FIELD: ("field", to_page.NO_FIELD), to_page.IMAGE: ("image", to_page.NO_IMAGE)}


class Parts:
    """What people have added to the panel. Safe to use from all threads.

    Attributes:
        controls: Sliders, buttons, lists and checkboxes.
        calls: Callbacks.
        plot: Sets a plotted value.
    """

    def __init__(
        self, latest: LatestMessages, controls: Controls, plot: Callable[[str, float], None]
    ) -> None:
        self._latest = latest
        self._kinds: dict[int, tuple[str, Message]] = {}
        self._texts: dict[int, Text] = {}
        self.controls: Controls = controls
        self.calls: Calls = Calls()
        self.plot: Callable[[str, float], None] = plot

    def add(self, panel: int | None, slider: Slider, changed: Called | None) -> Number:
        """Adds a slider, a button, a list or a checkbox, to a panel or to the page's own."""
        number = self.controls.free_number()
        control = Number(self, number, slider, changed)
        # Each click is a call.
        key = (lambda: slider.value) if slider.is_button else (lambda: None)
        self.controls.add(number, slider, panel, lambda: control._tell(key()))
        return control

    def add_text(
        self, panel: int | None, name: str, text: str, changed: Called | None, *, editable: bool
    ) -> Text:
        """Adds a text."""
        number = self.controls.free_number()
        field = Text(self, number, panel, name, text, changed, editable=editable)
        self._texts[number] = field
        return field

    def add_image(self, panel: int | None, name: str, image: ArrayLike) -> Image:
        """Adds an image."""
        return Image(self, self.controls.free_number(), panel, name, image)

    def add_panel(self, title: str) -> int:
        """Adds a panel; returns its number."""
        number = self.controls.free_number()
        self._latest.put(("panel", number), to_page.PANEL(panel=number, title=title))
        return number

    def remove_panel(self, number: int) -> None:
        """Removes a panel, with what is in it on the pages."""
        self._latest.remove(("panel", number), to_page.NO_PANEL(panel=number))

    def show(
        self, number: int, panel: int | None, kind: Message, facts: dict[str, Any], payload: bytes = b""
    ) -> None:
        """Shows a text or an image on all pages."""
        self._kinds[number] = name, _ = _TEXTS[kind]
        where = {} if panel is None else {"panel": panel}
        self._latest.put((name, number), kind(**{name: number}, **where, **facts), payload)

    def remove(self, number: int) -> None:
        """Removes a part."""
        self._texts.pop(number, None)
        kind = self._kinds.pop(number, None)
        if kind is None:
            self.controls.remove(number)
        else:
            name, gone = kind
            self._latest.remove((name, number), gone(**{name: number}))

    def take_text(self, page: int, message: dict[str, Any]) -> None:
        """A user has typed a text."""
        field = self._texts.get(int(message["field"]))
        if field is not None:
            field.take(str(message["text"]))
