"""Pages that ask again and again for what is new: where a proxy passes no sockets, as that of Colab.

A request states who asks (`page`, a name that the page has made up) and what it tells (`told`, any number of
JSON texts). The answer is the number the server knows the page by, and then messages, each after its
length; all are little-endian integers of four bytes. A page that finds itself under another number has
been forgotten, and is told everything again.
"""

from __future__ import annotations

import asyncio
import struct
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from urllib.parse import parse_qs, urlsplit

from carom.viewer.pages import Page, Pages

# How long a request may wait for something new [s]: what the page has to tell meanwhile waits as well.
_PATIENCE = 0.2
# Who has not asked for so long is gone [s]; browsers slow down what is in the background.
_SILENCE = 10.0
# Proxies do not pass answers of any length [bytes]; a message that is longer goes alone.
_MOST_BYTES = 4_000_000


class _Asker:
    """A page that asks, and what it has not been sent yet."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.asked = 0.0
        self.waiting: deque[bytes] = deque()


class Polling:
    """Answers pages that ask.

    Args:
        pages: The pages that are open.
        news: What a page has not been told.
        receive: Called with the number of a page and a text that it sends.
    """

    def __init__(
        self, pages: Pages, news: Callable[[Page], list[bytes]], receive: Callable[[int, str], None]
    ) -> None:
        self._pages = pages
        self._news = news
        self._receive = receive
        self._askers: dict[str, _Asker] = {}

    async def answer(self, path: str) -> bytes:
        """The answer to a request for a path.

        Raises:
            ValueError: The request does not say who asks.
        """
        query = parse_qs(urlsplit(path).query)
        (name,) = query.get("page", [])
        now = asyncio.get_running_loop().time
        asker = self._askers.get(name)
        if asker is None:
            asker = self._askers[name] = _Asker(self._pages.join())
        asker.asked = now()
        for text in query.get("told", ()):
            self._receive(asker.page.number, text)
        if not asker.waiting:
            with suppress(asyncio.TimeoutError):
                await asyncio.wait_for(asker.page.news.wait(), _PATIENCE)
            asker.page.news.clear()
            asker.waiting.extend(self._news(asker.page))
        return struct.pack("<I", asker.page.number) + b"".join(self._share(asker.waiting))

    def forget_silent(self) -> None:
        """Drops the pages that have stopped asking."""
        long_ago = asyncio.get_running_loop().time() - _SILENCE
        for name in [name for name, asker in self._askers.items() if asker.asked < long_ago]:
            self._pages.leave(self._askers.pop(name).page)

    @staticmethod
    def _share(waiting: deque[bytes]) -> list[bytes]:
        parts: list[bytes] = []
        room = _MOST_BYTES
        while waiting and (not parts or len(waiting[0]) <= room):
            message = waiting.popleft()
            room -= len(message)
            parts += (struct.pack("<I", len(message)), message)
        return parts
