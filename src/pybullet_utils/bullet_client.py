"""A physics client as an object: `client.stepSimulation()` needs no `physicsClientId`."""

from __future__ import annotations

import os
import sys
from functools import partial
from inspect import isbuiltin
from types import TracebackType
from typing import Any

import pybullet


class BulletClient:
    """A connection with the functions of the module `pybullet` as its methods.

    The connection is closed when the object is garbage collected, at the end of a `with` block, or by
    `disconnect()`.
    """

    def __init__(
        self, connection_mode: int | None = None, hostName: str | None = None, options: str = ""
    ) -> None:
        """Connects.

        Args:
            connection_mode: `pybullet.DIRECT`, `pybullet.GUI`, ...; None connects to a running server
                (`SHARED_MEMORY`), or with `DIRECT` if there is none.
            hostName: Host name of a server.
            options: Options of the connection, see `pybullet.connect`.

        Raises:
            pybullet.error: The connection cannot be made.
        """
        # A forked process has a copy of the object, but must not close the connection.
        self._process = os.getpid()
        self._client = -1
        if connection_mode is None:
            self._client = pybullet.connect(pybullet.SHARED_MEMORY, options=options)
            connection_mode = pybullet.DIRECT
        if self._client < 0:
            if hostName is None:
                self._client = pybullet.connect(connection_mode, options=options)
            else:
                self._client = pybullet.connect(connection_mode, hostName=hostName, options=options)

    def __enter__(self) -> BulletClient:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._close()

    def __del__(self) -> None:
        # At interpreter shutdown the functions for closing may be gone already; all worlds end anyway.
        if not sys.is_finalizing():
            self._close()

    def __getattr__(self, name: str) -> Any:
        attribute = getattr(pybullet, name)
        if name == "disconnect":
            return self._close
        return partial(attribute, physicsClientId=self._client) if isbuiltin(attribute) else attribute

    def _close(self) -> None:
        client, self._client = self.__dict__.get("_client", -1), -1
        if client >= 0 and self._process == os.getpid() and pybullet.isConnected(client):
            pybullet.disconnect(client)
