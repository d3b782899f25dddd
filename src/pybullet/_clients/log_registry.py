"""The logs of one client."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from carom.scene.observers import Observer, SubstepObserver
from pybullet._calls.errors import error, logger

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore


class StateLog(Observer, Protocol):
    """Interface of a log: an observer of the world's steps that is closed at the end."""

    def close(self) -> None:
        """Finish the file."""
        ...


@runtime_checkable
class Video(StateLog, Protocol):
    """Interface of a log that takes pictures.

    Attributes:
        automatic: It takes them by itself as the simulated time passes, not only when it is told to.
    """

    automatic: bool

    def shoot(self) -> None:
        """Take a picture."""
        ...


class Logs:
    """Logs by id.

    Attributes:
        by_id: The logs that are being written.
        next_id: Id of the next log; ids are never reused.
        zones: Names of the zones of `submitProfileTiming` that have begun and not ended.
    """

    def __init__(self) -> None:
        self.by_id: dict[int, StateLog] = {}
        self.next_id = 0
        self.zones: list[str] = []

    def shoot(self) -> None:
        """Takes a picture for each video; from now on these videos take no pictures automatically."""
        if self.by_id:
            for video in self._videos().values():
                video.automatic = False
                video.shoot()

    def start(self, world: WorldCore, log: StateLog | None) -> int:
        """Begins a log and returns its id; None stands for a log that is not written."""
        number = self.next_id
        self.next_id += 1
        if log is not None:
            self.by_id[number] = log
            world.observers.append(log)
            if isinstance(log, SubstepObserver):
                world.watch_substeps(log)
        return number

    def stop(self, world: WorldCore, number: int) -> None:
        """Ends a log and finishes its file, if it exists.

        Raises:
            pybullet.error: The file is incomplete; the log has ended all the same.
        """
        log = self.by_id.pop(number, None)
        if log is not None:
            world.observers.remove(log)
            if isinstance(log, SubstepObserver):
                world.unwatch_substeps(log)
            log.close()

    def stop_all(self, world: WorldCore) -> None:
        """Ends all logs; of incomplete files it only warns."""
        self._stop_each(world, list(self.by_id))

    def stop_videos(self, world: WorldCore) -> None:
        """Ends all videos; of incomplete files it only warns."""
        if self.by_id:
            self._stop_each(world, list(self._videos()))

    def _videos(self) -> dict[int, Video]:
        return {number: log for number, log in self.by_id.items() if isinstance(log, Video)}

    def _stop_each(self, world: WorldCore, numbers: Sequence[int]) -> None:
        for number in numbers:
            try:
                self.stop(world, number)
            except error as problem:
                logger.warning("%s", problem)
