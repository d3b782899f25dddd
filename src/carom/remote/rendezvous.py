r"""Where clients on the same machine find a server, and its key, by nothing but a name.

A server leaves a note in a folder that belongs to the user: address and key. Only that user can read it. The
folder is `$XDG_RUNTIME_DIR/carom`, or `carom-<user number>` in the system's folder for temporary files, on
Windows `%LOCALAPPDATA%\carom\servers`.
"""

from __future__ import annotations

import json
import os
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from carom.remote.private_folder import is_private, make_private, private_folder

# Of a note [bytes].
_GREATEST_SIZE = 4096


@dataclass(frozen=True)
class Note:
    """How to reach a server.

    Attributes:
        host: Where it listens.
        port: Its port.
        key: What both sides have to know.
    """

    host: str
    port: int
    key: bytes

    def leave(self, name: str) -> None:
        """Leaves the note under a name, in place of an older one.

        Raises:
            RemoteError: The folder belongs to another user.
            OSError: It cannot be written to.
        """
        folder = private_folder()
        make_private(folder)
        handle, draft = tempfile.mkstemp(dir=folder)
        try:
            with os.fdopen(handle, "w", encoding="ascii") as file:
                json.dump({"host": self.host, "port": self.port, "key": self.key.hex()}, file)
            os.replace(draft, _path(name))
        except OSError:
            Path(draft).unlink(missing_ok=True)
            raise

    def take_away(self, name: str) -> None:
        """Takes the note away, unless another server has put its own there."""
        if find(name) == self:
            with suppress(OSError):
                _path(name).unlink()


def find(name: str) -> Note | None:
    """The note of a name; None when there is none, or none that this user has left."""
    try:
        with _path(name).open("rb") as file:
            if not is_private(os.fstat(file.fileno())):
                return None
            content = json.loads(file.read(_GREATEST_SIZE))
        host, port, key = content["host"], content["port"], bytes.fromhex(content["key"])
    # It does not exist, is not JSON, or was not written by a server.
    except (OSError, ValueError, RecursionError, KeyError, TypeError):
        return None
    return Note(host, port, key) if isinstance(host, str) and isinstance(port, int) else None


def _path(name: str) -> Path:
    return private_folder() / f"{name}.json"
