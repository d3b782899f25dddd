"""The last frames of a run, and the other messages shown with them, as they were sent.

`page/time/history.js` keeps the same on each page.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from dataclasses import dataclass

from carom.viewer.protocol import to_page

DEFAULT_BYTES = 128 * 2**20
"""Memory for the past, unless another one is asked for [bytes]."""

# Memory of a message besides its content [bytes].
_OVERHEAD = 100
# Number of frames between two checks of the memory.
_TIDY_EVERY = 64
# Kinds of messages that are kept besides frames; all others are only for the present.
_KEPT = frozenset(message.kind for message in to_page.ALL.values()) - {None}


@dataclass(slots=True)
class Version:
    """A message that was shown from a frame on until before another one, None if it still is."""

    name: str
    begin: int
    end: int | None
    message: bytes


@dataclass(frozen=True, slots=True)
class Excerpt:
    """A part of a history: frames in order, and the versions shown with them.

    Attributes:
        first: Number of the first of these frames.
        oldest: Number of the oldest frame that the history has.
    """

    first: int
    oldest: int
    frames: list[bytes]
    versions: list[Version]


class History:
    """Frames, numbered from 0 on, and messages by name. For use by one thread.

    Args:
        budget: Memory for messages [bytes]; beyond it the oldest frames are dropped. With 0 nothing is kept.

    Attributes:
        first: Number of the oldest frame that is kept.
        size: Memory that is used [bytes].
    """

    def __init__(self, budget: int) -> None:
        self.budget = budget
        self.first: int = 0
        self.size: int = 0
        self._frames: list[bytes] = []
        self._versions: dict[str, list[Version]] = {}

    @property
    def end(self) -> int:
        """Number of the next frame."""
        return self.first + len(self._frames)

    def take(self, changes: Iterable[tuple[Hashable, bytes | None]]) -> None:
        """Adds messages by key, shown from the next frame on; None removes one."""
        for key, message in changes:
            kind, name = (key, key) if isinstance(key, str) else _named(key)
            if kind not in _KEPT or not self.budget:
                continue
            versions = self._versions.setdefault(name, [])
            self._close(versions)
            if message is not None:
                versions.append(Version(name, self.end, None, message))
                self.size += len(message) + _OVERHEAD

    def add(self, frame: bytes) -> None:
        """Adds the next frame."""
        if not self.budget:
            return
        self._frames.append(frame)
        self.size += len(frame) + _OVERHEAD
        if len(self._frames) % _TIDY_EVERY == 0:
            self._tidy()

    def before(self, number: int, most_bytes: int, *, known: bool) -> Excerpt:
        """The frames before one, as many as fit into a number of bytes, but one at least if there is one.

        Args:
            number: Number of the frame.
            most_bytes: Memory of the frames that are returned [bytes].
            known: Leave out what is shown with that frame as well.
        """
        end = min(max(number, self.first), self.end)
        begin, size = end, 0
        while begin > self.first:
            size += len(self._frames[begin - 1 - self.first])
            if size > most_bytes and begin < end:
                break
            begin -= 1
        versions = [
            version
            for each in self._versions.values()
            for version in each
            if version.begin < end
            and (version.end is None or version.end > begin)
            and not (known and (version.end is None or version.end > end))
        ]
        frames = self._frames[begin - self.first : end - self.first]
        return Excerpt(begin, self.first, frames, sorted(versions, key=lambda version: version.begin))

    def _close(self, versions: list[Version]) -> None:
        if versions and versions[-1].end is None:
            versions[-1].end = self.end
            # A version that was shown in no frame is dropped.
            if versions[-1].begin == self.end:
                self.size -= len(versions.pop().message) + _OVERHEAD

    def _tidy(self) -> None:
        """Drops the oldest frames until the budget is met."""
        drop = 0
        while self.size > self.budget and drop < len(self._frames) - 1:
            self.size -= len(self._frames[drop]) + _OVERHEAD
            drop += 1
        if drop == 0:
            return
        del self._frames[:drop]
        self.first += drop
        for name, versions in list(self._versions.items()):
            while versions and versions[0].end is not None and versions[0].end <= self.first:
                self.size -= len(versions.pop(0).message) + _OVERHEAD
            if not versions:
                del self._versions[name]


def _named(key: Hashable) -> tuple[Hashable, str]:
    assert isinstance(key, tuple)
    kind, number = key
    return kind, f"{kind} {number}"
