"""Polling, for proxies that do not support WebSockets, such as Colab's.

The query of a request has a name that the page has chosen (`page`) and the page's messages (`told`, any
number of JSON texts). The answer is the server's number for the page, and then messages, each after its
length; number and lengths are little-endian integers of four bytes. If a page gets another number than
before, the server had dropped it, and now sends the whole scene again.
"""

from __future__ import annotations

import asyncio
import struct
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from urllib.parse import parse_qs, urlsplit

from carom.viewer.pages import Page, Pages

# Maximum time that a request waits for new messages [s]; the page's own messages wait as long.
_PATIENCE = 0.2
# A page without requests for this time counts as closed [s]; browsers slow down pages in the background.
_SILENCE = 10.0
# Maximum length of an answer, which proxies limit [bytes]; a longer message is sent alone.
_MAX_BYTES = 4_000_000


class _Asker:
    """A page that polls, and the messages it has not been sent yet."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.asked = 0.0
        self.waiting: deque[bytes] = deque()


class Polling:
    """Answers pages that poll, with the messages `news` for a page; `receive` is called with its texts."""

    def __init__(
        self, pages: Pages, news: Callable[[Page], list[bytes]], receive: Callable[[Page, str], None]
    ) -> None:
        self._pages = pages
        self._news = news
        self._receive = receive
        # By name and by whether they are spectators: no request speaks for a page of the other kind.
        self._askers: dict[tuple[str, bool], _Asker] = {}

    async def answer(self, path: str, *, spectator: bool) -> bytes:
        """The answer to a request for a path; raises `ValueError` if it does not name its page."""
        query = parse_qs(urlsplit(path).query)
        (name,) = query.get("page", [])
        now = asyncio.get_running_loop().time
        asker = self._askers.get((name, spectator))
        if asker is None:
            asker = self._askers[name, spectator] = _Asker(self._pages.join(spectator=spectator))
        asker.asked = now()
        for text in query.get("told", ()):
            self._receive(asker.page, text)
        if not asker.waiting:
            with suppress(asyncio.TimeoutError):
                await asyncio.wait_for(asker.page.news.wait(), _PATIENCE)
            asker.page.news.clear()
            asker.waiting.extend(self._news(asker.page))
        return struct.pack("<I", asker.page.number) + b"".join(self._share(asker.waiting))

    def stop(self) -> None:
        """Forget who has the messages, and who receives them."""
        self._news, self._receive = _no_news, _nobody

    def forget_silent(self) -> None:
        """Drops the pages that have stopped polling."""
        long_ago = asyncio.get_running_loop().time() - _SILENCE
        for name in [name for name, asker in self._askers.items() if asker.asked < long_ago]:
            self._pages.leave(self._askers.pop(name).page)

    @staticmethod
    def _share(waiting: deque[bytes]) -> list[bytes]:
        parts: list[bytes] = []
        room = _MAX_BYTES
        while waiting and (not parts or len(waiting[0]) <= room):
            message = waiting.popleft()
            room -= len(message)
            parts += (struct.pack("<I", len(message)), message)
        return parts


def _no_news(_page: Page) -> list[bytes]:
    return []


def _nobody(_page: Page, _text: str) -> None:
    pass
