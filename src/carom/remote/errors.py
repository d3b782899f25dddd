"""Exceptions of connections between two processes."""

from __future__ import annotations

from carom.errors import CaromError


class RemoteError(CaromError):
    """Two processes cannot communicate, or no longer can."""


class NoServer(RemoteError):
    """There is no server, or it refuses the connection."""


class ServerGone(RemoteError):
    """The server does not answer any more."""


class Malformed(RemoteError):
    """Data do not follow the protocol, or are too long."""
