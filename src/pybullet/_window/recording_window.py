"""A window without a screen: the base class for viewers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from carom.description.pose import Vector3
from carom.viewer.items import DebugItem, Slider
from pybullet._calls.constants import COV_ENABLE_Y_AXIS_UP
from pybullet._maths.camera_maths import Y_UP, Z_UP
from pybullet._window.options import DebugCamera, VisualizerOptions
from pybullet._window.window import Window

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from carom.render.image_target import RawImage


class RecordingWindow(Window):
    """A window without a screen, which stores the script's items.

    Attributes:
        items: Lines, texts and points by id.
        sliders: Sliders and buttons by id; ids are shared with `items`.
        colours: Wireframe colours by body and link.
        options: The options set by `configureDebugVisualizer`.
        camera: The camera.
    """

    def __init__(self, width: int = 1024, height: int = 768) -> None:
        self.items: dict[int, DebugItem] = {}
        self.sliders: dict[int, Slider] = {}
        self.colours: dict[tuple[int, int], Vector3] = {}
        self.options = VisualizerOptions()
        self.camera = DebugCamera(width, height, distance=5.0, yaw=50.0, pitch=-35.0)
        self._next_item = 0
        self._open = True

    def is_open(self) -> bool:
        return self._open

    def close(self) -> None:
        self._open = False

    def wait_for_turn(self) -> bool:
        return True

    def has_turn(self) -> bool:
        return True

    def draw(self, item: DebugItem, replaced: int) -> int:
        identifier = replaced if replaced >= 0 else self._new_identifier()
        self.items[identifier] = item
        return identifier

    def add_slider(self, slider: Slider) -> int:
        identifier = self._new_identifier()
        self.sliders[identifier] = slider
        return identifier

    def slider_value(self, item: int) -> float | None:
        slider = self.sliders.get(item)
        return None if slider is None else slider.value

    def remove(self, item: int) -> None:
        self.items.pop(item, None)
        self.sliders.pop(item, None)

    def remove_drawings(self) -> None:
        self.items.clear()
        # Ids start again after those of sliders, which are kept.
        self._next_item = max(self.sliders, default=-1) + 1

    def remove_sliders(self) -> None:
        self.sliders.clear()

    def colour_link(self, body: int, link: int, colour: Vector3 | None) -> None:
        if colour is None:
            self.colours.pop((body, link), None)
        else:
            self.colours[body, link] = colour

    def key_events(self) -> dict[int, int]:
        return {}

    def mouse_events(self) -> Sequence[tuple[int, float, float, int, int]]:
        return ()

    def configure(self, changes: VisualizerOptions) -> None:
        for name in VisualizerOptions.__slots__:
            value = getattr(changes, name)
            if name == "flags":
                self.options.flags.update(value)
            elif value is not None:
                setattr(self.options, name, value)
        self.background = self.options.background
        if COV_ENABLE_Y_AXIS_UP in changes.flags:
            self.camera.up_axis = Y_UP if changes.flags[COV_ENABLE_Y_AXIS_UP] else Z_UP

    def draw_now(self) -> None:
        """Does nothing."""

    def move_camera(self, distance: float, yaw: float, pitch: float, target: Vector3) -> None:
        camera = self.camera
        camera.distance, camera.yaw, camera.pitch, camera.target = distance, yaw, pitch, target

    def show_image(self, image: RawImage, camera: NDArray[np.float64]) -> None:
        """Does nothing."""

    def camera_info(self) -> tuple[int | float | tuple[float, ...], ...]:
        return self.camera.info()

    def _new_identifier(self) -> int:
        identifier = self._next_item
        self._next_item += 1
        return identifier
