"""A simulator without a script: files in the browser, played, paused, changed and loaded again."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from carom.engine.parameters import EngineParameters
from carom.errors import CaromError
from carom.scene.keyframes.keyframe import keyframes_of
from carom.simulator.console import Console
from carom.simulator.keeping import KeptState, OwnKeyframes
from carom.simulator.keyframe_texts import keyframe_text
from carom.simulator.loading import LoadedFile, load_files, main_file
from carom.simulator.settings import checked_setting, shown_settings
from carom.simulator.uploads import Uploads
from carom.simulator.watching import FileWatch
from carom.viewer.protocol import from_page
from carom.viewer.simulation.panel import ShownKeyframe
from carom.viewer.viewer import Viewer
from carom.world.robot_files import Choices
from carom.world.world import World

_MAX_STATED = 60
_USUAL = EngineParameters()
_KEPT_BY_RESETS = ("time_step", "substeps", "contact")
Task = Callable[[], None]


@dataclass
class Start:
    """How the simulator starts.

    Attributes:
        choices: How files are read.
        settings: Parameters of the world that hold whatever the files say, by name.
        play: It plays at once, and else is paused.
        host: Address to serve the page at.
        port: Port to serve it at; None for the default one or, if that is taken, any.
    """

    choices: Choices = field(default_factory=lambda: Choices(missing_meshes="warn"))
    settings: Mapping[str, Any] = field(default_factory=dict)
    play: bool = False
    host: str = "127.0.0.1"
    port: int | None = None


class Simulator:
    """Simulates what files describe, in real time, and shows it in the browser.

    Gravity, time step and options are those of the files. When a file changes, or another one that was read
    for it, all are loaded again, and what has the same name keeps its state.

    Args:
        paths: URDF, xacro, SDF, MJCF and USD files, saved worlds and meshes.
        start: How it starts.

    Raises:
        DescriptionError: A file cannot be used, or there is nothing in them.
        OSError: The page cannot be served at this address and port.
        ValueError: A choice or setting is wrong.

    Attributes:
        world: The world.
        viewer: The viewer.
        console: Warnings, errors, and what of the files is not simulated.
        files: The files in the world.
    """

    def __init__(self, paths: Sequence[Path], start: Start | None = None) -> None:
        start = start or Start()
        self._choices = start.choices
        self._paths = [Path(it) for it in paths]
        self._settings: dict[str, Any] = dict(start.settings)
        self._own = OwnKeyframes()
        self._uploads = Uploads()
        self._tasks: deque[Callable[[], object]] = deque()
        self.world: World = World()
        self._watch = FileWatch(self._files_changed, self._wake)
        self._watch.listen()
        try:
            self.files: list[LoadedFile] = load_files(self.world, self._paths, self._choices)
            self._apply_settings()
            self.viewer: Viewer = Viewer(
                self.world, self.world.lock, host=start.host, port=start.port, title=self._title
            )
        except BaseException:
            self._watch.close()
            self._uploads.close()
            raise
        self.console: Console = Console(self.viewer.simulation)
        self.console.listen()
        self.viewer.stays_paused = True
        self.viewer.configure({"names": True})
        self.viewer.set_speed(1.0)
        self.viewer.keep_start()
        self.viewer.pause(not start.play)
        self._show_all()
        self._answer()
        self._watch.start()

    @property
    def _title(self) -> str:
        return ", ".join(it.path.name for it in self.files)

    def run(self) -> None:
        """Simulate until the user closes the page."""
        while self.viewer.is_open:
            self.turn()

    def turn(self) -> bool:
        """Do what pages and changed files ask for, then wait for the next step and make it.

        Returns:
            Whether a step was made; a paused simulation also returns without one.
        """
        self.work()
        if self.viewer.held and not self.viewer.wait_for_turn(listening=True):
            return False
        if not self.viewer.is_open:
            return False
        try:
            with self.viewer.lock:
                self.world.step()
        except CaromError as problem:
            self.viewer.pause(True)
            self.console.say("error", f"The simulation is paused: {problem}")
            return False
        return True

    def work(self) -> None:
        """Do what pages and changed files ask for."""
        while self._tasks:
            task = self._tasks.popleft()
            try:
                task()
            except (CaromError, OSError, ValueError) as problem:
                self.console.say("error", str(problem))

    def close(self) -> None:
        """End it, and close the page."""
        self._watch.close()
        self.console.close()
        self.viewer.close()
        self._uploads.close()

    # What is asked for

    def _answer(self) -> None:
        panel = self.viewer.simulation
        panel.answer(from_page.KEYFRAME, self._later(self._keyframe))
        panel.answer(from_page.SETTING, self._later(self._set))
        panel.answer(from_page.ARGUMENTS, self._later(self._set_arguments))
        panel.answer(from_page.RELOAD, self._later(lambda page, message: self.reload()))
        panel.answer(from_page.UPLOAD, self._later(self._take_piece))
        panel.answer(from_page.OPEN, self._later(self._open))

    def _later(self, act: Callable[[int, dict[str, Any]], object]) -> Callable[[int, dict[str, Any]], None]:
        """Do it between steps, in the thread that makes them."""

        def ask(page: int, message: dict[str, Any]) -> None:
            self._tasks.append(lambda: act(page, message))
            self._wake()

        return ask

    def _wake(self) -> None:
        """End the wait of a paused simulation if there is something to do; called again and again."""
        if self._tasks:
            self.viewer.pause_control.call_back()

    def _keyframe(self, page: int, message: dict[str, Any]) -> None:
        name = str(message["name"])
        with self.viewer.lock:
            if message["action"] == "save":
                self._own.save(self.world, name)
            elif message["action"] == "forget":
                self._own.forget(self.world, name)
            elif name in (known := keyframes_of([*self.world.bodies.values()])):
                known[name].reset()
        self._show_keyframes()

    def _set(self, page: int, message: dict[str, Any]) -> None:
        name = str(message["name"])
        try:
            value = checked_setting(self.world, name, message["value"])
            with self.viewer.lock:
                self.world.change_parameters(**{name: value})
            self._settings[name] = value
        finally:
            # A field that had a wrong value shows the present one again.
            self._show_settings()

    def _set_arguments(self, page: int, message: dict[str, Any]) -> None:
        values = {str(name): str(value) for name, value in message["values"].items()}
        before = self._choices
        self._choices = replace(before, xacro_args={**(before.xacro_args or {}), **values})
        if not self.reload():
            self._choices = before
            self._show_arguments()

    def _take_piece(self, page: int, message: dict[str, Any]) -> None:
        self._uploads.take(page, str(message["name"]), str(message["data"]), start=bool(message["start"]))

    def _open(self, page: int, message: dict[str, Any]) -> None:
        files = self._uploads.finish(page)
        found = main_file(files)
        if found is None:
            names = ", ".join(it.name for it in files[:5]) or "nothing"
            self.console.say("error", f"Of what was dropped ({names}) nothing is a robot, a world or a mesh.")
            return
        self.open([found])

    # Files

    def open(self, paths: Sequence[Path]) -> bool:
        """Show other files instead of those that are shown; if they cannot be used, these stay.

        Returns:
            Whether they are shown.
        """
        before = self._paths, self._choices, self._own
        self._paths = [Path(it) for it in paths]
        self._choices, self._own = replace(self._choices, xacro_args=None), OwnKeyframes()
        if self.reload(keep=False):
            return True
        self._paths, self._choices, self._own = before
        return False

    def reload(self, *, keep: bool = True) -> bool:
        """Load the files again, which have changed; what cannot be used is told, and what was there stays.

        Args:
            keep: Bodies, joints and actuators keep their states by their names, and time goes on.

        Returns:
            Whether they could be used.
        """
        try:
            # In a world of its own first, so that a file that is being edited does no harm.
            load_files(World(), self._paths, self._choices)
        except (CaromError, OSError, ValueError) as problem:
            self.console.say("error", str(problem))
            return False
        with self.viewer.lock:
            state = KeptState.of(self.world)
            self.world.clear()
            self.world.change_parameters(**{it: getattr(_USUAL, it) for it in _KEPT_BY_RESETS})
            self.world.parameters_set = frozenset()
            self.files = load_files(self.world, self._paths, self._choices)
            self._apply_settings()
            self.world.time = 0.0
            self.viewer.keep_start()
            lost = self._own.give(self.world)
            if keep:
                state.give(self.world)
        for name in lost:
            self.console.say("warning", f"Keyframe {name!r} does not fit all bodies any more.")
        self._show_all()
        self.console.say("info", f"Loaded {self._title}")
        return True

    def _files_changed(self, paths: list[Path]) -> None:
        self._tasks.append(self.reload_changed)

    def reload_changed(self) -> None:
        """Load the files again, as some of them have changed."""
        self.reload()

    def _apply_settings(self) -> None:
        if self._settings:
            self.world.change_parameters(**self._settings)

    # What is shown

    def _show_all(self) -> None:
        stated = [(name, _shown(value)) for it in self.files for name, value in sorted(it.stated.items())]
        self.viewer.simulation.show_files([it.path.name for it in self.files], stated[:_MAX_STATED])
        self.console.show_ignored([one for it in self.files for one in it.ignored])
        self._show_keyframes()
        self._show_settings()
        self._show_arguments()

    def _show_keyframes(self) -> None:
        own, known = self._own.names, keyframes_of([*self.world.bodies.values()])
        names = [*(name for name in known if name not in own), *(name for name in own if name in known)]
        self.viewer.simulation.show_keyframes(
            ShownKeyframe(name, known[name].time, keyframe_text(name, self.files), name in own)
            for name in names
        )

    def _show_settings(self) -> None:
        self.viewer.simulation.show_settings(shown_settings(self.world))

    def _show_arguments(self) -> None:
        arguments = {name: value for it in self.files for name, value in it.arguments.items()}
        self.viewer.simulation.show_arguments(arguments.items())


def _shown(value: object) -> str:
    if isinstance(value, (tuple, list)):
        return " ".join(map(_shown, value))
    return f"{value:.6g}" if isinstance(value, float) else str(value)
