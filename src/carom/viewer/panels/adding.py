"""The methods by which people add controls of their own, to the page's panel or to panels of their own."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from carom.viewer.items import Handle, Slider, box_of, list_of, slider_of
from carom.viewer.panels.control import Called, Control, Image, Number, Plot, Text

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.viewer.input.handles import Handles
    from carom.viewer.panels.parts import Parts


class Adding:
    """Adds controls. Safe to use from all threads; callbacks are called in a thread of their own."""

    _parts: Parts
    _handles: Handles
    _panel: int | None = None

    def add_button(self, name: str, on_click: Called | None = None) -> Number:
        """Adds a button; its `value` counts the clicks, and each calls `on_click` with the control."""
        return self._keep(self._parts.add(self._panel, Slider(name, 1.0, 0.0, 0.0), on_click))

    def add_slider(
        self,
        name: str,
        lower: float,
        upper: float,
        start: float | None = None,
        on_change: Called | None = None,
    ) -> Number:
        """Adds a slider; it starts at the lower bound unless `start` says otherwise.

        Raises:
            ValueError: A number is not finite, or not lower < upper with the start between them.
        """
        slider = slider_of(name, lower, upper, lower if start is None else start)
        return self._keep(self._parts.add(self._panel, slider, on_change))

    def add_dropdown(
        self, name: str, options: Iterable[str], start: str | None = None, on_change: Called | None = None
    ) -> Number:
        """Adds a list of texts, of which one is chosen: its `value`; the first one unless stated.

        Raises:
            ValueError: There are no texts, or `start` is none of them.
        """
        texts = tuple(map(str, options))
        if start is not None and start not in texts:
            raise ValueError(f"list {name!r} has {', '.join(map(repr, texts)) or 'no texts'}, not {start!r}")
        choice = list_of(name, texts, 0 if start is None else texts.index(start))
        return self._keep(self._parts.add(self._panel, choice, on_change))

    def add_checkbox(self, name: str, start: bool = False, on_change: Called | None = None) -> Number:
        """Adds a checkbox; its `value` says whether it is checked."""
        return self._keep(self._parts.add(self._panel, box_of(name, start), on_change))

    def add_text(
        self, name: str, text: str = "", on_change: Called | None = None, *, editable: bool = True
    ) -> Text:
        """Adds a line of text; one that is `editable` is set by Enter, or by leaving the field."""
        return self._keep(self._parts.add_text(self._panel, name, text, on_change, editable=editable))

    def add_image(self, name: str, image: ArrayLike) -> Image:
        """Adds an image; setting its `value` shows another one.

        Args:
            name: Its label.
            image: (height, width), or (height, width, 3 or 4): bytes, or numbers from 0 to 1.

        Raises:
            ValueError: It is no image.
        """
        return self._keep(self._parts.add_image(self._panel, name, image))

    def add_plot(self, name: str) -> Plot:
        """A value to plot over time, which is chosen in *Plots*; its `add` sets it."""
        return Plot(self._parts, name)

    def add_frame(
        self,
        name: str,
        position: Sequence[float] = (0.0, 0.0, 0.0),
        orientation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
        on_change: Callable[[Handle], Any] | None = None,
    ) -> Handle:
        """Adds a frame in the scene, which users move with the mouse.

        Args:
            name: Its label.
            position: [m], in the world.
            orientation: A quaternion (x, y, z, w).
            on_change: Called with the handle when a user has moved it.

        Raises:
            ValueError: The numbers are not a position and a quaternion.
        """
        calls = self._parts.calls

        if on_change is None:
            return self._handles.add(name, tuple(position), tuple(orientation))
        told = on_change

        def moved(handle: Handle) -> None:
            calls.put(("handle", id(handle)), lambda: told(handle))

        return self._handles.add(name, tuple(position), tuple(orientation), moved)

    def _keep(self, control: Any) -> Any:
        """Takes note of what was added."""
        return control


class Panel(Adding):
    """A panel of people's own: a section that folds, and that users can take out of the page's panel.

    Attributes:
        title: Its title, by which the browser remembers where it is.
    """

    def __init__(self, parts: Parts, handles: Handles, title: str) -> None:
        self.title: str = title
        self._parts = parts
        self._handles = handles
        self._panel = parts.add_panel(title)
        self._kept: list[Control] = []

    def __repr__(self) -> str:
        return f"<Panel {self.title!r} with {len(self._kept)} controls>"

    def remove(self) -> None:
        """Removes it with all that is in it."""
        for control in self._kept:
            control.remove()
        self._kept.clear()
        if self._panel is not None:
            self._parts.remove_panel(self._panel)

    def _keep(self, control: Any) -> Any:
        self._kept.append(control)
        return control
