"""Connecting to worlds, and what can be asked of a connection."""

from __future__ import annotations

import atexit
from typing import overload

from pybullet._arguments import by_name, integer, real, text
from pybullet._builtin import exported, exported_as
from pybullet._clients import MAX_CLIENTS, Client, client_of, clients, free_slot, living_client
from pybullet._constants import (
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
from pybullet._errors import fail, logger
from pybullet._window import NoWindow

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
_WITH_WINDOW = (GUI, GUI_SERVER, GUI_MAIN_THREAD)
_TO_A_SERVER = (SHARED_MEMORY, UDP, TCP)
_AS_A_SERVER = (
    SHARED_MEMORY_SERVER,
    GRAPHICS_CLIENT,
    GRAPHICS_SERVER,
    GRAPHICS_SERVER_TCP,
    GRAPHICS_SERVER_MAIN_THREAD,
)
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
        method: `DIRECT` for a world without a window; any number of them, up to 1024 connections. `GUI`
            for one with a window; `GUI_SERVER` and `GUI_MAIN_THREAD` are the same here. The window is a
            page in the browser: its address is printed, and it opens where there is a display and `CI`
            is not set.
        key: Of shared memory; checked, but there are no servers in this version of Carom.
        options: Of the window, separated by spaces: `--width=1024 --height=768`, the size of its image
            until a page is open; `--mp4=run.mp4 --mp4fps=60` for a video;
            `--background_color_red=0.5`, and `_green` and `_blue`; `--host=127.0.0.1`
            and `--port=8400`, where the page is. Others are ignored.
        hostName: Of a server.
        port: Of a server.

    Returns:
        The id of the connection, from 0; it is the `physicsClientId` of the other functions. -1 when no
        server can be reached by `SHARED_MEMORY`, `UDP` or `TCP`, which is always so in this version.

    Raises:
        pybullet.error: There is a window already, there are 1024 connections, the page cannot be served at
            the address asked for, or the method does not exist or is a kind of server that this version of
            Carom does not have.

    Examples:
        >>> other = p.connect(p.DIRECT)
        >>> p.getNumBodies(physicsClientId=other)
        0
        >>> p.disconnect(other)
    """
    method = integer(method, "method")
    options = _connect_options(arguments, keywords)
    slot = free_slot()
    if slot is None:
        fail("Exceeding maximum number of physics connections.", f"{MAX_CLIENTS} are in use.")
    if method in _TO_A_SERVER:
        logger.info("No physics server can be reached: Carom has none in this version.")
        return _NO_SERVER
    if method in _AS_A_SERVER:
        fail(
            f"The connection method {method} is not available in this version of Carom.", "Use DIRECT or GUI."
        )
    if method in _WITH_WINDOW:
        if any(living_client(slot) and clients[slot].method in _WITH_WINDOW for slot in list(clients)):
            fail(_ONE_WINDOW)
    elif method != DIRECT:
        fail("connectPhysicsServer unexpected argument", f"There is no connection method {method}.")

    # The engine is imported when it is needed, so that importing the module stays quick.
    from carom.world import World
    from pybullet._body_access import BodyTable

    client = Client(method, World(), BodyTable(), NoWindow())
    if method in _WITH_WINDOW:
        from pybullet._page_window import open_window

        client.window = open_window(client, options)
    clients[slot] = client
    return slot


@exported
def disconnect(physicsClientId: int = 0) -> None:
    """Ends a connection; its world is gone.

    Args:
        physicsClientId: The connection.

    Raises:
        pybullet.error: There is no such connection.

    Examples:
        >>> p.disconnect()
        >>> p.isConnected()
        0
    """
    client = client_of(physicsClientId)
    del clients[physicsClientId]
    client.close()


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
    return int(living_client(physicsClientId) is not None)


@exported
def getConnectionInfo(physicsClientId: int = 0) -> dict[str, int]:
    """How a connection was made.

    Args:
        physicsClientId: The connection; any integer.

    Returns:
        `isConnected`: 1 or 0; `connectionMethod`: `DIRECT`, `GUI`, ..., 0 when not connected.

    Examples:
        >>> p.getConnectionInfo()
        {'isConnected': 1, 'connectionMethod': 2}
    """
    client = living_client(physicsClientId)
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
    """How long to wait for a server. Worlds in the same process answer at once, so nothing changes.

    Args:
        timeOutInSeconds: Time [s].
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or the time is not finite.

    Examples:
        >>> p.setTimeOut(5)
    """
    client_of(physicsClientId)
    real(timeOutInSeconds, "timeOutInSeconds")


@exported
def syncBodyInfo(physicsClientId: int = 0) -> None:
    """Reads the list of bodies from the server again. A world in the same process is always up to date.

    Args:
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.syncBodyInfo()
    """
    client_of(physicsClientId)


def _connect_options(arguments: tuple[int | str, ...], keywords: dict[str, int | str]) -> str:
    """Checks what follows the method, in either of the two forms; returns the options."""
    server_named = (bool(arguments) and isinstance(arguments[0], str)) or bool(
        {"hostName", "port"} & set(keywords)
    )
    names = ("hostName", "port", "options") if server_named else ("key", "options")
    given = by_name("connect", names, arguments, keywords)
    for name, value in given.items():
        if name in ("hostName", "options"):
            text(value, name)
        else:
            integer(value, name)
    return str(given.get("options", ""))


@atexit.register
def _disconnect_all() -> None:
    for client in clients.values():
        client.close()
    clients.clear()
