"""The interface of a graphical window, between the drop-in and a viewer.

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
"""Id of items that are not shown."""


class Window(ABC):
    """A graphical interface.

    Attributes:
        held: Whether steps have to call `wait_for_turn` or `has_turn` first; the user may close the window
            while they wait.
        background: The plain background colour set by the script; None for the sky.
    """

    held = False
    background: Vector3 | None = None

    @property
    def speed(self) -> float | None:
        """Speed set by the user: simulated time / real time; None if not set."""
        return None

    @abstractmethod
    def wait_for_turn(self) -> bool:
        """Waits while the simulation is paused; returns whether a step may be made.

        False means that the script polls user input and there is some: it should read it, and call again.
        """

    @abstractmethod
    def has_turn(self) -> bool:
        """Whether a step may be made now; it then counts as made."""

    @abstractmethod
    def is_open(self) -> bool:
        """False after the user has closed it: the client then counts as disconnected."""

    @abstractmethod
    def close(self) -> None:
        """Closes the window."""

    @abstractmethod
    def draw(self, item: DebugItem, replaced: int) -> int:
        """Shows an item, which replaces item `replaced` unless that is negative; returns its id."""

    @abstractmethod
    def add_slider(self, slider: Slider) -> int:
        """Shows a slider or a button; returns its id."""

    @abstractmethod
    def slider_value(self, item: int) -> float | None:
        """The value set by the user; None if there is no such slider."""

    @abstractmethod
    def remove(self, item: int) -> None:
        """Removes an item or slider; unknown ids are ignored."""

    @abstractmethod
    def remove_drawings(self) -> None:
        """Removes all lines, texts and points, but not sliders."""

    @abstractmethod
    def remove_sliders(self) -> None:
        """Removes all sliders."""

    @abstractmethod
    def colour_link(self, body: int, link: int, colour: Vector3 | None) -> None:
        """Colours the wireframe of a link; None restores its own colour."""

    @abstractmethod
    def key_events(self) -> dict[int, int]:
        """States of keys since the last call, `KEY_*` bits by key code."""

    @abstractmethod
    def mouse_events(self) -> Sequence[tuple[int, float, float, int, int]]:
        """Mouse events since the last call: type, x, y, button, state."""

    @abstractmethod
    def configure(self, changes: VisualizerOptions) -> None:
        """Changes the options that are not None, and the given flags."""

    @abstractmethod
    def draw_now(self) -> None:
        """Waits until the present state is drawn."""

    @abstractmethod
    def move_camera(self, distance: float, yaw: float, pitch: float, target: Vector3) -> None:
        """Moves the camera; angles in degrees."""

    @abstractmethod
    def show_image(self, image: RawImage, camera: NDArray[np.float64]) -> None:
        """Shows a camera image that the script has rendered.

        Args:
            image: The image.
            camera: Projection matrix times view matrix of the image, as in OpenGL; shape (4, 4).
        """

    def show_rays(  # noqa: B027 (most windows do not show them)
        self, starts: Points, ends: Points, hits: Sequence[RayHit]
    ) -> None:
        """Shows rays that the script has cast, and their hits."""

    @abstractmethod
    def camera_info(self) -> tuple[int | float | tuple[float, ...], ...]:
        """The 12 fields of `getDebugVisualizerCamera`."""


class NoWindow(Window):
    """No graphical interface: nothing is drawn, and there is no user input."""

    def is_open(self) -> bool:
        return True

    def close(self) -> None:
        """Does nothing."""

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
        """Does nothing."""

    def remove_drawings(self) -> None:
        """Does nothing."""

    def remove_sliders(self) -> None:
        """Does nothing."""

    def colour_link(self, body: int, link: int, colour: Vector3 | None) -> None:
        """Does nothing."""

    def key_events(self) -> dict[int, int]:
        return {}

    def mouse_events(self) -> Sequence[tuple[int, float, float, int, int]]:
        return ()

    def configure(self, changes: VisualizerOptions) -> None:
        """Does nothing."""

    def draw_now(self) -> None:
        """Does nothing."""

    def move_camera(self, distance: float, yaw: float, pitch: float, target: Vector3) -> None:
        """Does nothing."""

    def show_image(self, image: RawImage, camera: NDArray[np.float64]) -> None:
        """Does nothing."""

    def camera_info(self) -> tuple[int | float | tuple[float, ...], ...]:
        vector, matrix = (0.0,) * 3, (0.0,) * 16
        return (0, 0, matrix, matrix, vector, vector, vector, vector, 0.0, 0.0, 0.0, vector)
