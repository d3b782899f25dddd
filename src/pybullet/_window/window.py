"""What a script can ask of a graphical interface: the seam between the drop-in and a viewer.

Viewers are subclasses of `Window`, such as `PageWindow`. `NoWindow` is for clients without one.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from carom.description.pose import Vector3
    from carom.queries.ray_cast import Points, RayHit
    from carom.render.image_target import RawImage
    from carom.viewer.items import DebugItem, Slider
    from pybullet._window.options import VisualizerOptions

NO_ITEM = -1
"""The id of what is not shown."""


class Window(ABC):
    """A graphical interface.

    Attributes:
        held: Steps have to ask `wait_for_turn` or `has_turn` first, and may find the window closed then.
        background: The plain background the script has asked for; None for the sky.
    """

    held = False
    background: Vector3 | None = None

    @property
    def speed(self) -> float | None:
        """Simulated time by real time that the user wants of the simulation; None if nothing was said."""
        return None

    @abstractmethod
    def wait_for_turn(self) -> bool:
        """Returns whether the user lets the simulation make a step, once that is known.

        False means that the user has done something that the script listens to: it is to look, and come back.
        """

    @abstractmethod
    def has_turn(self) -> bool:
        """Whether the user lets it make a step now; the step then counts as made."""

    @abstractmethod
    def is_open(self) -> bool:
        """False once the user has closed it: the client then counts as disconnected."""

    @abstractmethod
    def close(self) -> None:
        """Takes it off the screen."""

    @abstractmethod
    def draw(self, item: DebugItem, replaced: int) -> int:
        """Shows an item, in place of item `replaced` unless that is negative; returns its id."""

    @abstractmethod
    def add_slider(self, slider: Slider) -> int:
        """Shows a slider or a button; returns its id."""

    @abstractmethod
    def slider_value(self, item: int) -> float | None:
        """What the user has set; None when there is no such slider."""

    @abstractmethod
    def remove(self, item: int) -> None:
        """Takes one item or slider away; unknown ids do no harm."""

    @abstractmethod
    def remove_drawings(self) -> None:
        """Takes away every line, text and point, but no slider."""

    @abstractmethod
    def remove_sliders(self) -> None:
        """Takes away every slider."""

    @abstractmethod
    def colour_link(self, body: int, link: int, colour: Vector3 | None) -> None:
        """Colours the wireframe of a link; None gives it back its own colour."""

    @abstractmethod
    def key_events(self) -> dict[int, int]:
        """States of keys since the last call, `KEY_*` bits by key code."""

    @abstractmethod
    def mouse_events(self) -> Sequence[tuple[int, float, float, int, int]]:
        """Mouse events since the last call: type, x, y, button, state."""

    @abstractmethod
    def configure(self, changes: VisualizerOptions) -> None:
        """Changes the options that are not None, and the flags that are there."""

    @abstractmethod
    def draw_now(self) -> None:
        """Returns when the world is shown as it is now."""

    @abstractmethod
    def move_camera(self, distance: float, yaw: float, pitch: float, target: Vector3) -> None:
        """Moves the camera; angles in degrees."""

    @abstractmethod
    def show_image(self, image: RawImage, camera: NDArray[np.float64]) -> None:
        """Shows what a camera image of the script shows.

        Args:
            image: The image.
            camera: (4, 4) what takes points of the world to it, as OpenGL has it.
        """

    def show_rays(  # noqa: B027 (most windows do not show them)
        self, starts: Points, ends: Points, hits: Sequence[RayHit]
    ) -> None:
        """Shows rays that the script has cast, and what they hit."""

    @abstractmethod
    def camera_info(self) -> tuple[int | float | tuple[float, ...], ...]:
        """The 12 fields of `getDebugVisualizerCamera`."""


class NoWindow(Window):
    """No graphical interface: nothing is drawn, nothing comes back."""

    def is_open(self) -> bool:
        return True

    def close(self) -> None:
        """There is nothing to take off the screen."""

    def wait_for_turn(self) -> bool:
        return True

    def has_turn(self) -> bool:
        return True

    def draw(self, item: DebugItem, replaced: int) -> int:
        return NO_ITEM

    def add_slider(self, slider: Slider) -> int:
        return NO_ITEM

    def slider_value(self, item: int) -> float | None:
        return None

    def remove(self, item: int) -> None:
        """Nothing was drawn."""

    def remove_drawings(self) -> None:
        """Nothing was drawn."""

    def remove_sliders(self) -> None:
        """There are none."""

    def colour_link(self, body: int, link: int, colour: Vector3 | None) -> None:
        """Nobody would see it."""

    def key_events(self) -> dict[int, int]:
        return {}

    def mouse_events(self) -> Sequence[tuple[int, float, float, int, int]]:
        return ()

    def configure(self, changes: VisualizerOptions) -> None:
        """Nobody would see it."""

    def draw_now(self) -> None:
        """Nobody would see it."""

    def move_camera(self, distance: float, yaw: float, pitch: float, target: Vector3) -> None:
        """There is no camera."""

    def show_image(self, image: RawImage, camera: NDArray[np.float64]) -> None:
        """Nobody would see it."""

    def camera_info(self) -> tuple[int | float | tuple[float, ...], ...]:
        vector, matrix = (0.0,) * 3, (0.0,) * 16
        return (0, 0, matrix, matrix, vector, vector, vector, vector, 0.0, 0.0, 0.0, vector)
