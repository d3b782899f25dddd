"""What `add_button` and the like return: controls, images and plots of people's own."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from math import isfinite
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from carom.viewer.protocol import to_page

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.viewer.input.controls import Controls
    from carom.viewer.items import Slider
    from carom.viewer.panels.calls import Calls
    from carom.viewer.protocol.message import Message

Value = float | int | bool | str
Called = Callable[["Control"], Any]
"""What is called with a control when a user has changed it."""


class Parts(Protocol):
    """What has the controls, and shows them on pages.

    Attributes:
        controls: Values that users set.
        calls: Callbacks that wait for their thread.
        plot: Adds a value to a plot, by its name.
    """

    controls: Controls
    calls: Calls
    plot: Callable[[str, float], None]

    def show(
        self, number: int, panel: int | None, kind: Message, facts: dict[str, Any], payload: bytes = b""
    ) -> None:
        """Show a part on all pages."""
        ...

    def remove(self, number: int) -> None:
        """Take a part away."""
        ...


class Control:
    """A control in the window: a button, a slider, a list, a checkbox or a text.

    Attributes:
        name: Its label.
    """

    def __init__(self, parts: Parts, number: int, name: str, changed: Called | None) -> None:
        self.name: str = name
        self._parts = parts
        self._number = number
        self._changed = changed
        self._gone = False

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name!r}: {self.value!r}>"

    @property
    def value(self) -> Any:
        """What it shows: the clicks of a button, the number of a slider, the text of a list or a field.

        Setting it shows the new value on all pages, and calls no callback.

        Raises:
            ValueError: It cannot have that value.
        """
        raise NotImplementedError

    @value.setter
    def value(self, value: Any) -> None:
        raise NotImplementedError

    def on_change(self, called: Called) -> Called:
        """Calls a function, with this, when a user has changed it; also as a decorator.

        It is called in a thread of its own, one after the other with those of other controls.
        """
        self._changed = called
        return called

    def remove(self) -> None:
        """Removes it from all pages."""
        self._gone = True
        self._parts.remove(self._number)

    def _tell(self, key: Any = None) -> None:
        """A user has changed it; changes with the same key may become one call."""
        called = self._changed
        if called is not None and not self._gone:
            self._parts.calls.put((self._number, key), lambda: called(self))


class Number(Control):
    """A button, a slider, a list or a checkbox."""

    def __init__(self, parts: Parts, number: int, slider: Slider, changed: Called | None) -> None:
        super().__init__(parts, number, slider.name, changed)
        self._slider = slider

    @property
    def value(self) -> Value:
        """Clicks of a button, number of a slider, text of a list, whether a checkbox is checked."""
        slider = self._slider
        options = getattr(slider, "options", None)
        if options is None:
            return int(slider.value) if slider.is_button else slider.value
        return options[int(slider.value)] if options else slider.value != 0.0

    @value.setter
    def value(self, value: Value) -> None:
        slider = self._slider
        options = getattr(slider, "options", None)
        if options:
            if value not in options:
                raise ValueError(
                    f"{self.name!r} has to be one of {', '.join(map(repr, options))}, not {value!r}"
                )
            value = options.index(value)
        number = float(value)
        if not (isfinite(number) and (slider.is_button or slider.lower <= number <= slider.upper)):
            raise ValueError(f"{self.name!r} has to be from {slider.lower} to {slider.upper}, not {value!r}")
        self._parts.controls.put(self._number, number)


class Text(Control):
    """A text, which users can edit unless it is for reading only."""

    def __init__(
        self,
        parts: Parts,
        number: int,
        panel: int | None,
        name: str,
        text: str,
        changed: Called | None,
        *,
        editable: bool,
    ) -> None:
        super().__init__(parts, number, name, changed)
        self._text = str(text)
        self._editable = editable
        self._panel = panel
        self._show()

    @property
    def value(self) -> str:
        """The text."""
        return self._text

    @value.setter
    def value(self, value: str) -> None:
        self._text = str(value)
        self._show()

    def take(self, text: str) -> None:
        """A user has typed it."""
        if self._editable:
            self._text = text
            self._show()
            self._tell()

    def _show(self) -> None:
        if not self._gone:
            facts = {"text": self._text, "editable": self._editable}
            self._parts.show(self._number, self._panel, to_page.FIELD, {"name": self.name, **facts})


class Image(Control):
    """An image, beside the others in its panel."""

    def __init__(self, parts: Parts, number: int, panel: int | None, name: str, image: ArrayLike) -> None:
        super().__init__(parts, number, name, None)
        self._panel = panel
        self.value = image

    @property
    def value(self) -> np.ndarray:
        """The image, (height, width, 3) uint8."""
        return self._image

    @value.setter
    def value(self, value: ArrayLike) -> None:
        self._image = _pixels(self.name, value)
        if not self._gone:
            height, width = self._image.shape[:2]
            facts = {"name": self.name, "width": width, "height": height}
            self._parts.show(self._number, self._panel, to_page.IMAGE, facts, _png(self._image))

    def __repr__(self) -> str:
        return f"<Image {self.name!r}: {self._image.shape[1]} x {self._image.shape[0]}>"


class Plot:
    """A plotted value, which is there to choose in *Plots*.

    Attributes:
        name: Its name.
    """

    def __init__(self, parts: Parts, name: str) -> None:
        self.name: str = name
        self._parts = parts

    def add(self, value: float) -> None:
        """Sets its value from now on.

        Raises:
            ValueError: The value is not a finite number.
        """
        self._parts.plot(self.name, value)


def _pixels(name: str, value: ArrayLike) -> np.ndarray:
    """An image as bytes, a copy; grey and transparent ones, and numbers from 0 to 1, are images as well."""
    image = np.asarray(value)
    if image.dtype.kind == "f":
        if not np.isfinite(image).all():
            raise ValueError(f"image {name!r} has values that are not finite")
        image = np.clip(255.0 * image + 0.5, 0.0, 255.0).astype(np.uint8)
    if image.ndim == 2:
        image = np.repeat(image[..., np.newaxis], 3, axis=2)
    if image.dtype != np.uint8 or image.ndim != 3 or image.shape[2] not in (3, 4) or not image.size:
        raise ValueError(
            f"image {name!r} needs the shape (height, width), or with 3 or 4 channels, of bytes or numbers "
            f"from 0 to 1, not {image.dtype} of shape {image.shape}"
        )
    return image[..., :3].copy()


def _png(image: np.ndarray) -> bytes:
    from PIL import Image as Pillow

    file = BytesIO()
    Pillow.fromarray(image).save(file, "png", compress_level=1)
    return file.getvalue()
