"""The interface of a graphical window, between the drop-in and a viewer."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from carom.native.change import Change

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from carom.description.pose import Vector3
    from carom.engine.queries.ray_cast import Points, RayTuple
    from carom.render.image_target import RawImage
    from carom.viewer.items import DebugItem, Slider
    from pybullet._window.options import VisualizerOptions

NO_ITEM = -1
"""Id of items that are not shown."""


class Window:
    """The interface of a window; by itself no window: nothing is drawn, and there is no user input.

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

    def wait_for_turn(self) -> bool:
        """Waits while the simulation is paused; returns whether a step may be made.

        False means that the script polls user input and there is some: it should read it, and call again.
        """
        return True

    def has_turn(self) -> bool:
        """Whether a step may be made now; it then counts as made."""
        return True

    def is_open(self) -> bool:
        """False after the user has closed it: the client then counts as disconnected."""
        return True

    def close(self) -> None:
        """Closes the window."""

    def draw(self, item: DebugItem, replaced: int) -> int:
        """Shows an item, which replaces item `replaced` unless that is negative; returns its id."""
        return NO_ITEM

    def add_slider(self, slider: Slider) -> int:
        """Shows a slider or a button; returns its id."""
        return NO_ITEM

    def slider_value(self, item: int) -> float | None:
        """The value set by the user; None if there is no such slider."""
        return None

    def remove(self, item: int) -> None:
        """Removes an item or slider; unknown ids are ignored."""

    @contextmanager
    def without_drawings(self) -> Iterator[Callable[[Change], None]]:
        """Gives a function that notes the removal of all lines, texts and points, but not of sliders.

        The change has to be made within this context.
        """
        yield _note_nothing

    def remove_drawings(self) -> None:
        """Removes all lines, texts and points, but not sliders."""
        with self.without_drawings() as note:
            change = Change()
            note(change)
            change.commit()

    def remove_sliders(self) -> None:
        """Removes all sliders."""

    def colour_link(self, body: int, link: int, colour: Vector3 | None) -> None:
        """Colours the wireframe of a link; None restores its own colour."""

    def key_events(self) -> dict[int, int]:
        """States of keys since the last call, `KEY_*` bits by key code."""
        return {}

    def mouse_events(self) -> Sequence[tuple[int, float, float, int, int]]:
        """Mouse events since the last call: type, x, y, button, state."""
        return ()

    def configure(self, changes: VisualizerOptions) -> None:
        """Changes the options that are not None, and the given flags."""

    def draw_now(self) -> None:
        """Waits until the present state is drawn."""

    def move_camera(self, distance: float, yaw: float, pitch: float, target: Vector3) -> None:
        """Moves the camera; angles in degrees."""

    def show_image(self, image: RawImage, view: NDArray[np.float64], projection: NDArray[np.float64]) -> None:
        """Shows an image of the script; `camera` is its projection matrix times view matrix, shape (4, 4)."""

    def show_rays(self, starts: Points, ends: Points, hits: Sequence[RayTuple]) -> None:
        """Shows rays that the script has cast, and their hits."""

    def camera_info(self) -> tuple[int | float | tuple[float, ...], ...]:
        """The 12 fields of `getDebugVisualizerCamera`."""
        vector, matrix = (0.0,) * 3, (0.0,) * 16
        return (0, 0, matrix, matrix, vector, vector, vector, vector, 0.0, 0.0, 0.0, vector)


def _note_nothing(_change: Change) -> None:
    """There is nothing to remove."""
