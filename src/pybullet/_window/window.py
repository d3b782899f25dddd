"""What a script can ask of a graphical interface: the seam between the drop-in and a viewer.

A viewer is a subclass of `Window`: `PageWindow`, in a module of its own. Two are here: `NoWindow` for clients
without one, and `RecordingWindow`, which keeps what the script shows and answers from that: sliders stay at
their start values and nobody presses a key.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import hypot
from typing import TYPE_CHECKING

from carom.description.pose import Vector3
from carom.viewer.items import DebugItem, DebugLine, DebugPoints, DebugText, Slider
from pybullet._calls.constants import COV_ENABLE_Y_AXIS_UP
from pybullet._maths.camera_maths import (
    Y_UP,
    Z_UP,
    Matrix16,
    cross,
    frustum,
    look_at,
    orbit,
    subtracted,
    unit,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from carom.queries.ray_cast import Points, RayHit

__all__ = [
    "NO_ITEM",
    "DebugCamera",
    "DebugItem",
    "DebugLine",
    "DebugPoints",
    "DebugText",
    "NoWindow",
    "RecordingWindow",
    "Slider",
    "VisualizerOptions",
    "Window",
]

NO_ITEM = -1
_NEAR, _FAR = 0.01, 1000.0
# Length of the image's edges as `getDebugVisualizerCamera` reports them, for rays through its pixels.
_RAY_PLANE = 20000.0


@dataclass(slots=True)
class DebugCamera:
    """The camera of the window: it circles a target; angles in degrees."""

    width: int = 0
    height: int = 0
    distance: float = 0.0
    yaw: float = 0.0
    pitch: float = 0.0
    target: Vector3 = (0.0, 0.0, 0.0)
    up_axis: int = Z_UP

    def info(self) -> tuple[int | float | tuple[float, ...], ...]:
        """The 12 fields of `getDebugVisualizerCamera`."""
        aspect = self.width / self.height
        eye, _ = orbit(self.target, self.distance, self.yaw, self.pitch, 0.0, self.up_axis)
        up = (0.0, 1.0, 0.0) if self.up_axis == Y_UP else (0.0, 0.0, 1.0)
        forward = unit(subtracted(self.target, eye)) or (1.0, 0.0, 0.0)
        # Straight up or down there is no horizontal direction; any will do.
        right = unit(cross(forward, up)) or (1.0, 0.0, 0.0)
        upward = cross(right, forward)
        return (
            self.width,
            self.height,
            look_at(eye, self.target, up) or look_at(eye, self.target, upward) or (0.0,) * 16,
            self._projection(aspect),
            up,
            forward,
            _scaled(right, _RAY_PLANE * aspect),
            _scaled(upward, _RAY_PLANE / hypot(*upward)),
            self.yaw,
            self.pitch,
            self.distance,
            self.target,
        )

    def _projection(self, aspect: float) -> Matrix16:
        return frustum(-aspect * _NEAR, aspect * _NEAR, -_NEAR, _NEAR, _NEAR, _FAR)


@dataclass(slots=True)
class VisualizerOptions:
    """What `configureDebugVisualizer` sets; None where the script said nothing.

    Attributes:
        flags: On or off by `COV_*` number.
    """

    flags: dict[int, bool] = field(default_factory=dict)
    light_position: Vector3 | None = None
    shadow_map_resolution: int | None = None
    shadow_map_world_size: int | None = None
    shadow_map_intensity: float | None = None
    remote_sync_transform_interval: float | None = None
    background: Vector3 | None = None


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
    def show_image(
        self, rgba: NDArray[np.uint8], depth: NDArray[np.float32], labels: NDArray[np.int32]
    ) -> None:
        """Shows what a camera image of the script shows; see `getCameraImage` for the arrays."""

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

    def show_image(
        self, rgba: NDArray[np.uint8], depth: NDArray[np.float32], labels: NDArray[np.int32]
    ) -> None:
        """Nobody would see it."""

    def camera_info(self) -> tuple[int | float | tuple[float, ...], ...]:
        vector, matrix = (0.0,) * 3, (0.0,) * 16
        return (0, 0, matrix, matrix, vector, vector, vector, vector, 0.0, 0.0, 0.0, vector)


class RecordingWindow(Window):
    """A window without a screen: it keeps what the script shows.

    Attributes:
        items: Lines, texts and points by id.
        sliders: Sliders and buttons by id; ids are shared with `items`.
        colours: Wireframe colours by body and link.
        options: What `configureDebugVisualizer` has set.
        camera: Where the camera is.
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
        # Ids start again as far as no slider has them.
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
        """Nobody would see it."""

    def move_camera(self, distance: float, yaw: float, pitch: float, target: Vector3) -> None:
        camera = self.camera
        camera.distance, camera.yaw, camera.pitch, camera.target = distance, yaw, pitch, target

    def show_image(
        self, rgba: NDArray[np.uint8], depth: NDArray[np.float32], labels: NDArray[np.int32]
    ) -> None:
        """Nobody would see it."""

    def camera_info(self) -> tuple[int | float | tuple[float, ...], ...]:
        return self.camera.info()

    def _new_identifier(self) -> int:
        identifier = self._next_item
        self._next_item += 1
        return identifier


def _scaled(v: Vector3, factor: float) -> Vector3:
    return (v[0] * factor, v[1] * factor, v[2] * factor)
