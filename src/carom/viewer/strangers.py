"""Connections that have not shown the token yet: there are few at a time, and none for long.

Without a limit, silent connections would use up the file descriptors of the user's process.
"""

from __future__ import annotations

import asyncio
from typing import Any

from websockets.asyncio.server import ServerConnection

MOST = 64
"""Maximum number of strangers; if there are more, the oldest is closed. So they keep no page out."""
PATIENCE = 5.0
"""How long a stranger may stay [s]; a page shows the token within milliseconds."""
BACKLOG = 16
"""Connections accepted at once: few, so that a page is heard before so many others come that it has to go."""


class Strangers:
    """The connections that have not shown the token, the oldest first; for one event loop."""

    def __init__(self) -> None:
        self._waiting: dict[ServerConnection, asyncio.TimerHandle] = {}

    def __len__(self) -> int:
        return len(self._waiting)

    def join(self, connection: ServerConnection) -> None:
        """Adds a connection that was made; closes the oldest if there are too many."""
        loop = asyncio.get_running_loop()
        self._waiting[connection] = loop.call_later(PATIENCE, self._close, connection)
        if len(self._waiting) > MOST:
            self._close(next(iter(self._waiting)))

    def admit(self, connection: ServerConnection) -> None:
        """Removes a connection, which has shown the token or is closed."""
        timer = self._waiting.pop(connection, None)
        if timer is not None:
            timer.cancel()

    def connection(self, *arguments: Any, **keywords: Any) -> ServerConnection:
        """A connection that is a stranger at first, by the arguments of its class."""
        connection = _Connection(*arguments, **keywords)
        connection.strangers = self
        return connection

    def _close(self, connection: ServerConnection) -> None:
        self.admit(connection)
        # Not `close`, which would wait for the other side.
        connection.transport.abort()


class _Connection(ServerConnection):
    strangers: Strangers

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        super().connection_made(transport)
        self.strangers.join(self)

    def connection_lost(self, exc: Exception | None) -> None:
        self.strangers.admit(self)
        super().connection_lost(exc)
