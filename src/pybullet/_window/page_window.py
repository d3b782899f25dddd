"""The window as a page in the browser."""

from __future__ import annotations

import errno
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import fields
from math import isfinite
from pathlib import Path
from tempfile import gettempdir
from threading import main_thread
from typing import TYPE_CHECKING, Any
from weakref import ref

from carom.description.pose import Vector3
from carom.native.change import Change
from carom.viewer.items import DebugItem, Slider
from pybullet._calls.constants import COV_ENABLE_Y_AXIS_UP
from pybullet._calls.errors import fail
from pybullet._calls.options import named_values
from pybullet._maths.camera_maths import Y_UP, Z_UP
from pybullet._window.options import VisualizerOptions, camera_info
from pybullet._window.window import Window

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from carom.engine.queries.ray_cast import Points, RayTuple
    from carom.render.image_target import RawImage
    from carom.viewer.viewer import Viewer
    from pybullet._clients.clients import Client

# Integer options, and their minimum.
_COUNTS = {"width": 1, "height": 1, "port": 0, "history": 0}
_MEGABYTE = 2**20
_PAUSED = (
    "The simulation is paused in the window. Continue it there (button or key i); Ctrl-C ends the script."
)
_GOES_ON = "The simulation continues."
# Value of a colour component that is not given, or is not a number.
_DEFAULT_SHADE = 0.8


class PageWindow(Window):
    """A window that shows the world and the items of a client in a viewer.

    Attributes:
        viewer: The viewer that serves the page.
        items: Lines, texts and points by id.
        sliders: Sliders and buttons by id; ids are shared with `items`.
        colours: Wireframe colours by body and link.
        options: The options set by `configureDebugVisualizer`.
    """

    def __init__(self, viewer: Viewer, client: Client) -> None:
        self.viewer = viewer
        self._client = ref(client)
        self.items = viewer.drawings.items
        self.sliders = viewer.controls.sliders
        self.colours: dict[tuple[int, int], Vector3] = {}
        self.options = VisualizerOptions()
        self._next_item = 0
        # Simulated time at which the script last read user input.
        self._asked = -1.0
        # Of the quick calls, which leave all calls to Python while the window holds steps up.
        self._record = client.bodies.quick.record
        viewer.on_hold = self._hold
        self._hold(viewer.held)
        viewer.on_pause = self._say_pause
        viewer.on_profile = self._profile
        self._profiles = 0
        self._profile_log: int | None = None

    def is_open(self) -> bool:
        return self.viewer.is_open

    def close(self) -> None:
        self.viewer.close()

    @property
    def speed(self) -> float | None:
        return self.viewer.pause_control.speed

    def wait_for_turn(self) -> bool:
        return self.viewer.wait_for_turn(listening=self._asked == self.viewer.time)

    def has_turn(self) -> bool:
        return self.viewer.has_turn()

    def draw(self, item: DebugItem, replaced: int) -> int:
        self.viewer.drawings.expire()
        identifier = replaced if replaced >= 0 else self._new_identifier()
        self.viewer.drawings.draw(identifier, item)
        return identifier

    def add_slider(self, slider: Slider) -> int:
        identifier = self._new_identifier()
        self.viewer.controls.add(identifier, slider)
        return identifier

    def remove(self, item: int) -> None:
        self.viewer.drawings.remove(item)
        self.viewer.controls.remove(item)

    @contextmanager
    def without_drawings(self) -> Iterator[Callable[[Change], None]]:
        with self.viewer.drawings.changing():
            yield self._note_no_drawings

    def _note_no_drawings(self, change: Change) -> None:
        self.viewer.drawings.note_clear(change)
        # Ids start again after those of sliders, which are kept.
        change.set(self, "_next_item", max(self.sliders, default=-1) + 1)

    def remove_sliders(self) -> None:
        for item in list(self.sliders):
            self.viewer.controls.remove(item)

    def colour_link(self, body: int, link: int, colour: Vector3 | None) -> None:
        if colour is None:
            self.colours.pop((body, link), None)
        else:
            self.colours[body, link] = colour
        self._show_options()

    def slider_value(self, item: int) -> float | None:
        self._asked = self.viewer.time
        slider = self.sliders.get(item)
        return None if slider is None else slider.value

    def key_events(self) -> dict[int, int]:
        self._asked = self.viewer.time
        return self.viewer.key_events()

    def mouse_events(self) -> Sequence[tuple[int, float, float, int, int]]:
        self._asked = self.viewer.time
        return self.viewer.mouse.events()

    def configure(self, changes: VisualizerOptions) -> None:
        self.options.flags.update(changes.flags)
        for option in fields(changes):
            value = getattr(changes, option.name)
            if option.name != "flags" and value is not None:
                setattr(self.options, option.name, value)
        self.background = self.options.background
        self._show_options()

    def draw_now(self) -> None:
        self.viewer.draw_now()

    def move_camera(self, distance: float, yaw: float, pitch: float, target: Vector3) -> None:
        self.viewer.camera.move(distance, yaw, pitch, target)

    def show_rays(self, starts: Points, ends: Points, hits: Sequence[RayTuple]) -> None:
        if self.viewer.rays.wanted:
            self.viewer.rays.tell(starts, ends, hits)

    def show_image(self, image: RawImage, view: NDArray[np.float64], projection: NDArray[np.float64]) -> None:
        self.viewer.show_image(image, view, projection)

    def camera_info(self) -> tuple[int | float | tuple[float, ...], ...]:
        return camera_info(self.viewer.camera.orbit, self._up_axis)

    @property
    def _up_axis(self) -> int:
        return Y_UP if self.options.flags.get(COV_ENABLE_Y_AXIS_UP) else Z_UP

    def _new_identifier(self) -> int:
        identifier = self._next_item
        self._next_item += 1
        return identifier

    def _hold(self, held: bool) -> None:
        self.held = held
        self._record.is_held = held

    def _profile(self, running: bool) -> None:
        """Writes a timing profile while the key p is held."""
        from pybullet._clients.timing_log import TimingLog

        client = self._client()
        if client is None:
            return
        with client.call_lock:
            if running and self._profile_log is None:
                self._profiles += 1
                path = Path(gettempdir(), f"timings_{self._profiles}")
                self._profile_log = client.logs.start(client.world, TimingLog(path))
            elif not running and self._profile_log is not None:
                client.logs.stop(client.world, self._profile_log)
                self._profile_log = None
                print(f"Wrote {Path(gettempdir(), f'timings_{self._profiles}_0.json')}", flush=True)

    def _say_pause(self, paused: bool) -> None:
        # When Ctrl-C ends a paused script, its pages close, but the simulation does not continue.
        if main_thread().is_alive():
            print(_PAUSED if paused else _GOES_ON, flush=True)

    def _show_options(self) -> None:
        options = {field.name: getattr(self.options, field.name) for field in fields(self.options)}
        colours = [[body, link + 1, colour] for (body, link), colour in self.colours.items()]
        self.viewer.configure({**options, "up_axis": self._up_axis, "colours": colours})


def open_window(client: Client, options: str) -> PageWindow:
    """Opens a window that shows the world of a client, with options of `connect`.

    Raises:
        pybullet.error: The server cannot listen at the address, or the video cannot be written.
    """
    from carom.viewer.display import where_shown
    from carom.viewer.viewer import Viewer

    values: dict[str, str] = {}
    for name, value in named_values(options):
        if name not in _COUNTS or (value.isdecimal() and int(value) >= _COUNTS[name]):
            values[name] = value
    arguments: dict[str, Any] = {name: int(values[name]) for name in _COUNTS if name in values}
    if "history" in arguments:
        arguments["history"] *= _MEGABYTE
    arguments |= {name: values[name] for name in ("host", "token") if values.get(name)}
    if "names" in values:
        arguments["names"] = values["names"].split(",")
    try:
        viewer = Viewer(client.world, client.lock, title=_title(), **arguments)
    except OSError as problem:
        taken = problem.errno == errno.EADDRINUSE
        cure = (
            " Another program has this port: name another one, or none for any that is free." if taken else ""
        )
        fail("Cannot open the window:", f"{problem}.{cure}")
    client.window = window = PageWindow(viewer, client)
    background = [values.get(f"background_color_{name}") for name in ("red", "green", "blue")]
    if any(background):
        window.configure(VisualizerOptions(background=_colour(background)))
    if "mp4" in values:
        _film(client, values["mp4"].strip("\"'"), values.get("mp4fps", ""))
    print("\n".join(where_shown(viewer.address)), flush=True)
    viewer.open_browser()
    return window


def _title() -> str:
    """Title of the window: the name of the script."""
    from carom.viewer.notebook import in_notebook

    return "Carom" if in_notebook() else Path(sys.argv[0]).stem or "Carom"


def _film(client: Client, file: str, fps: str) -> None:
    from pybullet._window.film import PICTURES_PER_SECOND, film_of

    rate = int(fps) if fps.isdecimal() and int(fps) > 0 else PICTURES_PER_SECOND
    try:
        client.logs.start(client.world, film_of(client, Path(file), rate))
    except (ImportError, OSError) as problem:
        client.window.close()
        fail(f"Cannot write {file}:", f"{problem}.")


def _colour(parts: Sequence[str | None]) -> Vector3:
    red, green, blue = (_DEFAULT_SHADE if part is None else _number(part) for part in parts)
    return (red, green, blue)


def _number(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        return _DEFAULT_SHADE
    return value if isfinite(value) else _DEFAULT_SHADE
