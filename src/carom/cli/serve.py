"""A physics server as a process of its own: `python -m carom serve`."""

from __future__ import annotations

import signal
from dataclasses import dataclass, field
from threading import Event
from types import FrameType
from typing import Any

import pybullet
from carom.errors import CaromError
from carom.native.library import library

# Signals that end the server. On Windows a process can send only Ctrl-Break to another one.
_REQUESTS = [signal.Signals[name] for name in ("SIGINT", "SIGTERM", "SIGBREAK") if hasattr(signal, name)]
# How often to check whether the window has been closed [s].
_LOOK = 0.25


@dataclass(frozen=True)
class Service:
    """The settings of a physics server.

    Attributes:
        key: Shared-memory key, by which clients find the server.
        window: Whether to show the world in the browser.
        options: Options of `pybullet.connect`: ports for TCP and UDP, key file, port of the page.
    """

    key: int = pybullet.SHARED_MEMORY_KEY
    window: bool = False
    options: list[str] = field(default_factory=list)


def serve(service: Service) -> None:
    """Serve a world until the process gets a signal to end, or the window is closed.

    Raises:
        CaromError: There is a server with this key already, or the ports cannot be used.
    """
    ending = Event()

    def end(_signal: int, _frame: FrameType | None) -> None:
        ending.set()

    # Before clients can connect, because kernels may have to be compiled.
    library()
    method = pybullet.GUI_SERVER if service.window else pybullet.SHARED_MEMORY_SERVER
    try:
        client = pybullet.connect(method, key=service.key, options=" ".join(service.options))
    except pybullet.error as problem:
        raise CaromError(str(problem)) from problem
    before: dict[int, Any] = {number: signal.signal(number, end) for number in _REQUESTS}
    try:
        print(f"The physics server has the key {service.key}; Ctrl-C ends it.", flush=True)
        while pybullet.isConnected(client) and not ending.wait(_LOOK):
            pass
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if pybullet.isConnected(client):
            pybullet.disconnect(client)
    print("The physics server has ended.", flush=True)
