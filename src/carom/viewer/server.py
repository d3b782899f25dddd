"""The server of the page: files by HTTP, and a WebSocket to each open page."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from http import HTTPStatus
from pathlib import Path
from threading import Event, Thread
from typing import Any, cast

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from carom.viewer.access import Access
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.messages import MAX_INCOMING_BYTES, received
from carom.viewer.page_files import lasting_files, page_files, served_page
from carom.viewer.pages import Page, Pages
from carom.viewer.polling import Polling
from carom.viewer.protocol.from_page import SPECTATING
from carom.viewer.replay.page import replay_page
from carom.viewer.strangers import BACKLOG, Strangers

_log = logging.getLogger("carom")
# The websockets library logs an error when a browser closes a connection during a request, which is normal.
_quiet = logging.getLogger("carom.viewer.sockets")
_quiet.setLevel(logging.CRITICAL)
_THREAD_NAME = "carom viewer"

_OTHER_NAME = "This server does not answer to that host name; the option --names of connect allows it.\n"
_WHOLE_ADDRESS = "Open the whole address that the simulation has printed, with its token.\n"


# Asyncio's warnings about closed sockets do not belong in the terminal of a script.
logging.getLogger("asyncio").addFilter(lambda record: record.threadName != _THREAD_NAME)

PREFERRED_PORT = 8400
_FRAMES_PER_SECOND = 60
_FRAMES_PER_SECOND_UNWATCHED = 30
_KINDS = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
}
_POLICY = (
    "default-src 'self'; connect-src 'self' ws: wss:; img-src 'self' data: blob:; "
    "style-src 'self' 'unsafe-inline'"
)
# By this notebooks find out at which address the server can be reached.
_PROBE = "/icon.svg"
_FOR_EVER = "public, max-age=31536000, immutable"
# Sites that may embed the page without the token: those of this machine. With the token any site may embed
# it, such as a notebook or an editor.
_OWN_FRAMES = "; frame-ancestors 'self' http://localhost:* http://127.0.0.1:*"


@cache
def _files() -> dict[str, tuple[str, bytes]]:
    """Type and content of all files that the server serves, by path."""
    files = {f"/{name}": (_KINDS[Path(name).suffix], content) for name, content in lasting_files().items()}
    files[_PROBE] = (_KINDS[".svg"], page_files()["icon.svg"])
    pages = {"/": served_page(), "/replay.html": replay_page().encode()}
    return {**files, **{path: (_KINDS[".html"], page) for path, page in pages.items()}}


def _is_part(path: str) -> bool:
    """Whether a file belongs to the page.

    These files need no token: in a notebook of another site the browser sends no cookie.
    """
    return path == _PROBE or path[1:] in lasting_files()


def _headers(kind: str, content: bytes, policy: str, cache: str = "no-cache") -> Headers:
    return Headers(
        {
            "Content-Type": kind,
            "Content-Length": str(len(content)),
            "Content-Security-Policy": policy,
            "X-Content-Type-Options": "nosniff",
            "Cache-Control": cache,
            "Connection": "close",
        }
    )


def _no_frame() -> None:
    return None


def _no_answer(_page: int, _message: dict[str, Any]) -> None:
    pass


class PageServer:
    """Updates all open pages, at display rate, from its own thread.

    Args:
        access: Where to listen, and access control.
        port: Port to listen on; None for the default port or, if it is taken, any; 0 for any.
        latest: The messages that make up the scene.
        frame: Called at display rate while pages are open. Returns a message with poses, or None if nothing
            has changed. Slow pages skip frames.
        receive: Called with the number of a page and a message that it sends.
        gone: Called with the number of a page that has been closed.
        unwatched: As `frame`, called 30 times a second while no pages are open.

    Raises:
        OSError: The server cannot listen on the address.
    """

    def __init__(
        self,
        access: Access,
        port: int | None,
        latest: LatestMessages,
        frame: Callable[[], bytes | None],
        receive: Callable[[int, dict[str, Any]], None],
        gone: Callable[[int], None],
        unwatched: Callable[[], bytes | None] | None = None,
    ) -> None:
        self.access = access
        self.port = 0
        self._wanted_ports = (PREFERRED_PORT, 0) if port is None else (port,)
        self._latest = latest
        self._make_frame = frame
        self._frame: bytes | None = None
        self._receive = receive
        self._unwatched = unwatched
        self._letters: set[asyncio.Task[None]] = set()
        self._pages = Pages(gone)
        self._strangers = Strangers()
        self._polling = Polling(self._pages, self._news, self._take)
        self._started = Event()
        self._problem: OSError | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread = Thread(target=self._run, name=_THREAD_NAME, daemon=True)
        self._thread.start()
        self._started.wait()
        if self._problem is not None:
            raise self._problem

    @property
    def address(self) -> str:
        """The address of the page."""
        return self.access.address(self.port)

    @property
    def spectator_address(self) -> str:
        """The address of the page for those who only watch."""
        return self.access.spectator_address(self.port)

    @property
    def page_count(self) -> int:
        """Number of open pages."""
        return len(self._pages)

    def in_control(self) -> set[int]:
        """Numbers of the open pages that are not those of spectators, as passed to `receive`."""
        return self._pages.in_control()

    def has_sent(self, revision: int) -> bool:
        """Whether all open pages have a revision of the latest messages."""
        oldest = self._pages.oldest_revision
        return oldest is None or oldest >= revision

    def send_later(self, number: int, write: Callable[[], bytes]) -> None:
        """Sends a page a message that takes long to write, by a thread of its own.

        It is called while a message of the page is received. Another one that is not written yet comes first.
        """
        page = next((page for page in self._pages if page.number == number), None)
        if page is not None:
            letter = asyncio.get_running_loop().create_task(self._write(page, write))
            self._letters.add(letter)
            letter.add_done_callback(self._letters.discard)

    def stop(self) -> None:
        """Closes all sockets; pages then show that the simulation has ended."""
        loop = self._loop
        if loop is not None:
            with suppress(RuntimeError):
                loop.call_soon_threadsafe(self._stopping.set)
        self._thread.join(timeout=5.0)
        if not self._thread.is_alive():
            # What they refer to refers to the server; nobody calls them any more.
            self._make_frame, self._receive, self._unwatched = _no_frame, _no_answer, None
            self._pages.stop()
            self._polling.stop()

    def _run(self) -> None:
        try:
            asyncio.run(self._serve())
        except OSError as problem:
            self._problem = problem
        except Exception:
            _log.exception("The viewer has stopped.")
        finally:
            self._loop = None
            self._started.set()

    @staticmethod
    async def _write(page: Page, write: Callable[[], bytes]) -> None:
        page.tell(await asyncio.to_thread(write))

    async def _serve(self) -> None:
        self._stopping = asyncio.Event()
        async with await self._listen() as server:
            self.port: int = next(iter(server.sockets)).getsockname()[1]
            self._loop = asyncio.get_running_loop()
            self._started.set()
            beat = asyncio.create_task(self._beat())
            await self._stopping.wait()
            beat.cancel()
        # It refers to functions that refer to it.
        vars(server).clear()

    async def _listen(self) -> Server:
        *first, last = self._wanted_ports
        for port in first:
            with suppress(OSError):
                return await self._listen_on(port)
        return await self._listen_on(last)

    async def _listen_on(self, port: int) -> Server:
        return await serve(
            self._talk,
            self.access.host,
            port,
            process_request=self._answer,
            # Compression hardly makes poses smaller, and takes longer than sending them.
            compression=None,
            max_size=MAX_INCOMING_BYTES,
            logger=_quiet,
            close_timeout=1.0,
            create_connection=cast(Any, self._strangers.connection),
            backlog=BACKLOG,
        )

    async def _beat(self) -> None:
        """Makes frames while pages are open."""
        loop = asyncio.get_running_loop()
        due = loop.time()
        while True:
            await self._wait_for_pages()
            self._polling.forget_silent()
            try:
                self._frame = self._make_frame() or self._frame
            except Exception:
                _log.exception("The viewer could not read the world.")
            self._latest.forget_removals(self._pages.oldest_revision)
            for page in self._pages:
                page.news.set()
            due = max(due + 1.0 / _FRAMES_PER_SECOND, loop.time())
            await asyncio.sleep(due - loop.time())

    async def _wait_for_pages(self) -> None:
        if self._unwatched is None:
            await self._pages.somebody.wait()
            return
        while not len(self._pages):
            try:
                self._frame = self._unwatched() or self._frame
            except Exception:
                _log.exception("The viewer could not read the world.")
            self._latest.forget_removals(None)
            # A page that comes meanwhile waits: to be told at once of it would cost more than a frame.
            await asyncio.sleep(1.0 / _FRAMES_PER_SECOND_UNWATCHED)

    async def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        hosts, origins = request.headers.get_all("Host"), request.headers.get_all("Origin")
        cookies = "; ".join(request.headers.get_all("Cookie"))
        host = hosts[0] if len(hosts) == 1 else None
        path = request.path.partition("?")[0]
        access = self.access
        spectator = access.is_spectator(request.path)
        if spectator or access.knows_token(request.path) or access.has_cookie(cookies):
            self._strangers.admit(connection)
        if access.guesses_token(request.path):
            return connection.respond(HTTPStatus.FORBIDDEN, _WHOLE_ADDRESS)
        # A header that may occur once, but occurs several times, counts as missing.
        if len(origins) > 1 or not (_is_part(path) or access.may_read(request.path, host, cookies)):
            return connection.respond(HTTPStatus.MISDIRECTED_REQUEST, _OTHER_NAME)
        if path == "/socket":
            if access.may_connect(request.path, host, origins[0] if origins else None, cookies):
                self._strangers.admit(connection)
                return None
            return connection.respond(HTTPStatus.FORBIDDEN, "Only the viewer's own page may connect.\n")
        if path == "/poll":
            # The token is required: browsers send no origin here, and the cookie goes to all ports of a host.
            if not (spectator or access.knows_token(request.path)):
                return connection.respond(HTTPStatus.FORBIDDEN, _WHOLE_ADDRESS)
            return await self._answer_poll(connection, request.path)
        if path == "/" and not access.is_known(request.path, host, cookies):
            return connection.respond(HTTPStatus.FORBIDDEN, _WHOLE_ADDRESS)
        file = _files().get(path)
        if file is None:
            return connection.respond(HTTPStatus.NOT_FOUND, "There is no such file.\n")
        kind, content = file
        if path != _PROBE and _is_part(path):
            return Response(HTTPStatus.OK, "OK", _headers(kind, content, _POLICY, _FOR_EVER), content)
        if spectator:
            content = served_page(spectator=True) if path == "/" else content
            return Response(HTTPStatus.OK, "OK", _headers(kind, content, _POLICY), content)
        if not access.knows_token(request.path):
            return Response(HTTPStatus.OK, "OK", _headers(kind, content, _POLICY + _OWN_FRAMES), content)
        headers = _headers(kind, content, _POLICY)
        headers["Set-Cookie"] = f"{access.cookie}; HttpOnly; SameSite=Strict"
        return Response(HTTPStatus.OK, "OK", headers, content)

    async def _answer_poll(self, connection: ServerConnection, path: str) -> Response:
        try:
            content = await self._polling.answer(path, spectator=self.access.is_spectator(path))
        except ValueError:
            return connection.respond(HTTPStatus.BAD_REQUEST, "The request does not name its page.\n")
        headers = _headers("application/octet-stream", content, _POLICY, cache="no-store")
        return Response(HTTPStatus.OK, "OK", headers, content)

    def _news(self, page: Page) -> list[bytes]:
        return page.take_news(self._latest, self._frame)

    def _take(self, page: Page, text: str | bytes) -> None:
        """Handles a message from a page; a spectator is not listened to, but for what it asks to be shown."""
        try:
            message = received(text)
            if not page.spectator or message["type"] in SPECTATING:
                self._receive(page.number, message)
        except (KeyError, TypeError, ValueError, OverflowError, RecursionError) as problem:
            _log.debug("A page sent an invalid message: %s", problem)

    async def _talk(self, connection: ServerConnection) -> None:
        request = connection.request
        spectator = request is None or self.access.is_spectator(request.path)
        page = self._pages.join(spectator=spectator)
        sender = asyncio.create_task(self._send(connection, page))
        try:
            async for message in connection:
                self._take(page, message)
        except ConnectionClosed:
            pass
        finally:
            sender.cancel()
            self._pages.leave(page)

    async def _send(self, connection: ServerConnection, page: Page) -> None:
        with suppress(ConnectionClosed):
            while True:
                await page.news.wait()
                page.news.clear()
                for message in self._news(page):
                    await connection.send(message)
