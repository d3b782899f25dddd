"""The viewer of a world: its page, and everything a page and a script tell each other."""

from __future__ import annotations

import os
import sys
import webbrowser
from collections.abc import Callable
from math import isfinite
from threading import RLock, Timer
from typing import TYPE_CHECKING, Any

from carom.description.pose import Vector3
from carom.viewer.board import Board
from carom.viewer.camera import SharedCamera
from carom.viewer.controls import Controls
from carom.viewer.drawings import Drawings
from carom.viewer.gate import Gate
from carom.viewer.hands import Hands
from carom.viewer.keys import Keyboard
from carom.viewer.mouse import Mouse
from carom.viewer.pictures import Pictures
from carom.viewer.previews import Previews
from carom.viewer.probes import Probes
from carom.viewer.scene_feed import SceneFeed
from carom.viewer.server import PageServer

if TYPE_CHECKING:
    from carom.world import World

_MOST_PLOTS = 16
# How long a page that goes may keep the server from letting go of what it held [s].
_PATIENCE = 1.0
# How long a script waits for pages to draw what it wants to be seen [s].
_DRAWING_PATIENCE = 0.1
# A page of the last run that is still open connects again within this time [s].
_RECONNECTION = 1.5


class Viewer:
    """Shows a world in the browser.

    Args:
        world: The world.
        lock: Held by whoever steps the world, or adds and removes bodies. Without one the mouse cannot pull
            bodies, and `Viewer.lock` has to be held while bodies come and go.
        host: Address to listen on; this machine alone unless told otherwise.
        port: Port to listen on; None for the usual one or, where that is taken, any.
        title: Of the page.
        width: Of the image in pixels, until a page tells what it has room for.
        height: Of the image.

    Raises:
        OSError: The address cannot be listened on.

    Attributes:
        lock: Held while bodies are looked at.
        controls: Sliders and buttons.
        drawings: What scripts draw.
        keyboard: Keys.
        mouse: Mouse events.
        camera: The camera.
        previews: What the last camera image of a script shows.
        gate: Whether the simulation is paused.
        is_open: False once a user has closed the viewer.
        on_hold: Called, from the thread of the server, with whether steps have to ask `gate` first: while
            the simulation is paused, and once the viewer is closed.
    """

    def __init__(
        self,
        world: World,
        lock: Any = None,
        *,
        host: str = "127.0.0.1",
        port: int | None = None,
        title: str = "Carom",
        width: int = 1024,
        height: int = 768,
    ) -> None:
        self.is_open: bool = True
        self.on_hold: Callable[[bool], None] = lambda held: None
        self._board = Board()
        self._board.put("title", {"type": "title", "title": title})
        self.controls: Controls = Controls(self._board)
        self.drawings: Drawings = Drawings(self._board)
        self.camera: SharedCamera = SharedCamera(self._board, width, height)
        self.keyboard: Keyboard = Keyboard()
        self.mouse: Mouse = Mouse()
        self.gate: Gate = Gate()
        self._pictures = Pictures()
        # Pulling makes constraints, which only whoever steps can allow.
        self._pulls = lock is not None
        self.lock: Any = RLock() if lock is None else lock
        self._feed = SceneFeed(world, self.lock, self._board)
        self.previews: Previews = Previews(self._board)
        self._world = world
        self._hands = Hands(world, self.lock)
        self._probes = Probes(world)
        # What each page wants to know besides: whether collision shapes, and which joints.
        self._collisions: dict[int, bool] = {}
        self._plotted: dict[int, set[tuple[int, int]]] = {}
        self.pause(False)
        self._answers: dict[str, Callable[[int, dict[str, Any]], None]] = {
            "slider": lambda page, told: self.controls.move(int(told["slider"]), float(told["value"])),
            "press": lambda page, told: self.controls.press(int(told["slider"])),
            "key": self._take_key,
            "blur": lambda page, told: self.keyboard.release_all(page),
            "mouse": self._take_mouse,
            "camera": self._take_camera,
            "size": self._take_size,
            "visible": lambda page, told: self._pictures.show(page, visible=bool(told["visible"])),
            "drawn": lambda page, told: self._pictures.drawn(page, int(told["picture"])),
            "want": self._take_wish,
            "plot": self._take_plots,
            "grasp": self._take_grasp,
            "pull": lambda page, told: self._hands.move(page, _vector(told["target"])),
            "let go": lambda page, told: self._hands.release(page),
            "pause": lambda page, told: self.pause(bool(told["paused"])),
            "step": lambda page, told: self.gate.let_through(),
            "close": lambda page, told: self._close_by_user(),
        }
        self._server = PageServer(host, port, self._board, self._frame, self._receive, self._page_gone)

    @property
    def address(self) -> str:
        """Where the page is."""
        return self._server.address

    @property
    def page_count(self) -> int:
        """How many pages are open."""
        return self._server.page_count

    def configure(self, options: dict[str, Any]) -> None:
        """Shows the scene as these options say; see `Options` in `page/options.js`."""
        self._board.put("options", {"type": "options", **options})

    def pause(self, paused: bool) -> None:
        """Holds the simulation, or lets it go on."""
        if paused:
            self.gate.close()
        else:
            self.gate.open()
        self.on_hold(paused)
        self._board.put("pause", {"type": "pause", "paused": paused})

    def draw_now(self) -> None:
        """Returns when all pages that can be seen have drawn the world as it is now.

        It waits for no longer than a tenth of a second: pages are drawn when their browser has time.
        """
        if self.page_count:
            self._pictures.wait(self._server.page_numbers, _DRAWING_PATIENCE)

    def open_browser(self) -> None:
        """Opens the page where there is a display, unless one of the last run is still open."""
        if not has_display():
            return

        def open_unless_watched() -> None:
            if self.is_open and not self.page_count:
                webbrowser.open(self.address)

        timer = Timer(_RECONNECTION, open_unless_watched)
        timer.daemon = True
        timer.start()

    def _repr_html_(self) -> str:
        """The page, for notebooks."""
        return f'<iframe src="{self.address}" style="width:100%;height:520px;border:0"></iframe>'

    def close(self) -> None:
        """Ends it: pages say that the simulation is over."""
        self.is_open = False
        self.gate.open()
        self._server.stop()

    def _frame(self) -> bytes | None:
        self.drawings.expire()
        self._hands.apply()
        extras: dict[str, Any] = {"picture": self._pictures.asked}
        if self._plotted:
            extras["joints"] = self._probes.samples()
        return self._feed.frame(extras)

    def _receive(self, page: int, told: dict[str, Any]) -> None:
        self._answers[told["type"]](page, told)

    def _page_gone(self, page: int) -> None:
        self.keyboard.release_all(page)
        self._pictures.forget(page)
        self._collisions.pop(page, None)
        self._plot(page, set())
        self._feed.collisions = any(self._collisions.values())
        self._hands.release(page)
        self._hands.apply(_PATIENCE)

    def _take_key(self, page: int, told: dict[str, Any]) -> None:
        change = self.keyboard.press if told["down"] else self.keyboard.release
        change(page, str(told["key"]), str(told["code"]))

    def _take_mouse(self, page: int, told: dict[str, Any]) -> None:
        x, y = float(told["x"]), float(told["y"])
        if "button" in told:
            self.mouse.button(x, y, int(told["button"]), down=bool(told["down"]))
        else:
            self.mouse.move(x, y)

    def _take_camera(self, page: int, told: dict[str, Any]) -> None:
        x, y, z = _vector(told["target"])
        distance, yaw, pitch = (float(told[name]) for name in ("distance", "yaw", "pitch"))
        if all(map(isfinite, (x, y, z, distance, yaw, pitch))) and distance > 0.0:
            self.camera.moved(distance, yaw, pitch, (x, y, z))

    def _take_size(self, page: int, told: dict[str, Any]) -> None:
        width, height = int(told["width"]), int(told["height"])
        if min(width, height) > 0:
            self.camera.resized(width, height)

    def _take_wish(self, page: int, told: dict[str, Any]) -> None:
        self._collisions[page] = bool(told["collisions"])
        self._feed.collisions = any(self._collisions.values())

    def _take_plots(self, page: int, told: dict[str, Any]) -> None:
        self._plot(page, {(int(body), int(joint)) for body, joint in told["joints"][:_MOST_PLOTS]})

    def _plot(self, page: int, joints: set[tuple[int, int]]) -> None:
        if joints:
            self._plotted[page] = joints
        else:
            self._plotted.pop(page, None)
        # Nobody may step while the observers of the world change.
        with self.lock:
            self._probes.watch(set().union(*self._plotted.values()))

    def _take_grasp(self, page: int, told: dict[str, Any]) -> None:
        point, target = _vector(told["point"]), _vector(told["target"])
        if self._pulls:
            self._hands.take(page, int(told["body"]), int(told["link"]), point, target)

    def _close_by_user(self) -> None:
        self.is_open = False
        self.gate.open()
        self.on_hold(True)


def _vector(values: Any) -> Vector3:
    x, y, z = map(float, values)
    return (x, y, z)


def has_display() -> bool:
    """Whether a browser could show something here, and somebody would look."""
    if "CI" in os.environ:
        return False
    if sys.platform in ("win32", "darwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
