"""Addresses at which servers listen and clients connect, from the options of `connect`."""

from __future__ import annotations

import logging
import os
from contextlib import suppress
from dataclasses import dataclass
from ipaddress import ip_address
from pathlib import Path
from typing import NamedTuple

from carom.remote.handshake import new_key
from carom.remote.private_folder import write_private
from carom.remote.rendezvous import Note, find
from pybullet._calls import constants
from pybullet._calls.errors import fail
from pybullet._calls.options import Target

KEY_VARIABLE = "CAROM_SERVER_KEY"
"""Environment variable with the key of a server."""

_MIN_KEY, _MAX_KEY = 16, 4096
_LOOPBACK = "127.0.0.1"
_FOR_EVER, _A_MINUTE = 1e30, 60.0
_SHARED_MEMORY, _GRAPHICS, _TCP, _UDP = "shared-memory", "graphics", "tcp", "udp"
_DEFAULT_PORTS = {_TCP: 6667, _UDP: 1234}
_CANNOT_START = "Cannot start the physics server:"


class Meeting(NamedTuple):
    """An address at which a server can be reached.

    Attributes:
        kind: Kind of connection.
        host: Address at which the server listens.
        port: Port at which it listens; 0 for any free one.
        number: Distinguishes servers of one kind: key or port; 0 for the port that the server is assigned.
    """

    kind: str
    host: str
    port: int
    number: int

    def name(self, port: int) -> str:
        """Name of the note by which clients find the server, if it listens at `port`."""
        return f"{self.kind}-{self.number or port}"


@dataclass(frozen=True)
class ServerOptions:
    """Options of a server: the addresses at which it can be reached, and the key that clients need."""

    meetings: tuple[Meeting, ...]
    key: bytes


class Address(NamedTuple):
    """The address of the server that a client connects to.

    Attributes:
        places: Address and key, for each possible key.
        timeout: Initial time limit for an answer [s].
        importance: Log level of the message if there is no server.
        nobody: Message if `places` is empty.
    """

    places: tuple[Note, ...]
    timeout: float
    importance: int
    nobody: str


def server_options(method: int, target: Target) -> ServerOptions:
    """The addresses and the key of a server; raises `pybullet.error` for a wrong port or an unusable key."""
    bind = target.option("bind") or _LOOPBACK
    graphics = method in (constants.GRAPHICS_SERVER, constants.GRAPHICS_SERVER_MAIN_THREAD)
    meetings = [Meeting(_GRAPHICS if graphics else _SHARED_MEMORY, _LOOPBACK, 0, target.key)]
    for kind, usual in _DEFAULT_PORTS.items():
        port = target.option(kind)
        if port is not None:
            number = _port(port) if port else usual
            meetings.append(Meeting(kind, bind, number, number))
    return ServerOptions(tuple(meetings), _own_key(target, bind))


def address_of(method: int, target: Target) -> Address:
    """A server's address for a client's arguments of `connect`; `pybullet.error` for a bad key file."""
    if method in (constants.SHARED_MEMORY, constants.GRAPHICS_CLIENT):
        note = find(f"{_SHARED_MEMORY if method == constants.SHARED_MEMORY else _GRAPHICS}-{target.key}")
        nobody = f"No server has the key {target.key}."
        return Address((note,) if note else (), _FOR_EVER, logging.INFO, nobody)
    assert method in (constants.TCP, constants.UDP, constants.GRAPHICS_SERVER_TCP)
    kind = _UDP if method == constants.UDP else _TCP
    port = target.port if target.port >= 0 else _DEFAULT_PORTS[kind]
    keys = [_given_key(target)]
    if _is_loopback(target.host):
        note = find(f"{kind}-{port}")
        keys.append(note.key if note else None)
    places = tuple(Note(target.host, port, key) for key in keys if key)
    nobody = f"You have none named {kind}-{port} on this machine, and no key is given for others."
    return Address(places, _A_MINUTE, logging.WARNING, nobody)


def reachable(host: str) -> str:
    """The address by which clients on this machine reach a server."""
    return {"0.0.0.0": _LOOPBACK, "::": "::1"}.get(host, host)


def _port(text: str) -> int:
    number = int(text) if text.isdecimal() else -1
    if not 0 <= number <= 65535:
        fail(_CANNOT_START, f"{text!r} is no port.")
    return number


def _is_loopback(host: str) -> bool:
    with suppress(ValueError):
        return ip_address(host).is_loopback
    return host.lower() == "localhost"


def _given_key(target: Target) -> bytes | None:
    """The key in the options or the environment."""
    file = target.option("key-file")
    if file:
        try:
            # A device may have no end.
            with open(file, encoding="utf-8") as stream:
                return _fit(stream.read(_MAX_KEY), file)
        except (OSError, UnicodeError) as problem:
            fail("Cannot read the key of the physics server:", f"{problem}.")
    text = os.environ.get(KEY_VARIABLE)
    return _fit(text, KEY_VARIABLE) if text else None


def _own_key(target: Target, bind: str) -> bytes:
    """The key of a server; if its key file does not exist, the file is written with a new key."""
    file = target.option("key-file")
    if file and not Path(file).exists():
        key = new_key()
        try:
            write_private(Path(file), key)
        except OSError as problem:
            fail(_CANNOT_START, f"{problem}.")
        return key
    given = _given_key(target)
    if given is None and not _is_loopback(bind):
        fail(
            _CANNOT_START,
            f"other machines can reach {bind}, so clients need a key they know: state --key-file=FILE or "
            f"set {KEY_VARIABLE}.",
        )
    return given or new_key()


def _fit(text: str, origin: str) -> bytes:
    key = text.strip().encode()
    if len(key) < _MIN_KEY:
        fail("The key of the physics server is too short.", f"{origin} has less than {_MIN_KEY} characters.")
    return key
