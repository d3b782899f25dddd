"""The viewer of a world: its page, and the messages between page and script."""

from __future__ import annotations

import webbrowser
from collections.abc import Callable, Iterable
from functools import partial
from threading import Timer
from typing import TYPE_CHECKING, Any, cast
from weakref import WeakMethod

from carom.native.products import product
from carom.remote.user_token import fresh_token, user_token
from carom.viewer.access import Access, is_loopback
from carom.viewer.camera import SharedCamera
from carom.viewer.details import NOTHING, DetailRequest
from carom.viewer.display import has_display, where_shown
from carom.viewer.drawings import Drawings
from carom.viewer.history.history import DEFAULT_BYTES
from carom.viewer.history.recorder import packed_past
from carom.viewer.input.controls import Controls
from carom.viewer.input.gamepads import Gamepad, Gamepads
from carom.viewer.input.keys import Keyboard, key_code
from carom.viewer.input.leaving import ESCAPE, Leaving
from carom.viewer.input.mouse import Mouse
from carom.viewer.input.scene_hands import Answer, vector
from carom.viewer.items import Choice, Handle, Slider, box_of, list_of, slider_of
from carom.viewer.last_words import LastWords
from carom.viewer.latest_messages import LatestMessages, latest_of
from carom.viewer.looks.still import still
from carom.viewer.notebook import frame, in_notebook, show
from carom.viewer.panels.adding import Adding, Panel
from carom.viewer.panels.parts import Parts
from carom.viewer.pictures import Pictures
from carom.viewer.previews import Previews
from carom.viewer.protocol import from_page, to_page
from carom.viewer.protocol.message import Message
from carom.viewer.rays import Rays
from carom.viewer.server import PageServer
from carom.viewer.simulation.panel import SimulationPanel
from carom.viewer.steps.pause_control import PauseControl
from carom.viewer.steps.step_queue import StepQueue
from carom.viewer.subjects import OneWorld, lock_of, many_worlds, shown_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from carom.render.image_target import RawImage
    from carom.scene.core.restorable import Restorable
    from carom.viewer.lenses import ViewedCamera
    from carom.viewer.many.shown import ShownWorlds
    from carom.viewer.many.viewed import ViewedWorlds
    from carom.viewer.subject import Subject

# How long a script waits for pages to draw a picture [s].
_DRAWING_PATIENCE = 0.1
# An open page of the last run reconnects within this time [s].
_RECONNECTION = 1.5


class Viewer(Adding):
    """Shows a world in the browser.

    Args:
        world: The world, or many: then some of them are shown.
        lock: Lock held while the world is stepped or bodies are added and removed; its owner checks `held`
            before each step. Without it the lock is that of the world, and the viewer controls the steps by
            an observer.
        host: Address to listen on; by default only for this machine. Pages need a token, which is part of
            `address`.
        port: Port to listen on; None for the default port or, if it is taken, any.
        title: Title of the page.
        width: Width of the image in pixels, until a page reports its size.
        height: Height of the image in pixels, until a page reports its size.
        token: The token that pages need; random by default.
        names: Host names used by proxies.
        history: Memory for the past that pages can go back to [bytes], those that join later included. Beyond
            it the oldest frames are dropped. With 0 each page only has what it was sent itself.
        **choice: Which of many worlds are shown: `shown`, `chosen`, `arrangement` and `spacing` of
            `carom.viewer.many.shown.ShownWorlds`.

    Raises:
        OSError: The server cannot listen on the address.
        TypeError: It is neither a world nor many worlds, or there is no such choice.
        ValueError: There are no such worlds, or a choice is stated for a single one.
        NotImplementedError: Many worlds have soft bodies.

    Attributes:
        lock: Held while bodies are read.
        controls: Sliders and buttons.
        drawings: Lines, points and texts that scripts draw.
        keyboard: Key events.
        mouse: Mouse events.
        camera: The camera.
        previews: Previews of the last camera image of a script.
        pause_control: Whether the simulation is paused.
        simulation: Sections of the page for a simulation without a script.
        shown: Which of many worlds are shown; None for a single one.
        stays_paused: A pause goes on when the last page is closed.
        is_open: False once a user has closed the viewer.
        held: Steps have to call `wait_for_turn` or `has_turn` first: the simulation is paused or slowed down,
            its start state is not saved yet, or the viewer is closed.
        on_hold: Called, from any thread, with `held` when it changes.
        on_pause: Called, from any thread, when the simulation is paused or continued.
        on_profile: Called, from the thread of the server, when the user starts or ends a timing profile.
    """

    def __init__(
        self,
        world: Restorable | ViewedWorlds,
        lock: Any = None,
        *,
        host: str = "127.0.0.1",
        port: int | None = None,
        title: str = "Carom",
        width: int = 1024,
        height: int = 768,
        token: str | None = None,
        names: Iterable[str] = (),
        history: int = DEFAULT_BYTES,
        **choice: Any,
    ) -> None:
        own_lock = lock_of(world)
        shown = shown_of(world, choice)
        self.is_open: bool = True
        self.held: bool = True
        self.on_hold: Callable[[bool], None] = _tell_nobody
        self.on_pause: Callable[[bool], None] = _tell_nobody
        self.on_profile: Callable[[bool], None] = _tell_nobody
        if token is None:
            # With the user's own token an open page can reconnect to the next script. Addresses for other
            # machines are valid for one script only.
            # So are those in notebooks, whose outputs are saved and passed on.
            token = user_token() if is_loopback(host) and not in_notebook() else fresh_token()
        access = Access(host, token, frozenset(name.lower() for name in names))
        self._latest = LatestMessages()
        named = {"title": title, "run": fresh_token(), "watch": access.spectator_token}
        self._latest.put("title", to_page.TITLE(history=max(history, 0), **named))
        self.controls: Controls = Controls(self._latest)
        self.drawings: Drawings = Drawings(self._latest)
        self.camera: SharedCamera = SharedCamera(self._latest, width, height)
        self.keyboard: Keyboard = Keyboard()
        self.mouse: Mouse = Mouse()
        self._gamepads = Gamepads()
        self.pause_control: PauseControl = PauseControl()
        self._pictures = Pictures()
        self.lock: Any = own_lock if lock is None else lock
        self._step_queue = StepQueue(self.lock)
        history = max(history, 0)
        if shown is None:
            one = cast("Restorable", world)
            self._subject: Subject = OneWorld(
                one, self.lock, self._latest, self.pause_control, self._step_queue, history
            )
        else:
            self._subject = many_worlds(shown, self._latest, self.pause_control, self._step_queue, history)
        self.shown: ShownWorlds | None = shown
        self._world = self._subject.world
        self._moments = self._subject.moments
        # The parts of the viewer do not refer to it, or only weakly, or until it is closed.
        close = WeakMethod(self._close_by_user)
        self._leaving = Leaving(lambda: (closing := close()) and closing())
        self._frames = self._subject.frames
        self._past = self._frames.past
        self.previews: Previews = Previews(self._latest)
        self.simulation: SimulationPanel = SimulationPanel(self._latest)
        self.stays_paused: bool = False
        self._hands = self._subject.hands
        self._handles = self._hands.handles
        self._parts = Parts(self._latest, self.controls, self._frames.plot)
        self.pause(False)
        self._answers: dict[Message, Answer] = {
            **self._hands.answers(),
            **self.simulation.answers(),
            from_page.SLIDER: self._take_slider,
            from_page.PRESS: self._take_press,
            from_page.FIELD: self._parts.take_text,
            from_page.KEY: self._take_key,
            from_page.BLUR: lambda page, message: self.keyboard.release_all(page),
            from_page.MOUSE: self._take_mouse,
            from_page.CAMERA: self._take_camera,
            from_page.SIZE: self._take_size,
            from_page.VISIBLE: lambda page, message: self._pictures.show(
                page, visible=bool(message["visible"])
            ),
            from_page.DRAWN: lambda page, message: self._pictures.drawn(page, int(message["picture"])),
            from_page.PAST: self._tell_past,
            from_page.PREVIEW_WIDTH: lambda page, message: self.previews.ask(page, int(message["width"])),
            from_page.WANT: lambda page, message: self._frames.want(
                page, DetailRequest.from_message(message)
            ),
            from_page.PROFILE: lambda page, message: self.on_profile(bool(message["running"])),
            from_page.GAMEPADS: self._take_gamepads,
            from_page.PAUSE: lambda page, message: self.pause(bool(message["paused"])),
            from_page.STEP: lambda page, message: self.pause_control.let_through(),
            from_page.SPEED: self._take_speed,
            from_page.RESET: lambda page, message: self._step_queue.add(self._moments.reset),
            from_page.MARK: lambda page, message: self._step_queue.add(self._moments.mark),
            from_page.RESTORE: lambda page, message: self._step_queue.add(
                partial(self._moments.restore, int(message["mark"]))
            ),
            from_page.CLOSE: lambda page, message: self._close_by_user(),
            from_page.WORLDS: self._take_worlds,
        }

        def receive(page: int, message: dict[str, Any]) -> None:
            self._answers[from_page.checked(message)](page, message)

        unwatched = self._record if self._past.is_on else None
        self._server = PageServer(
            access, port, self._latest, self._frame, receive, self._page_gone, unwatched
        )
        # Only now: nothing is left in the world of a viewer that could not listen.
        self._last_words = LastWords(self._latest, self._server)
        if lock is None:
            self._subject.observe(self)
        latest_of[world] = self._latest

    @property
    def address(self) -> str:
        """The address of the page."""
        return self._server.address

    @property
    def spectator_address(self) -> str:
        """The address of the page for those who watch: they see everything, and can change nothing.

        It is good for as long as `address` is.
        """
        return self._server.spectator_address

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._subject.time

    @property
    def page_count(self) -> int:
        """Number of open pages."""
        return self._server.page_count

    def configure(self, options: dict[str, Any]) -> None:
        """Sets display options; see `Options` in `page/options.js`."""
        self._latest.put("options", to_page.OPTIONS(**options))

    def pause(self, paused: bool) -> None:
        """Pauses the simulation, or continues it."""
        changed = self.pause_control.closed != paused
        if paused:
            self.pause_control.close()
        else:
            self.pause_control.open()
        self._update_hold()
        self._latest.put("pause", to_page.PAUSE(paused=paused))
        if changed:
            self.on_pause(paused)

    def set_speed(self, speed: float | None) -> None:
        """Limits the speed of the simulation.

        Args:
            speed: Simulated time / real time; None for no limit.
        """
        self.pause_control.set_speed(speed)
        self._update_hold()
        self._latest.put("speed", to_page.SPEED(speed=speed))

    def wait_for_turn(self, *, listening: bool = False) -> bool:
        """Waits until a step may be made.

        Args:
            listening: Also return, without a step, when the user moves a slider or presses a key, so that a
                paused script can read these.

        Returns:
            Whether to make the step.
        """
        if not self.pause_control.wait(lambda: self.time, listening=listening):
            return False
        self._keep_start()
        return True

    def has_turn(self) -> bool:
        """Whether a step may be made now; it then counts as made."""
        if not self.pause_control.passes():
            return False
        self._keep_start()
        return True

    def keep_start(self) -> None:
        """Makes the present state the one that *Reset* goes back to, unless there is one of these bodies."""
        self._keep_start()

    def _keep_start(self) -> None:
        if not self._moments.start_is_known:
            with self.lock:
                self._moments.keep_start()
            self._update_hold()

    def key_events(self) -> dict[int, int]:
        """Key events since the last call; after ESC was reported the viewer closes."""
        events = self.keyboard.events()
        self._leaving.take_events(events)
        return events

    def _update_hold(self) -> None:
        held = (
            self.pause_control.closed
            or self.pause_control.speed is not None
            or not self._moments.start_is_known
            or not self.is_open
            or self._leaving.pending
        )
        if held != self.held:
            self.held = held
            self.on_hold(held)

    def plot(self, name: str, value: float) -> None:
        """Plots a value of the script on all pages, under a name; call it again when it changes.

        Raises:
            ValueError: The value is not a finite number.
        """
        self._frames.plot(name, value)

    def slider(self, name: str, lower: float, upper: float, start: float) -> Slider:
        """Adds a slider to the panel; its `value` is set by the user.

        Raises:
            ValueError: A number is not finite, or not lower < upper with the start between them.
        """
        slider = slider_of(name, lower, upper, start)
        self._add_control(slider)
        return slider

    def button(self, name: str) -> Slider:
        """Adds a button to the panel; its `value` is the number of clicks."""
        button = Slider(name, 1.0, 0.0, 0.0)
        self._add_control(button)
        return button

    def choice(self, name: str, options: Iterable[str], start: int = 0) -> Choice:
        """Adds a list of texts to the panel; `chosen` is the text that the user has chosen.

        Raises:
            ValueError: There are no texts, or `start` is not the index of one.
        """
        choice = list_of(name, tuple(map(str, options)), start)
        self._add_control(choice)
        return choice

    def checkbox(self, name: str, start: bool = False) -> Choice:
        """Adds a checkbox to the panel; `checked` is its state."""
        box = box_of(name, start)
        self._add_control(box)
        return box

    def add_panel(self, title: str) -> Panel:
        """Adds a panel of your own, with the same `add_button` and so on as the viewer itself.

        It folds, and users can take it out of the page's panel; the browser remembers it by its title.
        """
        return Panel(self._parts, self._handles, title)

    def handle(
        self, name: str, position: Iterable[float], orientation: Iterable[float] = (0.0, 0.0, 0.0, 1.0)
    ) -> Handle:
        """Adds a frame that the user moves with the mouse, for example the target of a gripper.

        Args:
            name: Its label.
            position: Initial position [m].
            orientation: Initial orientation: a quaternion (x, y, z, w).

        Returns:
            The handle; its `position` and `orientation` are set by the user, or by its `move_to`.

        Raises:
            ValueError: The numbers are not a position and a quaternion.
        """
        return self._hands.handles.add(name, tuple(position), tuple(orientation))

    def gamepads(self) -> list[Gamepad]:
        """The gamepads at the machines that show the page, as they are now.

        A browser tells of a gamepad once one of its buttons was pressed, and only while the page is in view.
        """
        return self._gamepads.all()

    def show_camera(self, name: str, camera: ViewedCamera) -> None:
        """Lists a camera on the pages, under a name; with a click on it they look through it.

        Raises:
            ValueError: The camera is mounted on a link of another world.
        """
        if camera.link is not None and camera.link.body.world is not self._world:
            raise ValueError(f"camera {name!r} is mounted on a link of another world")
        self._frames.lenses.follow(name, camera)

    def show_image(self, image: RawImage, view: NDArray[np.float64], projection: NDArray[np.float64]) -> None:
        """Shows an image of the script, where its camera stands, and what it sees.

        Args:
            image: The image.
            view: (4, 4) from the world to the eye, as in OpenGL.
            projection: (4, 4) from the eye to clip coordinates.
        """
        self.previews.show(image, product(projection, view))
        height, width = image.rgba.shape[:2]
        self._frames.lenses.saw(view, projection, width, height)

    def _add_control(self, control: Slider) -> None:
        self.controls.add(self.controls.free_number(), control)

    @property
    def rays(self) -> Rays:
        """Records the rays that scripts cast; needed only while `rays.wanted`."""
        return self._frames.details.rays

    def draw_now(self) -> None:
        """Waits until all visible pages have drawn the present state, but for those of spectators.

        It waits for a tenth of a second at most: pages are drawn when their browser has time.
        """
        if self._server.in_control():
            self._pictures.wait(self._server.in_control, _DRAWING_PATIENCE)

    def open_browser(self) -> None:
        """Shows the page: below the cell of a notebook, or in the browser, if there is a display.

        An open page of the last run is used again.
        """
        if in_notebook():
            show(self._repr_html_())
            return
        if not has_display():
            return

        def open_unless_watched() -> None:
            if self.is_open and not self._server.in_control():
                webbrowser.open(self.address)

        timer = Timer(_RECONNECTION, open_unless_watched)
        timer.daemon = True
        timer.start()

    def announce(self) -> None:
        """Says where the page is, and opens it in the browser, if there is a display; not in notebooks."""
        if in_notebook():
            return
        print("\n".join(where_shown(self.address)), flush=True)
        self.open_browser()

    def _repr_html_(self) -> str:
        """The page, for notebooks."""
        with self.lock:
            picture = still(self._world)
        return frame(self._server.port, self._server.access.token, picture)

    def close(self) -> None:
        """Closes the viewer; pages then show that the simulation has ended."""
        self.previews.catch_up(at_once=True)
        self.is_open = False
        self._last_words.forget()
        self._leaving.cancel()
        self.pause_control.open()
        self._subject.leave()
        self._server.stop()
        self.on_hold = self.on_pause = self.on_profile = _tell_nobody
        self._parts.calls.stop()
        self._answers.clear()
        self.simulation.forget()

    def _frame(self) -> bytes | None:
        self.previews.catch_up()
        self._hands.apply()
        self._step_queue.run()
        if not self.held and not self._moments.start_is_known:
            self._update_hold()
        return self._record()

    def _record(self) -> bytes | None:
        """Makes a frame of the present state, and keeps it."""
        self.drawings.expire()
        return self._frames.take(self._pictures.asked)

    def _tell_past(self, page: int, request: dict[str, Any]) -> None:
        excerpt = self._past.before(int(request["before"]), known=bool(request["known"]))
        self._server.send_later(page, partial(packed_past, excerpt))

    def _page_gone(self, page: int) -> None:
        self.keyboard.release_all(page)
        self._pictures.forget(page)
        self._frames.want(page, NOTHING)
        self._gamepads.forget(page)
        self.previews.forget(page)
        self._hands.gone(page)
        if self.pause_control.closed and not self._server.in_control():
            go_on = Timer(_RECONNECTION, self._go_on_unwatched)
            go_on.daemon = True
            go_on.start()

    def _go_on_unwatched(self) -> None:
        """Ends a pause that no page can end; a page being reloaded would be connected again by now."""
        if self.stays_paused or not self.is_open or not self.pause_control.closed:
            return
        if not self._server.in_control():
            self.pause(False)

    def _take_worlds(self, page: int, message: dict[str, Any]) -> None:
        if self.shown is not None:
            self.shown.take(message)

    def _take_gamepads(self, page: int, message: dict[str, Any]) -> None:
        self._gamepads.take(page, message)
        self.pause_control.call_back()

    def _take_key(self, page: int, message: dict[str, Any]) -> None:
        key, code, down = str(message["key"]), str(message["code"]), bool(message["down"])
        change = self.keyboard.press if down else self.keyboard.release
        change(page, key, code)
        if down and key_code(key, code) == ESCAPE:
            self._leaving.escape(listening=self.keyboard.is_asked or self.pause_control.listeners > 0)
            self._update_hold()
        self.pause_control.call_back()

    def _take_speed(self, page: int, message: dict[str, Any]) -> None:
        speed = message["speed"]
        self.set_speed(None if speed is None else float(speed))

    def _take_slider(self, page: int, message: dict[str, Any]) -> None:
        self.controls.move(int(message["slider"]), float(message["value"]))
        self.pause_control.call_back()

    def _take_press(self, page: int, message: dict[str, Any]) -> None:
        self.controls.press(int(message["slider"]))
        self.pause_control.call_back()

    def _take_mouse(self, page: int, message: dict[str, Any]) -> None:
        x, y = float(message["x"]), float(message["y"])
        if "button" in message:
            self.mouse.button(x, y, int(message["button"]), down=bool(message["down"]))
        else:
            self.mouse.move(x, y)

    def _take_camera(self, page: int, message: dict[str, Any]) -> None:
        distance, yaw, pitch = (float(message[name]) for name in ("distance", "yaw", "pitch"))
        chosen = bool(message.get("chosen", True))
        self.camera.moved(distance, yaw, pitch, vector(message["target"]), chosen=chosen)

    def _take_size(self, page: int, message: dict[str, Any]) -> None:
        width, height = int(message["width"]), int(message["height"])
        if min(width, height) > 0:
            self.camera.resized(width, height)

    def _close_by_user(self) -> None:
        self.is_open = False
        # The script may end by the error that there is no connection any more.
        self._last_words.forget()
        self._leaving.cancel()
        self.pause_control.open()
        self._update_hold()


def _tell_nobody(_value: bool) -> None:
    pass
