"""The open pages, and the revision of each."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator

from carom.viewer.latest_messages import LatestMessages


class Page:
    """An open page, and the revision of the latest messages that it has.

    `news` is set when there may be new messages. A `spectator` only watches.
    """

    def __init__(self, number: int, *, spectator: bool) -> None:
        self.number = number
        self.spectator = spectator
        self.revision = 0
        self.news = asyncio.Event()
        self._frame: bytes | None = None
        self._letters: list[bytes] = []

    def tell(self, message: bytes) -> None:
        """Has a message sent to this page alone."""
        self._letters.append(message)
        self.news.set()

    def take_news(self, latest: LatestMessages, frame: bytes | None) -> list[bytes]:
        """The messages that are new to the page; they then count as sent."""
        messages, self.revision = latest.since(self.revision)
        if frame is not None and frame is not self._frame:
            messages.append(frame)
            self._frame = frame
        messages += self._letters
        self._letters = []
        return messages


class Pages:
    """The pages that are open; `gone` is called with the number of a page that has been closed.

    Attributes:
        somebody: Set while a page is open.
    """

    def __init__(self, gone: Callable[[int], None]) -> None:
        self.somebody = asyncio.Event()
        self._gone = gone
        self._open: set[Page] = set()
        self._numbers = 0

    def __iter__(self) -> Iterator[Page]:
        """The pages that are open now; safe to use from all threads."""
        return iter(tuple(self._open))

    def __len__(self) -> int:
        return len(self._open)

    @property
    def oldest_revision(self) -> int | None:
        """The oldest revision of the open pages; None without pages."""
        return min((page.revision for page in self), default=None)

    def in_control(self) -> set[int]:
        """Numbers of the pages that are not those of spectators; safe to use from all threads."""
        return {page.number for page in self if not page.spectator}

    def join(self, *, spectator: bool) -> Page:
        """Adds a page that was opened."""
        self._numbers += 1
        page = Page(self._numbers, spectator=spectator)
        self._open.add(page)
        self.somebody.set()
        return page

    def leave(self, page: Page) -> None:
        """Removes a page that was closed."""
        self._open.discard(page)
        if not self._open:
            self.somebody.clear()
        self._gone(page.number)

    def stop(self) -> None:
        """Tell nobody any more of pages that are closed."""
        self._gone = _nobody


def _nobody(_page: int) -> None:
    pass
