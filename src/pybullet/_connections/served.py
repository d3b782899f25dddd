"""Worlds of this process that other processes may use."""

from __future__ import annotations

from threading import current_thread, local
from typing import Any
from weakref import WeakMethod

from carom.native.change import Outdated
from carom.native.gates import again
from carom.remote.connection import Connection
from carom.remote.errors import Malformed, NoServer, RemoteError
from carom.remote.frames import OF_RESULTS, Frame, check_size
from carom.remote.listener import Listener
from carom.remote.rendezvous import Note, find
from carom.remote.values import pack, unpack
from pybullet._access.user_data_view import UserDataView
from pybullet._calls.detours import Function, detour_of, functions, remove_detour
from pybullet._calls.errors import NOT_CONNECTED, error, fail, logger
from pybullet._clients.clients import Client, living_client
from pybullet._connections.remote import ERROR, EXCEPTIONS, PROBLEM, RESULT, at_work
from pybullet._connections.server_options import ServerOptions, reachable

# Time limit for an answer when checking whether a server exists [s].
_PATIENCE = 5.0
_CANNOT_START = "Cannot start the physics server:"
# This function locks the client itself, but not while it waits because the simulation is paused.
_STEP = "stepSimulation"


class Served:
    """A server for the world of a client in this process, used by clients in other processes.

    All clients call the same functions, one call at a time. Only user data are copied for each client.

    Raises:
        pybullet.error: A server with the same key or port exists, or it cannot listen at an address.
    """

    def __init__(self, number: int, client: Client, options: ServerOptions) -> None:
        self._number = number
        self._client = client
        ask = WeakMethod(self._ask)
        self._user_data = UserDataView(lambda *arguments: (own := ask()) and own(*arguments))
        self._for_others = local()
        self._notes: list[tuple[str, Note]] = []
        for rendezvous in options.meetings:
            name = rendezvous.name(rendezvous.port)
            if _is_taken(name):
                fail(_CANNOT_START, f"there is one already, named {name}.")
        try:
            places = [(rendezvous.host, rendezvous.port) for rendezvous in options.meetings]
            answer = WeakMethod(self._answer)
            self._listener = Listener(
                places, options.key, lambda frame: own(frame) if (own := answer()) else _closing()
            )
        except OSError as problem:
            fail(_CANNOT_START, f"{problem}.")
        try:
            for rendezvous, (host, port) in zip(options.meetings, self._listener.addresses, strict=True):
                note = Note(reachable(host), port, options.key)
                note.leave(rendezvous.name(port))
                self._notes.append((rendezvous.name(port), note))
        except (OSError, RemoteError) as problem:
            self.close()
            fail(_CANNOT_START, f"{problem}")
        at_work.add(self)

    @property
    def addresses(self) -> list[tuple[str, int]]:
        """The hosts and ports at which it listens."""
        return self._listener.addresses

    @property
    def client_count(self) -> int:
        """The number of connected clients."""
        return self._listener.client_count

    def call(self, function: Function, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
        """Calls a function for this process's script or, if a log forwards the call, for another process."""
        if getattr(self._for_others, "answering", False):
            return self._call(function, arguments, keywords)
        return self._user_data.call(
            function, arguments, keywords, lambda: self._call(function, arguments, keywords)
        )

    def _ask(self, name: str, *arguments: Any) -> Any:
        """Calls a function by name."""
        function = functions()[name]
        positional, keywords = function.with_client(self._number, list(arguments), {})
        return self._call(function, positional, keywords)

    def close(self) -> None:
        """Ends all connections."""
        for name, note in self._notes:
            note.take_away(name)
        self._listener.close()

    def leave_to_the_parent(self) -> None:
        """Drops the server in a forked process; the parent process keeps it."""
        self._notes = []
        self._listener.abandon()
        remove_detour(self._number)
        self._client.server = None

    def _answer(self, frame: Frame) -> tuple[bytes, list[memoryview]]:
        """Calls a function for a script in another process."""
        request = unpack(frame.message, frame.contents, lists=True)
        name, arguments, keywords = _checked(request)
        function = functions().get(name)
        # It is not reset, because this thread only answers clients.
        self._for_others.answering = True
        try:
            if function is None:
                fail(f"A server has no function {name!r}.")
            if living_client(self._number) is not self._client:
                fail(NOT_CONNECTED, "The server is closing.")
            arguments, keywords = function.with_client(self._number, arguments, keywords)
            # A log of commands may record the calls and forward them to this server.
            way = detour_of(self._number) or self
            answer = pack((RESULT, way.call(function, tuple(arguments), keywords)))
            check_size(*answer, OF_RESULTS)
        except error as problem:
            return pack((PROBLEM, ERROR, str(problem)))
        except tuple(EXCEPTIONS.values()) as problem:
            kind = next(name for name, kind in EXCEPTIONS.items() if isinstance(problem, kind))
            return pack((PROBLEM, kind, _text(problem)))
        except Malformed as problem:
            return pack((PROBLEM, ERROR, f"{name}: {problem}"))
        except Exception as problem:
            logger.exception("%s has failed in %s.", name, current_thread().name)
            return pack((PROBLEM, ERROR, f"{name} has failed in the server: {problem!r}"))
        return answer

    def _call(self, function: Function, arguments: Any, keywords: dict[str, Any]) -> Any:
        if function.name == _STEP:
            return function.plain(*arguments, **keywords)
        with self._client.call_lock:
            try:
                return function.plain(*arguments, **keywords)
            except Outdated:
                return again(function.plain, *arguments, **keywords)


def _closing() -> tuple[bytes, list[memoryview]]:
    """The answer when the server is gone."""
    return pack((PROBLEM, ERROR, f"{NOT_CONNECTED} The server is closing."))


def _checked(request: Any) -> tuple[str, list[Any], dict[str, Any]]:
    match request:
        case [str() as name, list() as arguments, dict() as keywords] if all(
            isinstance(key, str) for key in keywords
        ):
            return name, arguments, keywords
    raise Malformed("A message is no call.")


def _text(problem: Exception) -> str:
    # The text of a KeyError differs from its argument.
    return problem.args[0] if len(problem.args) == 1 and isinstance(problem.args[0], str) else str(problem)


def _is_taken(name: str) -> bool:
    """Whether the server with a name answers; a server that was killed leaves its note behind."""
    note = find(name)
    if note is None:
        return False
    try:
        Connection(note.host, note.port, note.key, _PATIENCE).close()
    except NoServer:
        return False
    return True
