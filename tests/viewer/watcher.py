"""A page without a browser: it keeps what it is sent, as the real one does."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from contextlib import ExitStack
from typing import Any

import numpy as np
from tests.patience import PATIENCE
from websockets.sync.client import connect

from carom.viewer.messages import decoded
from carom.viewer.protocol import to_page
from carom.viewer.readings import COLUMNS


def socket_address(address: str) -> str:
    """Where the socket of a page is, by the address of the page."""
    return address.replace("http", "ws", 1).replace("/?", "/socket?", 1)


def origin_of(address: str) -> str:
    """What a browser says of the page at an address."""
    return address.partition("/?")[0]


class Watcher:
    """Connected to the socket of a viewer.

    Attributes:
        shown: Newest header of each kind of thing and number, such as ("body", 0) or ("camera", None).
        payloads: The numbers that came with them.
        frame: Header of the newest frame.
        poses: (links, 7) poses of the newest frame.
        blocks: What else it tells, by name; see `carom.viewer.readings`.
    """

    def __init__(self, address: str, **options: Any) -> None:
        self._closing = ExitStack()
        self._socket = self._closing.enter_context(connect(socket_address(address), **options))
        self.shown: dict[tuple[str, Any], dict[str, Any]] = {}
        self.payloads: dict[tuple[str, Any], bytes] = {}
        self.frame: dict[str, Any] = {}
        self.poses = np.zeros((0, 7))
        self.blocks: dict[str, np.ndarray] = {}

    def __enter__(self) -> Watcher:
        return self

    def __exit__(self, *_: object) -> None:
        self._closing.close()

    def tell(self, kind: str, **facts: Any) -> None:
        self._socket.send(json.dumps({"type": kind, **facts}))

    def send_raw(self, text: str | bytes) -> None:
        self._socket.send(text)

    def wait_for(self, condition: Callable[[], Any]) -> Any:
        """Takes messages until something holds."""
        give_up = time.monotonic() + PATIENCE
        while not (result := condition()):
            message = self._socket.recv(timeout=give_up - time.monotonic())
            self._take(message)
        return result

    def take_what_came(self) -> None:
        """Takes the messages that are there; the server stops sending to a page that takes none."""
        while True:
            try:
                message = self._socket.recv(timeout=0)
            except TimeoutError:
                return
            self._take(message)

    def _take(self, message: str | bytes) -> None:
        assert isinstance(message, bytes)
        header, payload = decoded(message)
        to_page.checked(header)
        kind = header["type"]
        if kind == "frame":
            self.frame = header
            numbers = np.frombuffer(payload, dtype="<f4")
            at = 7 * header["poses"]
            self.poses = numbers[:at].reshape(-1, 7)
            self.blocks = {}
            for name, count in header.get("blocks", []):
                end = at + count * COLUMNS[name]
                self.blocks[name] = numbers[at:end].reshape(count, -1)
                at = end
        elif kind.startswith("no "):
            del self.shown[kind[3:], header[kind[3:]]]
        else:
            number = next(
                (header[name] for name in _NUMBERS if name in header and _NUMBERS[name](kind)), None
            )
            name = "item" if kind in ("line", "text", "points") else kind
            self.shown[name, number] = header
            self.payloads[name, number] = payload


_NUMBERS: dict[str, Callable[[str], bool]] = {
    "item": lambda kind: kind in ("line", "text", "points"),
    "slider": lambda kind: kind == "slider",
    "field": lambda kind: kind == "field",
    "image": lambda kind: kind == "image",
    "panel": lambda kind: kind == "panel",
    "mesh": lambda kind: kind == "mesh",
    "texture": lambda kind: kind == "texture",
    "body": lambda kind: kind == "body",
    "dynamics": lambda kind: kind == "dynamics",
    "mark": lambda kind: kind == "mark",
}
