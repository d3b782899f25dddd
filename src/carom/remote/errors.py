"""What can go wrong between two processes."""

from __future__ import annotations

from carom.errors import CaromError


class RemoteError(CaromError):
    """Two processes cannot talk to each other, or no longer."""


class NoServer(RemoteError):
    """There is no server, or none that wants to talk."""


class ServerGone(RemoteError):
    """The server does not answer any more."""


class Malformed(RemoteError):
    """Data from the socket do not follow the protocol, or are too long."""
