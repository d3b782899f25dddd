r"""How clients on the same machine find the address and key of a server, given its name only.

A server writes its address and key to a file, called a note, that only the same user can read. The folder of
notes is `$XDG_RUNTIME_DIR/carom`, or `carom-<user number>` in the system's folder for temporary files, on
Windows `%LOCALAPPDATA%\carom\servers`.
"""

from __future__ import annotations

import json
import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from carom.remote.private_folder import is_private, make_private, private_folder, write_private

# Largest size of a note [bytes].
_MAX_SIZE = 4096


@dataclass(frozen=True)
class Note:
    """How to reach a server: its host and port, and the key that clients need."""

    host: str
    port: int
    key: bytes

    def leave(self, name: str) -> None:
        """Write the note under a name; an older note with this name is replaced.

        Raises:
            RemoteError: The folder belongs to another user, or other users may use it.
            OSError: The note cannot be written.
        """
        make_private(private_folder())
        note = {"host": self.host, "port": self.port, "key": self.key.hex()}
        write_private(_path(name), json.dumps(note).encode())

    def take_away(self, name: str) -> None:
        """Remove the note, unless another server has replaced it by its own."""
        if find(name) == self:
            with suppress(OSError):
                _path(name).unlink()


def find(name: str) -> Note | None:
    """The note with a name; None if there is none, or if this user has not written it."""
    try:
        with _path(name).open("rb") as file:
            if not is_private(os.fstat(file.fileno())):
                return None
            content = json.loads(file.read(_MAX_SIZE))
        host, port, key = content["host"], content["port"], bytes.fromhex(content["key"])
    # The note does not exist, is not JSON, or was not written by a server.
    except (OSError, ValueError, RecursionError, KeyError, TypeError):
        return None
    return Note(host, port, key) if isinstance(host, str) and isinstance(port, int) else None


def _path(name: str) -> Path:
    return private_folder() / f"{name}.json"
