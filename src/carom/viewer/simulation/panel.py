"""What pages show of a simulation without a script, and what they ask of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from carom.viewer.latest_messages import LatestMessages
from carom.viewer.protocol import from_page, to_page
from carom.viewer.protocol.message import Message

Request = Callable[[int, dict[str, Any]], None]
"""What is done for a message of a page, by the number of the page; called from the thread of the server."""

REQUESTS: tuple[Message, ...] = (
    from_page.KEYFRAME,
    from_page.SETTING,
    from_page.ARGUMENTS,
    from_page.RELOAD,
    from_page.UPLOAD,
    from_page.OPEN,
)
"""The messages of pages that only a simulation without a script answers."""


@dataclass(frozen=True, slots=True)
class ShownKeyframe:
    """A keyframe on the page: its simulated time [s], its text to copy, and whether the user has saved it."""

    name: str
    time: float
    text: str
    own: bool = False


@dataclass(frozen=True, slots=True)
class ShownSetting:
    """A parameter on the page.

    Attributes:
        name: Its name.
        title: What the page calls it.
        value: Numbers, a switch, or one of `choices`.
        unit: Unit of the numbers.
        choices: What it can be; empty for numbers and switches.
    """

    name: str
    title: str
    value: Sequence[float] | bool | str
    unit: str = ""
    choices: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ShownLine:
    """A line of the console: `info`, `ignored`, `warning` or `error`, and how often it was said in turn."""

    level: str
    text: str
    count: int = 1


class SimulationPanel:
    """Sections of the page for a simulation without a script; there are none before `show_files`."""

    def __init__(self, latest: LatestMessages) -> None:
        self._latest = latest
        self._requests: dict[Message, Request] = {}

    def answers(self) -> dict[Message, Request]:
        """What is done for each message that only such simulations answer."""
        return {message: self._answer(message) for message in REQUESTS}

    def _answer(self, asked: Message) -> Request:
        def answer(page: int, message: dict[str, Any]) -> None:
            if request := self._requests.get(asked):
                request(page, message)

        return answer

    def answer(self, asked: Message, request: Request) -> None:
        """Sets what is done for one of `REQUESTS`."""
        self._requests[asked] = request

    def show_files(self, names: Sequence[str], stated: Iterable[tuple[str, str]]) -> None:
        """Names the files that are simulated, and what they state besides bodies, as names and values."""
        self._latest.put("simulation", to_page.SIMULATION(files=list(names), stated=list(stated)))

    def show_keyframes(self, keyframes: Iterable[ShownKeyframe]) -> None:
        """Shows a button for each keyframe."""
        shown = [{"name": it.name, "time": it.time, "text": it.text, "own": it.own} for it in keyframes]
        self._latest.put("keyframes", to_page.KEYFRAMES(keyframes=shown))

    def show_settings(self, settings: Iterable[ShownSetting]) -> None:
        """Shows parameters that the user can change."""
        shown: list[dict[str, Any]] = []
        for it in settings:
            value = it.value if isinstance(it.value, (bool, str)) else list(it.value)
            facts: dict[str, Any] = {"name": it.name, "title": it.title, "value": value}
            if it.unit:
                facts["unit"] = it.unit
            if it.choices:
                facts["choices"] = list(it.choices)
            shown.append(facts)
        self._latest.put("settings", to_page.SETTINGS(settings=shown))

    def show_arguments(self, arguments: Iterable[tuple[str, str]]) -> None:
        """Shows a field for each argument of xacro files, by name, with its value."""
        shown = [{"name": name, "value": value} for name, value in arguments]
        self._latest.put("arguments", to_page.ARGUMENTS(arguments=shown))

    def show_console(self, lines: Iterable[ShownLine]) -> None:
        """Shows lines of the console, the oldest first."""
        shown = [{"level": it.level, "text": it.text, "count": it.count} for it in lines]
        self._latest.put("console", to_page.CONSOLE(lines=shown))

    def forget(self) -> None:
        """Answers nothing any more."""
        self._requests.clear()
