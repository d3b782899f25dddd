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
    """What came over the socket is not what was agreed on, or too much of it."""
