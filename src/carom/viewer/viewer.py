"""The viewer of a world: its page, and everything a page and a script tell each other."""

from __future__ import annotations

import os
import sys
import webbrowser
from collections.abc import Callable
from math import isfinite
from threading import Timer
from typing import TYPE_CHECKING, Any

from carom.viewer.board import Board
from carom.viewer.camera import SharedCamera
from carom.viewer.controls import Controls
from carom.viewer.drawings import Drawings
from carom.viewer.gate import Gate
from carom.viewer.keys import Keyboard
from carom.viewer.mouse import Mouse
from carom.viewer.scene_feed import SceneFeed
from carom.viewer.server import PageServer

if TYPE_CHECKING:
    from carom.world import World

# A page of the last run that is still open connects again within this time [s].
_RECONNECTION = 1.5


class Viewer:
    """Shows a world in the browser.

    Args:
        world: The world.
        lock: Held by whoever steps or changes the world.
        host: Address to listen on; this machine alone unless told otherwise.
        port: Port to listen on; None for the usual one or, where that is taken, any.
        title: Of the page.
        width: Of the image in pixels, until a page tells what it has room for.
        height: Of the image.

    Raises:
        OSError: The address cannot be listened on.

    Attributes:
        controls: Sliders and buttons.
        drawings: What scripts draw.
        keyboard: Keys.
        mouse: Mouse events.
        camera: The camera.
        gate: Whether the simulation is paused.
        is_open: False once a user has closed the viewer.
        on_hold: Called, from the thread of the server, with whether steps have to ask `gate` first: while
            the simulation is paused, and once the viewer is closed.
    """

    def __init__(
        self,
        world: World,
        lock: Any,
        *,
        host: str = "127.0.0.1",
        port: int | None = None,
        title: str = "Carom",
        width: int = 1024,
        height: int = 768,
    ) -> None:
        self.is_open = True
        self.on_hold: Callable[[bool], None] = lambda held: None
        self._board = Board()
        self._board.put("title", {"type": "title", "title": title})
        self.controls = Controls(self._board)
        self.drawings = Drawings(self._board)
        self.camera = SharedCamera(self._board, width, height)
        self.keyboard = Keyboard()
        self.mouse = Mouse()
        self.gate = Gate()
        self._feed = SceneFeed(world, lock, self._board)
        # Pages that show collision shapes.
        self._wishes: dict[int, bool] = {}
        self.pause(False)
        self._answers: dict[str, Callable[[int, dict[str, Any]], None]] = {
            "slider": lambda page, told: self.controls.move(int(told["slider"]), float(told["value"])),
            "press": lambda page, told: self.controls.press(int(told["slider"])),
            "key": self._take_key,
            "blur": lambda page, told: self.keyboard.release_all(page),
            "mouse": self._take_mouse,
            "camera": self._take_camera,
            "size": self._take_size,
            "want": self._take_wish,
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

    def close(self) -> None:
        """Ends it: pages say that the simulation is over."""
        self.is_open = False
        self.gate.open()
        self._server.stop()

    def _frame(self) -> bytes | None:
        self.drawings.expire()
        return self._feed.frame({})

    def _receive(self, page: int, told: dict[str, Any]) -> None:
        self._answers[told["type"]](page, told)

    def _page_gone(self, page: int) -> None:
        self.keyboard.release_all(page)
        self._wishes.pop(page, None)
        self._feed.collisions = any(self._wishes.values())

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
        x, y, z = map(float, told["target"])
        distance, yaw, pitch = (float(told[name]) for name in ("distance", "yaw", "pitch"))
        if all(map(isfinite, (x, y, z, distance, yaw, pitch))) and distance > 0.0:
            self.camera.moved(distance, yaw, pitch, (x, y, z))

    def _take_size(self, page: int, told: dict[str, Any]) -> None:
        width, height = int(told["width"]), int(told["height"])
        if min(width, height) > 0:
            self.camera.resized(width, height)

    def _take_wish(self, page: int, told: dict[str, Any]) -> None:
        self._wishes[page] = bool(told["collisions"])
        self._feed.collisions = any(self._wishes.values())

    def _close_by_user(self) -> None:
        self.is_open = False
        self.gate.open()
        self.on_hold(True)


def has_display() -> bool:
    """Whether a browser could show something here, and somebody would look."""
    if "CI" in os.environ:
        return False
    if sys.platform in ("win32", "darwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
