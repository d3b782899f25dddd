"""Calls that take another way: to a server in another process, past a lock, or into a log.

Which way a call takes depends on its `physicsClientId`, and asking that first would cost every call of every
script, most of which know no servers. So functions ask only while there is a connection with a detour: the
code of each Python function behind a builtin is then exchanged for code that asks, and put back with the last
detour. No function has to know. Nor does the native library, which does not try such functions meanwhile.
"""

from __future__ import annotations

import inspect
from threading import Lock
from types import CodeType, FunctionType
from typing import Any, Protocol

from carom.record import record
from pybullet._calls.builtin import UsualForm, exports
from pybullet._calls.quick import pause

# Functions of these modules need no world.
_HELPERS = frozenset({"pybullet._maths.maths", "pybullet._maths.camera_maths", "pybullet._shapes.vhacd"})
# These are about the connection itself, or only call others.
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


@record
class Function:
    """A function of the public interface.

    Attributes:
        name: Its name.
        plain: A copy that never takes a detour.
        usual_form: What gives arguments the form of the signature, if there are other forms.
        client_place: Position of `physicsClientId` among its arguments; None if it has to be named.
        asked: The function behind the builtin.
        usual: Its own code.
        asking: The code it has while there are detours.
    """

    name: str
    plain: FunctionType
    usual_form: UsualForm | None
    client_place: int | None
    asked: FunctionType
    usual: CodeType
    asking: CodeType

    def ask(self) -> None:
        """Lets the function ask which way to take."""
        # `setattr`, because type checkers take a function in an attribute for a method.
        setattr(self.asked, "__code__", self.asking)  # noqa: B010

    def ask_no_more(self) -> None:
        """Gives the function its own code back."""
        setattr(self.asked, "__code__", self.usual)  # noqa: B010

    def with_client(
        self, client: int, arguments: list[Any], keywords: dict[str, Any]
    ) -> tuple[list[Any], dict[str, Any]]:
        """Arguments that name a connection, in place of the one that they name, if any."""
        named = {_CLIENT: client}
        if self.client_place is None or len(arguments) <= self.client_place:
            return arguments, {**keywords, **named}
        place = self.client_place
        keywords = {**keywords, **named} if _CLIENT in keywords else keywords
        return [*arguments[:place], client, *arguments[place + 1 :]], keywords


class Detour(Protocol):
    """Another way for the calls of a connection."""

    def call(self, function: Function, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
        """Calls a function that needs a world."""
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
    """Sends the calls of a connection another way from now on."""
    with _changing:
        if not _detours:
            pause(paused=True)
            for function in functions().values():
                function.ask()
        _detours[client] = detour


def detour_of(client: int) -> Detour | None:
    """The way that the calls of a connection take; None for the usual one."""
    return _detours.get(client)


def remove_detour(client: int) -> None:
    """Lets the calls of a connection take the usual way again, if they take another."""
    with _changing:
        if _detours.pop(client, None) is not None and not _detours:
            for function in functions().values():
                function.ask_no_more()
            pause(paused=False)


def call(name: str, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
    """Calls a function on the way that belongs to its connection."""
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
        # It cannot even be looked up: the function will say so.
        return function.plain(*arguments, **keywords)
    return call_on(client, function, arguments, keywords)


def call_on(client: int, function: Function, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
    """Calls a function, whose arguments name a connection, on the way that belongs to this connection."""
    detour = _detours.get(client)
    if detour is None:
        return function.plain(*arguments, **keywords)
    return detour.call(function, arguments, keywords)


def _worldly() -> dict[str, Function]:
    found = {}
    for name, (function, builtin, usual_form, *_) in exports.items():
        # Functions made by others are those that are not available, wherever they are called.
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
