"""Connections to worlds, and queries about them."""

from __future__ import annotations

import atexit
import sys
from operator import index
from typing import TYPE_CHECKING, Any, overload

from carom.native.change import Change
from carom.native.gates import call_lock
from pybullet._calls.arguments import by_name, integer, real, text
from pybullet._calls.builtin import exported, exported_as
from pybullet._calls.constants import (
    DIRECT,
    GRAPHICS_CLIENT,
    GRAPHICS_SERVER,
    GRAPHICS_SERVER_MAIN_THREAD,
    GRAPHICS_SERVER_TCP,
    GUI,
    GUI_MAIN_THREAD,
    GUI_SERVER,
    SHARED_MEMORY,
    SHARED_MEMORY_KEY,
    SHARED_MEMORY_SERVER,
    TCP,
    UDP,
)
from pybullet._calls.detours import add_detour
from pybullet._calls.errors import NOT_CONNECTED, fail
from pybullet._calls.options import Target
from pybullet._clients.clients import (
    MAX_CLIENTS,
    Client,
    client_of,
    clients,
    closed_by_users,
    connection_of,
    forget,
    free_slot,
    is_being_connected,
    living_client,
    remote_clients,
    why_not_connected,
)
from pybullet._clients.locks import lock_of
from pybullet._connections.finalizers import is_of_another_connection, note_maker
from pybullet._window.window import Window

if TYPE_CHECKING:
    from carom.world.world import World
    from pybullet._access.body_access import BodyTable

__all__ = [
    "connect",
    "disconnect",
    "getAPIVersion",
    "getConnectionInfo",
    "isConnected",
    "isNumpyEnabled",
    "setTimeOut",
    "syncBodyInfo",
]

_API_VERSION = 202010061
_WITH_WINDOW = (GUI, GUI_SERVER, GUI_MAIN_THREAD, GRAPHICS_SERVER, GRAPHICS_SERVER_MAIN_THREAD)
_SERVERS = (SHARED_MEMORY_SERVER, GUI_SERVER, GRAPHICS_SERVER, GRAPHICS_SERVER_MAIN_THREAD)
_TO_A_SERVER = (SHARED_MEMORY, UDP, TCP)
# Without a server these methods make a world without a window.
_TO_GRAPHICS = (GRAPHICS_CLIENT, GRAPHICS_SERVER_TCP)
_METHODS = {DIRECT, *_WITH_WINDOW, *_SERVERS, *_TO_A_SERVER, *_TO_GRAPHICS}
_NO_SERVER = -1
_ONE_WINDOW = (
    "Only one local in-process GUI/GUI_SERVER connection allowed. Use DIRECT connection mode or start a "
    "separate GUI physics server (ExampleBrowser, App_SharedMemoryPhysics_GUI, App_SharedMemoryPhysics_VR) "
    "and connect over SHARED_MEMORY, UDP or TCP instead."
)


@overload
def connect(method: int, key: int = SHARED_MEMORY_KEY, options: str = "") -> int: ...
@overload
def connect(method: int, hostName: str, port: int = -1, options: str = "") -> int: ...
@exported_as("(method, key=12347, options='', *, hostName='localhost', port=-1)")
def connect(method: int, *arguments: int | str, **keywords: int | str) -> int:
    """Makes a world and connects to it.

    Also called as `connect(method, hostName, port, options)`.

    Args:
        *arguments: `key` and `options`, or `hostName`, `port` and `options`.
        **keywords: The same by name.
        method: `DIRECT` for a world without a window, up to 1024 connections. `GUI` for one with a window;
            `GUI_MAIN_THREAD` is the same here. The window is a page in the browser:
            its address is printed, and it opens where there is a display and `CI` is not set.

            `SHARED_MEMORY_SERVER` for a world that other processes can join, `GUI_SERVER` for one with a
            window. `SHARED_MEMORY` joins such a world, or that of `python -m carom serve`, on the same
            machine; `TCP` and `UDP` join one on any machine.

            `GRAPHICS_SERVER` (and `..._MAIN_THREAD`) opens a window for the world of another process,
            which connects by `GRAPHICS_CLIENT` (also called `SHARED_MEMORY_GUI`) or, over TCP, by
            `GRAPHICS_SERVER_TCP`; without such a server these two have a world without a window.
        key: Key of shared memory: servers and clients with the same key connect.
        options: Options separated by spaces; unknown ones are ignored. For a window: `--width=1024
            --height=768`, the size of its image until a page is open; `--mp4=run.mp4 --mp4fps=60` for a
            video; `--background_color_red=0.5`, and `_green` and `_blue`; `--host=127.0.0.1` and
            `--port=8400`, the address of the page; `--history=128`, the memory in MB for the past that pages
            can go back to, 0 for none. For servers: `--tcp=6667` and `--udp=1234`, additional
            ports to listen at; `--bind=127.0.0.1`, the address of these ports. For servers and for `TCP` and
            `UDP`: `--key-file=FILE`, a file with the secret key that both sides need; without it the key is
            the environment variable `CAROM_SERVER_KEY`. Processes of one user on one machine need no key.
        hostName: Host of the server.
        port: Port of the server; 6667 for TCP and 1234 for UDP if it is negative.

    Returns:
        The id of the connection, from 0; it is the `physicsClientId` of the other functions. -1 when no
        server can be reached by `SHARED_MEMORY`, `UDP` or `TCP`, or it does not accept the key.

    Raises:
        pybullet.error: There is a window already, there are 1024 connections, the page cannot be served at
            the address asked for, there is a server with this key already or it cannot listen at its
            ports, a key cannot be read, or the method does not exist.

    Examples:
        >>> other = p.connect(p.DIRECT)
        >>> p.getNumBodies(physicsClientId=other)
        0
        >>> p.disconnect(other)
    """
    method = integer(method, "method")
    target = _target(arguments, keywords)
    with free_slot() as slot:
        if slot is None:
            fail("Exceeding maximum number of physics connections.", f"{MAX_CLIENTS} are in use.")
        number = _connected(slot, method, target)
        if number == slot:
            note_maker(sys._getframe(1), clients.get(slot) or remote_clients[slot])
        return number


def _connected(slot: int, method: int, target: Target) -> int:
    """Connects under an id that is free; returns it, or -1."""
    closed_by_users.discard(slot)
    if method not in _METHODS:
        fail("connectPhysicsServer unexpected argument", f"There is no connection method {method}.")
    if method in _TO_A_SERVER or method in _TO_GRAPHICS:
        if _join(slot, method, target):
            return slot
        if method in _TO_A_SERVER:
            return _NO_SERVER
    if method in _WITH_WINDOW and any(
        living_client(slot) and clients[slot].method in _WITH_WINDOW for slot in list(clients)
    ):
        fail(_ONE_WINDOW)
    client = clients[slot] = _new_client(slot, method, target)
    if method == DIRECT or (method in _WITH_WINDOW and method not in _SERVERS):
        _let_quick_calls_in(slot, client)
    if method in _SERVERS:
        try:
            _serve(slot, target)
        except BaseException:
            forget(slot)
            raise
    return slot


def _join(slot: int, method: int, target: Target) -> bool:
    """Connects to a server in another process; returns whether there is one."""
    from pybullet._connections.remote import join_server
    from pybullet._connections.server_options import address_of

    client = join_server(method, address_of(method, target))
    if client is None:
        return False
    remote_clients[slot] = client
    add_detour(slot, client)
    return True


def _new_client(slot: int, method: int, target: Target) -> Client:
    """A client with a new world in this process."""
    lock = lock_of(slot)
    world, bodies = _new_world()
    world.lock, world.call_lock = lock, call_lock(lock)
    client = Client(method, world, bodies, Window())
    if method in _WITH_WINDOW:
        from pybullet._window.page_window import open_window

        client.window = open_window(client, target.options)
    return client


def _new_world() -> tuple[World, BodyTable]:
    """An empty world, and the table of its bodies."""
    # The engine is imported when it is needed, so that importing the module stays quick.
    from carom.engine.parameters import BULLET
    from carom.world.world import World
    from pybullet._access.body_access import BodyTable

    world = World(contact=BULLET)
    # PyBullet has no start to go back to.
    world._keeps_start = False
    return world, BodyTable()


def _let_quick_calls_in(slot: int, client: Client) -> None:
    """Lets the native library access the bodies of a client that has no server."""
    from pybullet._calls.quick import install

    calls = install()
    if calls is not None:
        client.bodies.quick.open(calls, slot)


def _serve(slot: int, target: Target) -> None:
    """Lets other processes use the world of a client."""
    from pybullet._connections.served import Served
    from pybullet._connections.server_options import server_options

    client = clients[slot]
    client.server = server = Served(slot, client, server_options(client.method, target))
    add_detour(slot, server)


@exported
def disconnect(physicsClientId: int = 0) -> None:
    """Ends a connection and removes its world.

    If the user has ended it by closing the window, the first call afterwards is no error. The finalizer of an
    object whose connection has ended does not end a later one that has got its id.

    Args:
        physicsClientId: The connection.

    Raises:
        pybullet.error: There is no such connection.

    Examples:
        >>> p.disconnect()
        >>> p.isConnected()
        0
    """
    client = connection_of(physicsClientId)
    if client is not None and is_of_another_connection(sys._getframe(1), client):
        return
    if client is None or is_being_connected(index(physicsClientId)):
        number = index(physicsClientId)
        if number not in closed_by_users:
            fail(NOT_CONNECTED, why_not_connected(physicsClientId))
        closed_by_users.remove(number)
        return
    forget(index(physicsClientId))


@exported
def isConnected(physicsClientId: int = 0) -> int:
    """Whether a connection exists, and its window, if it has one, is open.

    Args:
        physicsClientId: The connection; any integer.

    Returns:
        1 or 0.

    Examples:
        >>> p.isConnected(), p.isConnected(99)
        (1, 0)
    """
    return int(connection_of(physicsClientId) is not None)


@exported
def getConnectionInfo(physicsClientId: int = 0) -> dict[str, int]:
    """The method of a connection.

    Args:
        physicsClientId: The connection; any integer.

    Returns:
        `isConnected`: 1 or 0; `connectionMethod`: `DIRECT`, `GUI`, ..., 0 when not connected.

    Examples:
        >>> p.getConnectionInfo()
        {'isConnected': 1, 'connectionMethod': 2}
    """
    client = connection_of(physicsClientId)
    if client is None:
        return {"isConnected": 0, "connectionMethod": 0}
    return {"isConnected": 1, "connectionMethod": client.method}


@exported
def getAPIVersion(physicsClientId: int = 0) -> int:
    """The version of PyBullet's interface that the module offers: that of PyBullet 3.2.7.

    Args:
        physicsClientId: Not used; needs no connection.

    Returns:
        A date and a counter as one integer.

    Examples:
        >>> p.getAPIVersion()
        202010061
    """
    return _API_VERSION


@exported
def isNumpyEnabled(physicsClientId: int = 0) -> int:
    """Whether images come as NumPy arrays: they always do.

    Args:
        physicsClientId: Not used; needs no connection.

    Returns:
        1.

    Examples:
        >>> p.isNumpyEnabled()
        1
    """
    return 1


@exported
def setTimeOut(timeOutInSeconds: float, physicsClientId: int = 0) -> None:
    """Sets how long to wait for a server's answers: by default 60 s with `TCP` and `UDP`, otherwise for ever.

    A call that is not answered in time raises `pybullet.error`, and the connection is closed. Worlds in the
    same process answer at once.

    Args:
        timeOutInSeconds: Time [s].
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or the time is not finite.

    Examples:
        >>> p.setTimeOut(5)
    """
    client = connection_of(physicsClientId)
    if client is None:
        fail(NOT_CONNECTED, why_not_connected(physicsClientId))
    client.set_timeout(real(timeOutInSeconds, "timeOutInSeconds"))


@exported
def syncBodyInfo(physicsClientId: int = 0) -> None:
    """Updates the list of bodies from the server: `getBodyUniqueId` lists them by their ids then.

    Here every client always sees all bodies.

    Args:
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.syncBodyInfo()
    """
    client = client_of(physicsClientId)
    with client.call_lock:
        world = client.world
        change = Change()
        change.refill(world.listing, dict(sorted(world.bodies.items())))
        change.commit()


def _target(arguments: tuple[int | str, ...], keywords: dict[str, int | str]) -> Target:
    """Checks the arguments after the method, in either form."""
    server_named = (bool(arguments) and isinstance(arguments[0], str)) or bool(
        {"hostName", "port"} & set(keywords)
    )
    names = ("hostName", "port", "options") if server_named else ("key", "options")
    given = by_name("connect", names, arguments, keywords)
    checked: dict[str, Any] = {}
    for name, value in given.items():
        checked[name] = text(value, name) if name in ("hostName", "options") else integer(value, name)
    if "hostName" in checked:
        checked["host"] = checked.pop("hostName")
    return Target(**checked)


@atexit.register
def _disconnect_all() -> None:
    for number in (*clients, *remote_clients):
        forget(number)
