"""Mutual authentication: client and server prove that they know the key, without sending it.

The client sends a greeting and a random number. The server answers with its greeting, a random number of its
own, and a digest (HMAC-SHA256) of both numbers under the key. The client then sends a digest of its own. If
it is right, the server sends a last byte: the client is accepted, or the server has its maximum number of
clients. So without the key nobody can use a server or impersonate one.
"""

from __future__ import annotations

import hmac
import secrets
import socket
from collections.abc import Callable
from time import monotonic

from carom.remote.errors import NoServer

TIMEOUT = 5.0
"""Time limit of the whole handshake, on either side [s]."""

_GREETING = b"carom 1\n"
_NONCE = 32
_DIGEST = 32
_WELCOME, _FULL = b"+", b"-"


def new_key() -> bytes:
    """A random key that cannot be guessed."""
    return secrets.token_hex(32).encode()


def enter(peer: socket.socket, key: bytes) -> None:
    """The client's side; raises `NoServer` for another version or key, or if the connection is refused."""
    mine = secrets.token_bytes(_NONCE)
    talk = _Talk(peer)
    try:
        peer.sendall(_GREETING + mine)
        if talk.receive(len(_GREETING)) != _GREETING:
            raise NoServer("The program that answers there is not a physics server of this version of Carom.")
        theirs = talk.receive(_NONCE)
        if not hmac.compare_digest(talk.receive(_DIGEST), _digest(key, b"server", mine, theirs)):
            raise NoServer("The server has another key.")
        peer.sendall(_digest(key, b"client", mine, theirs))
        if talk.receive(len(_WELCOME)) != _WELCOME:
            raise NoServer("The server has its maximum number of clients.")
    except (OSError, EOFError) as problem:
        raise NoServer(f"The server refuses the connection: {problem}") from problem


def admit(peer: socket.socket, key: bytes, take_place: Callable[[], bool]) -> bool:
    """The server's side of the handshake: whether the client knows the key.

    `take_place` reserves a place for another client; it returns False if none is left. It is called if the
    client knows the key, and the client is told the result.

    Raises:
        OSError: The socket is closed, or the time limit is over.
        EOFError: The client has closed the connection.
    """
    talk = _Talk(peer)
    if talk.receive(len(_GREETING)) != _GREETING:
        return False
    theirs = talk.receive(_NONCE)
    mine = secrets.token_bytes(_NONCE)
    peer.sendall(_GREETING + mine + _digest(key, b"server", theirs, mine))
    if not hmac.compare_digest(talk.receive(_DIGEST), _digest(key, b"client", theirs, mine)):
        return False
    has_place = take_place()
    peer.sendall(_WELCOME if has_place else _FULL)
    return True


def _digest(key: bytes, side: bytes, of_client: bytes, of_server: bytes) -> bytes:
    return hmac.digest(key, side + of_client + of_server, "sha256")


class _Talk:
    """Receives data within a time limit for all of them, even if they arrive byte by byte."""

    def __init__(self, peer: socket.socket) -> None:
        self._peer = peer
        self._deadline = monotonic() + TIMEOUT

    def receive(self, size: int) -> bytes:
        content = b""
        while len(content) < size:
            self._peer.settimeout(max(self._deadline - monotonic(), 0.001))
            piece = self._peer.recv(size - len(content))
            if not piece:
                raise EOFError("the connection was closed")
            content += piece
        return content
