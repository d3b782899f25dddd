"""The server's end of connections: listening sockets, and a thread for each client."""

from __future__ import annotations

import logging
import socket
from collections.abc import Callable, Sequence
from contextlib import suppress
from threading import BoundedSemaphore, Event, Lock, Thread, current_thread

from carom.remote.errors import Malformed
from carom.remote.frames import OF_CALLS, Frame, Reader, send
from carom.remote.handshake import admit

MAX_CLIENTS = 64
"""Maximum number of clients at the same time."""

# Maximum number of connections that have not completed the handshake. They do not count as clients; if there
# are too many, the oldest is closed. Clients complete the handshake within a millisecond, so that connections
# of strangers cannot keep them out.
_MAX_STRANGERS = 32
# How long to wait for the calls in progress when a server closes [s].
_PATIENCE = 5.0
# How often a thread that waits for connections checks whether the server is closing [s]: on some systems
# closing the socket does not wake it up.
_LOOK = 0.5

_log = logging.getLogger("carom")

Answer = Callable[[Frame], tuple[bytes, list[memoryview]]]
"""Makes the reply to a frame: message and contents of its arrays; raises `Malformed` for invalid frames."""


class Listener:
    """Accepts clients that know the key, and answers their calls; those of one client one after the other.

    The connection of a client that sends invalid data is closed. A client that hangs blocks only its own
    thread.

    Args:
        addresses: Hosts and ports to listen at; port 0 for any free port.
        key: The key that clients need.
        answer: Makes the reply to a frame; called by several threads at once.

    Attributes:
        addresses: Hosts and actual ports, in the order of the argument.

    Raises:
        OSError: The server cannot listen at an address.
    """

    def __init__(self, addresses: Sequence[tuple[str, int]], key: bytes, answer: Answer) -> None:
        self._key = key
        self._answer = answer
        self._closing = Event()
        self._lock = Lock()
        self._places = BoundedSemaphore(MAX_CLIENTS)
        self._strangers: dict[socket.socket, None] = {}
        self._talks: dict[Thread, socket.socket] = {}
        self._sockets: list[socket.socket] = []
        try:
            for host, port in addresses:
                self._sockets.append(_listening(host, port))
        except OSError:
            self._close_sockets()
            raise
        self.addresses: list[tuple[str, int]] = [one.getsockname()[:2] for one in self._sockets]
        self._threads = [
            Thread(target=self._accept, args=(listening,), name="carom server", daemon=True)
            for listening in self._sockets
        ]
        for thread in self._threads:
            thread.start()

    @property
    def client_count(self) -> int:
        """Number of connections, admitted or not."""
        return len(self._talks)

    def close(self) -> None:
        """Close all connections; calls in progress are completed, but their answers are dropped."""
        self._closing.set()
        self._close_sockets()
        with self._lock:
            talks = dict(self._talks)
        for peer in talks.values():
            _hang_up(peer)
        for thread in (*self._threads, *talks):
            if thread is not current_thread():
                thread.join(_PATIENCE)

    def abandon(self) -> None:
        """Close the sockets that a forked process has inherited, without effect on its parent."""
        for inherited in (*self._sockets, *self._talks.values()):
            inherited.close()

    def _close_sockets(self) -> None:
        for listening in self._sockets:
            # On some systems this wakes up the thread that waits for clients.
            with suppress(OSError):
                listening.shutdown(socket.SHUT_RDWR)
            listening.close()

    def _accept(self, listening: socket.socket) -> None:
        while not self._closing.is_set():
            try:
                peer, _ = listening.accept()
            except TimeoutError:
                continue
            except OSError:
                # The server is closing, the connection was closed, or there are no more file descriptors.
                self._closing.wait(0.05)
                continue
            thread = Thread(target=self._talk, args=(peer,), name="carom client", daemon=True)
            with self._lock:
                if len(self._strangers) >= _MAX_STRANGERS:
                    _hang_up(next(iter(self._strangers)))
                    del self._strangers[next(iter(self._strangers))]
                self._strangers[peer] = None
                self._talks[thread] = peer
            thread.start()

    def _talk(self, peer: socket.socket) -> None:
        try:
            with peer:
                if self._admitted(peer) and not self._closing.is_set():
                    try:
                        self._converse(peer)
                    finally:
                        self._places.release()
        except (OSError, EOFError):
            pass
        except Malformed as problem:
            _log.warning("A client has lost its connection: %s", problem)
        except Exception:
            _log.exception("A client has lost its connection.")
        finally:
            with self._lock:
                del self._talks[current_thread()]

    def _admitted(self, peer: socket.socket) -> bool:
        """Whether a client is accepted: it knows the key, and a place in `_places` was free and is taken."""
        has_place = False

        def take_place() -> bool:
            nonlocal has_place
            has_place = self._places.acquire(blocking=False)
            return has_place

        try:
            if not admit(peer, self._key, take_place):
                _log.warning("A client with a wrong key was refused.")
            elif not has_place:
                _log.warning("A client was refused: there are %s already.", MAX_CLIENTS)
            return has_place
        except BaseException:
            if has_place:
                self._places.release()
            raise
        finally:
            with self._lock:
                self._strangers.pop(peer, None)

    def _converse(self, peer: socket.socket) -> None:
        peer.settimeout(None)
        peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        # Keep-alive probes detect clients whose machine has failed without closing the connection.
        peer.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        reader = Reader(peer, OF_CALLS)
        while not self._closing.is_set():
            frame = reader.frame()
            message, arrays = self._answer(frame)
            send(peer, frame.number, message, arrays)


def _listening(host: str, port: int) -> socket.socket:
    family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    listening = socket.create_server(address[:2], family=family)
    listening.settimeout(_LOOK)
    return listening


def _hang_up(peer: socket.socket) -> None:
    with suppress(OSError):
        peer.shutdown(socket.SHUT_RDWR)
