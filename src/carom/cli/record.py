"""Running a script and recording its world: `python -m carom record script.py out.html`."""

from __future__ import annotations

import _thread
import os
import runpy
import sys
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from threading import current_thread, main_thread
from typing import Any

from carom.cli.pacing import Pacing
from carom.cli.progress import Progress
from carom.viewer.replay import ReplayRecorder
from carom.world.world import World


@dataclass(frozen=True, slots=True)
class Take:
    """The settings of a recording.

    Attributes:
        script: The script.
        output: The HTML file. Replays of further worlds are written to `output-2.html` and so on.
        arguments: Arguments of the script.
        seconds: Simulated time of a world after which the script is ended [s]; None if it ends by itself.
            Time that passes again, after a reset or a restored state, counts again.
        fps: Number of frames per second of simulated time.
        keeps_sleeping: Let the script sleep also where that only keeps it in step with real time.
    """

    script: Path
    output: Path
    arguments: Sequence[str] = ()
    seconds: float | None = None
    fps: float = 60.0
    keeps_sleeping: bool = False


# Tolerance for rounding errors in sums of time steps [s].
_EARLY = 1e-6


class _Enough(BaseException):
    """Raised to end the script; `except Exception` does not catch it."""


class _Watch:
    """Counts the simulated time of a world, and ends the script after some; one of `World.observers`."""

    def __init__(self, world: World, seconds: float | None, pacing: Pacing, progress: Progress) -> None:
        self._world = world
        self._seconds = float("inf") if seconds is None else seconds - _EARLY
        self._pacing = pacing
        self._progress = progress
        self._began = 0.0
        self._elapsed = 0.0
        world.observers.append(self)

    def stop(self) -> None:
        """Watch no longer."""
        if self in self._world.observers:
            self._world.observers.remove(self)

    def before_step(self) -> None:
        """Note the time, which scripts can set back."""
        self._began = self._world.time

    def after_step(self) -> None:
        """End the script if the simulated time is over."""
        self._elapsed += self._world.time - self._began
        self._pacing.step()
        self._progress.show(self._elapsed)
        if self._elapsed < self._seconds:
            return
        if current_thread() is main_thread():
            raise _Enough
        # Real-time simulation steps in the background, while the script sleeps.
        _thread.interrupt_main()


def record(take: Take) -> list[Path]:
    """Run a script, and write a replay of each world it creates, even if the script fails.

    Progress is written to standard error. Sleeping that only keeps the script in step with real time is
    skipped, unless the take keeps it.

    Returns:
        The files that were written.

    Raises:
        OSError: The script cannot be read, or a replay cannot be written.
        Exception: An exception of the script.
    """
    # As in continuous integration, no browser is opened, because there is no user.
    os.environ.setdefault("CI", "1")
    recorders: list[tuple[Path, ReplayRecorder]] = []
    watches: list[_Watch] = []
    pacing, progress = Pacing(), Progress(sys.stderr, take.seconds)
    begin = World.__init__

    def begin_recorded(world: World, *arguments: Any, **keywords: Any) -> None:
        begin(world, *arguments, **keywords)
        number = len(recorders) + 1
        name = take.output.name if number == 1 else f"{take.output.stem}-{number}{take.output.suffix}"
        path = take.output.with_name(name)
        title = take.script.stem if number == 1 else f"{take.script.stem} {number}"
        recorders.append((path, ReplayRecorder(world, path, fps=take.fps, title=title)))
        watches.append(_Watch(world, take.seconds, pacing, progress))

    World.__init__ = begin_recorded  # pyright: ignore[reportAttributeAccessIssue]
    arguments = sys.argv
    sys.argv = [str(take.script), *take.arguments]
    sys.path.insert(0, str(take.script.resolve().parent))
    try:
        with nullcontext() if take.keeps_sleeping else pacing.skipping():
            runpy.run_path(str(take.script), run_name="__main__")
    except (_Enough, KeyboardInterrupt, SystemExit):
        pass
    finally:
        World.__init__ = begin
        sys.argv = arguments
        sys.path.pop(0)
        progress.end()
        for watch in watches:
            watch.stop()
        for _, recorder in recorders:
            recorder.stop()
    return [path for path, recorder in recorders if recorder.frame_count]
