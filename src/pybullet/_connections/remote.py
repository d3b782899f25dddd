"""Connections to a server in another process."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any
from weakref import WeakMethod, WeakSet

from carom.remote.errors import Malformed, NoServer, ServerGone
from pybullet._access.user_data_view import UserDataView
from pybullet._calls.errors import NOT_CONNECTED, error, fail, logger

if TYPE_CHECKING:
    from carom.remote.connection import Connection
    from pybullet._calls.detours import Function
    from pybullet._connections.server_options import Address

RESULT, PROBLEM = 0, 1
"""First item of an answer; the result follows, or the name and text of the exception."""

ERROR = "pybullet.error"
"""Name of `pybullet.error` in answers; other exceptions have their Python names."""

# Exceptions that functions raise for wrong arguments; all others become `error`.
EXCEPTIONS = {
    kind.__name__: kind
    for kind in (TypeError, ValueError, OverflowError, IndexError, KeyError, OSError, MemoryError)
}

at_work: WeakSet[Any] = WeakSet()
"""Connections and servers of this process, which a forked process leaves to its parent."""


class RemoteClient:
    """A connection to a world in another process."""

    def __init__(self, method: int, connection: Connection) -> None:
        self.method = method
        self._connection = connection
        ask = WeakMethod(self._ask)
        self._user_data = UserDataView(
            lambda name, *arguments: (own := ask()) and own(name, list(arguments), {})
        )
        at_work.add(self)

    def call(self, function: Function, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
        """Calls a function on the server.

        Raises:
            pybullet.error: The server does not answer, or the function raised it there.
            TypeError: The arguments are wrong. Other exceptions of `EXCEPTIONS` are raised likewise.
        """
        if not self._connection.is_usable:
            fail(NOT_CONNECTED, "The server has closed the connection, or did not answer in time.")
        positional, named = function.with_client(0, list(arguments), keywords)
        return self._user_data.call(
            function, arguments, keywords, lambda: self._ask(function.name, positional, named)
        )

    def _ask(self, name: str, arguments: list[Any], keywords: dict[str, Any]) -> Any:
        """Calls a function on the server by name; raises the same exceptions as `call`."""
        try:
            kind, *answer = self._connection.call((name, arguments, keywords))
        except ServerGone as problem:
            raise error(f"{NOT_CONNECTED} {problem}") from None
        except Malformed as problem:
            raise error(f"{name} cannot be called in another process: {problem}") from None
        if kind == RESULT:
            return answer[0]
        exception, text = answer
        raise EXCEPTIONS.get(exception, error)(text)

    def set_timeout(self, seconds: float) -> None:
        """Sets how long to wait for answers [s]."""
        self._connection.set_timeout(seconds)

    def is_open(self) -> bool:
        """Whether the server is still connected."""
        return self._connection.is_open()

    def close(self) -> None:
        """Ends the connection; the server and its world continue."""
        self._connection.close()

    def leave_to_the_parent(self) -> None:
        """Drops the connection in a forked process; the parent process keeps it."""
        self._connection.abandon()


def join_server(method: int, address: Address) -> RemoteClient | None:
    """Connects to a server; None if there is none or it does not accept the key, and the reason is logged."""
    from carom.remote.connection import Connection

    problem: object = address.nobody
    for place in address.places:
        try:
            return RemoteClient(method, Connection(place.host, place.port, place.key, address.timeout))
        except NoServer as reason:
            problem = reason
    logger.log(address.importance, "No physics server: %s", problem)
    return None


def _leave_to_the_parent() -> None:
    # Two processes on one connection would read each other's answers.
    for connection in list(at_work):
        connection.leave_to_the_parent()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_leave_to_the_parent)
