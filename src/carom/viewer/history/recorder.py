"""Recording what pages are sent, and telling pages that join later of it."""

from __future__ import annotations

from carom.viewer.history.history import Excerpt, History
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.messages import decoded, encoded
from carom.viewer.protocol import to_page
from carom.viewer.replay.recording import Recording

# Size of the frames in one message about the past [bytes]: a page takes it between two pictures.
_PART_BYTES = 400_000


class HistoryRecorder:
    """Keeps the frames of a viewer, and the its latest messages. For use by one thread.

    Args:
        latest: The latest messages of its viewer.
        budget: Memory for the past [bytes]; with 0 nothing is kept.
    """

    def __init__(self, latest: LatestMessages, budget: int) -> None:
        self._history = History(budget)
        self._reader = latest.reader() if budget else None

    @property
    def is_on(self) -> bool:
        """Whether anything is kept."""
        return self._reader is not None

    @property
    def next_number(self) -> int:
        """Number of the next frame."""
        return self._history.end

    def take(self, frame: bytes | None) -> None:
        """Takes what has changed among the latest messages, and a frame; None if it is as the last one."""
        if self._reader is None:
            return
        self._history.take(self._reader.changes())
        if frame is not None:
            self._history.add(frame)

    def before(self, number: int, *, known: bool) -> Excerpt:
        """A part of the past: the last frames before one; `known` leaves out what is shown with that too."""
        return self._history.before(number, _PART_BYTES, known=known)


def packed_past(excerpt: Excerpt) -> bytes:
    """A part of the past as a message to a page, compressed. Safe to use from all threads."""
    packed = Recording()
    for version in excerpt.versions:
        packed.add(*decoded(version.message))
    for frame in excerpt.frames:
        packed.add(*decoded(frame))
    header = to_page.PAST(
        first=excerpt.first,
        oldest=excerpt.oldest,
        versions=[[version.name, version.begin, version.end] for version in excerpt.versions],
    )
    return encoded(header, packed.packed(level=1))
