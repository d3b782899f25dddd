"""The client's end of a connection."""

from __future__ import annotations

import socket
from contextlib import suppress
from threading import Lock
from typing import Any

from carom.remote.errors import Malformed, NoServer, ServerGone
from carom.remote.frames import MAX_NUMBER, OF_CALLS, OF_RESULTS, Reader, check_size, send
from carom.remote.handshake import TIMEOUT, enter
from carom.remote.values import pack, unpack

# Longer timeouts than this mean no timeout: the system counts milliseconds in 32 bits [s].
_FOR_EVER = 1e6


class Connection:
    """One connection to a server. Thread-safe: calls of several threads are made one after the other.

    `timeout` is how long to wait for an answer [s].

    Raises:
        NoServer: There is no server, or it refuses the connection.
    """

    def __init__(self, host: str, port: int, key: bytes, timeout: float) -> None:
        try:
            self._socket = socket.create_connection((host, port), TIMEOUT)
        # OverflowError: invalid port number; UnicodeError: invalid host name.
        except (OSError, OverflowError, UnicodeError) as problem:
            raise NoServer(f"No server can be reached at {host}:{port}: {problem}.") from problem
        try:
            enter(self._socket, key)
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        except BaseException:
            self._socket.close()
            raise
        self._lock = Lock()
        self._number = 0
        self._reader = Reader(self._socket, OF_RESULTS)
        self._timeout: float | None = None
        self.set_timeout(timeout)

    def set_timeout(self, seconds: float) -> None:
        """Set how long to wait for an answer [s]."""
        self._timeout = seconds if seconds < _FOR_EVER else None

    def call(self, request: Any) -> Any:
        """Send a request and wait for the answer.

        Raises:
            ServerGone: There is no answer in time, or the connection is lost; it is then closed.
            Malformed: The request is too large; the connection stays open.
        """
        message, arrays = pack(request)
        check_size(message, arrays, OF_CALLS)
        with self._lock:
            self._number = self._number % MAX_NUMBER + 1
            try:
                self._socket.settimeout(self._timeout)
                self._send(message, arrays)
                frame = self._reader.frame()
                # Skip late answers to calls that were interrupted.
                while frame.number != self._number:
                    frame = self._reader.frame()
                return unpack(frame.message, frame.contents, lists=False)
            except TimeoutError as problem:
                self.close()
                raise ServerGone(f"The server has not answered within {self._timeout:g} s.") from problem
            except Malformed as problem:
                self.close()
                raise ServerGone("The server's answer cannot be read.") from problem
            except (OSError, EOFError) as problem:
                self.close()
                raise ServerGone("The server has closed the connection.") from problem

    @property
    def is_usable(self) -> bool:
        """Whether the connection has not been closed at this end."""
        return self._socket.fileno() >= 0

    def is_open(self) -> bool:
        """Whether the connection is open at both ends, as far as the socket shows without a request."""
        if not self.is_usable:
            return False
        if not self._lock.acquire(blocking=False):
            # Another thread is waiting for an answer, and will notice if the connection is lost.
            return True
        try:
            self._socket.setblocking(False)
            gone = not self._socket.recv(1, socket.MSG_PEEK)
        except BlockingIOError:
            gone = False
        except OSError:
            gone = True
        finally:
            self._lock.release()
        if gone:
            self.close()
        return not gone

    def close(self) -> None:
        """Close the connection; the server keeps running."""
        # Closing alone would not wake up a thread that is waiting for an answer.
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)
        self._socket.close()

    def abandon(self) -> None:
        """Close the socket that a forked process has inherited; its parent keeps the connection."""
        self._socket.close()

    def _send(self, message: bytes, arrays: list[memoryview]) -> None:
        try:
            send(self._socket, self._number, message, arrays)
        except OSError:
            raise
        except BaseException:
            # Interrupted in the middle of a frame: the server would read the next frame as its rest.
            self.close()
            raise
