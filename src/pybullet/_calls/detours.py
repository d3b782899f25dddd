"""Detours: calls that are redirected to a server in another process, through a lock, or through a log.

Whether a call is redirected depends on its `physicsClientId`. Checking that in every call would slow down all
scripts, most of which use no servers. So calls are checked only while a connection has a detour: the code of
each Python function behind a builtin is then replaced by code that checks, and restored when the last detour
is removed. The functions need no code for this. While there are detours, quick calls leave these functions to
Python.
"""

from __future__ import annotations

import inspect
from threading import Lock
from types import CodeType, FunctionType
from typing import Any, NamedTuple, Protocol

from pybullet._calls.builtin import UsualForm, exports
from pybullet._calls.quick import pause

# Functions of these modules need no world.
_HELPERS = frozenset({"pybullet._maths.maths", "pybullet._maths.camera_maths", "pybullet._shapes.vhacd"})
# These functions handle the connection itself, or only call other functions.
_ABOUT_CONNECTIONS = frozenset(
    {"connect", "disconnect", "isConnected", "getConnectionInfo", "getAPIVersion", "isNumpyEnabled"}
    | {"setTimeOut", "renderImage"}
)
_CLIENT = "physicsClientId"
_ASKING = (
    "def {name}(*arguments, **keywords):\n"
    "    from pybullet._calls.detours import call\n"
    "    return call({name!r}, arguments, keywords)\n"
)


class Function(NamedTuple):
    """A function of the public interface.

    Attributes:
        name: Its name.
        plain: A copy of the function that is never redirected.
        usual_form: Converts other forms of the arguments to that of the signature; None if there are none.
        client_place: Position of `physicsClientId` among its arguments; None if it is keyword-only.
        asked: The function behind the builtin.
        usual: Its own code.
        asking: Its code while there are detours, which checks for them.
    """

    name: str
    plain: FunctionType
    usual_form: UsualForm | None
    client_place: int | None
    asked: FunctionType
    usual: CodeType
    asking: CodeType

    def ask(self) -> None:
        """Makes every call of the function check for detours."""
        # `setattr`, because type checkers regard a function in an attribute as a method.
        setattr(self.asked, "__code__", self.asking)  # noqa: B010

    def ask_no_more(self) -> None:
        """Restores the function's own code."""
        setattr(self.asked, "__code__", self.usual)  # noqa: B010

    def with_client(
        self, client: int, arguments: list[Any], keywords: dict[str, Any]
    ) -> tuple[list[Any], dict[str, Any]]:
        """The arguments of a call with `physicsClientId` set to `client`."""
        named = {_CLIENT: client}
        if self.client_place is None or len(arguments) <= self.client_place:
            return arguments, {**keywords, **named}
        place = self.client_place
        keywords = {**keywords, **named} if _CLIENT in keywords else keywords
        return [*arguments[:place], client, *arguments[place + 1 :]], keywords


class Detour(Protocol):
    """Receives the calls of a connection."""

    def call(self, function: Function, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
        """Performs the call of a function that needs a world."""
        ...


_detours: dict[int, Detour] = {}
_functions: dict[str, Function] = {}
_changing = Lock()


def functions() -> dict[str, Function]:
    """All functions that need a world, by name."""
    if not _functions:
        _functions.update(_worldly())
    return _functions


def add_detour(client: int, detour: Detour) -> None:
    """Redirects the calls of a connection to a detour from now on."""
    with _changing:
        if not _detours:
            pause(paused=True)
            for function in functions().values():
                function.ask()
        _detours[client] = detour


def detour_of(client: int) -> Detour | None:
    """The detour of a connection; None if its calls are not redirected."""
    return _detours.get(client)


def remove_detour(client: int) -> None:
    """Ends the redirection of a connection's calls, if there is one."""
    with _changing:
        if _detours.pop(client, None) is not None and not _detours:
            for function in functions().values():
                function.ask_no_more()
            pause(paused=False)


def call(name: str, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
    """Calls a function, through the detour of its connection if there is one."""
    function = _functions[name]
    if function.usual_form is not None:
        arguments, keywords = function.usual_form(arguments, keywords)
    client = keywords.get(_CLIENT, 0)
    place = function.client_place
    if place is not None and len(arguments) > place:
        client = arguments[place]
    try:
        hash(client)
    except TypeError:
        # Such an id cannot be looked up, and the function raises an error for it.
        return function.plain(*arguments, **keywords)
    return call_on(client, function, arguments, keywords)


def call_on(client: int, function: Function, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
    """Calls a function, through the detour of connection `client` if there is one."""
    detour = _detours.get(client)
    if detour is None:
        return function.plain(*arguments, **keywords)
    return detour.call(function, arguments, keywords)


def _worldly() -> dict[str, Function]:
    found = {}
    for name, (function, builtin, usual_form, *_) in exports.items():
        # The code of a function with a closure cannot be replaced.
        if name in _ABOUT_CONNECTIONS or function.__closure__:
            continue
        if function.__globals__["__name__"] in _HELPERS:
            continue
        plain = FunctionType(function.__code__, function.__globals__, name, function.__defaults__)
        plain.__kwdefaults__ = function.__kwdefaults__
        found[name] = Function(
            name, plain, usual_form, _client_place(builtin), function, function.__code__, _asking_code(name)
        )
    return found


def _client_place(builtin: Any) -> int | None:
    parameters = inspect.signature(builtin).parameters.values()
    positional = [p.name for p in parameters if p.kind is p.POSITIONAL_OR_KEYWORD]
    return positional.index(_CLIENT) if _CLIENT in positional else None


def _asking_code(name: str) -> CodeType:
    namespace: dict[str, Any] = {}
    exec(compile(_ASKING.format(name=name), "<pybullet detour>", "exec"), namespace)
    return namespace[name].__code__
