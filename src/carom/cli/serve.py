"""A physics server as a process of its own: `python -m carom serve`."""

from __future__ import annotations

import signal
from dataclasses import dataclass, field
from threading import Event
from types import FrameType
from typing import Any

import pybullet
from carom.cli.warmup import warmup
from carom.errors import CaromError

# Signals that end a process; on Windows processes can send each other only Ctrl-Break.
_REQUESTS = [signal.Signals[name] for name in ("SIGINT", "SIGTERM", "SIGBREAK") if hasattr(signal, name)]
# How often to check whether the window has been closed [s].
_LOOK = 0.25


@dataclass(frozen=True)
class Service:
    """What to serve.

    Attributes:
        key: Of shared memory, by which clients find the server.
        window: Show the world in the browser.
        options: Of `pybullet.connect`: more ports, the key, the window.
    """

    key: int = pybullet.SHARED_MEMORY_KEY
    window: bool = False
    options: list[str] = field(default_factory=list)


def serve(service: Service) -> None:
    """Serves a world until the process is asked to end, or the window is closed.

    Raises:
        CaromError: There is a server with this key already, or it cannot listen at its ports.
    """
    ending = Event()

    def end(_signal: int, _frame: FrameType | None) -> None:
        ending.set()

    # Clients should not have to wait for kernels to be compiled.
    warmup()
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
