"""A folder for files that only this user may read."""

from __future__ import annotations

import os
import stat
import tempfile
from pathlib import Path

from carom.remote.errors import RemoteError
from carom.writing import write_whole


def private_folder() -> Path:
    """Path of the folder, whether it exists or not."""
    if os.name == "nt":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local") / "carom" / "servers"
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    if runtime and os.path.isabs(runtime) and os.access(runtime, os.W_OK):
        return Path(runtime) / "carom"
    return Path(tempfile.gettempdir()) / f"carom-{os.getuid()}"


def make_private(folder: Path) -> None:
    """Create the folder if it does not exist; raises `RemoteError` if other users may use it."""
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    status = folder.lstat()
    if not stat.S_ISDIR(status.st_mode) or not is_private(status):
        raise RemoteError(f"{folder} is not a folder that only you can use; remove it.")


def write_private(path: Path, content: bytes) -> None:
    """Write or replace a file in an existing folder so that other users can never read any of it.

    Raises:
        OSError: It cannot be written; the file is then as before.
    """
    write_whole(path, content, private=True)


def is_private(status: os.stat_result) -> bool:
    """Whether a file or folder belongs to this user alone."""
    # On Windows the access control list of the user's own folder makes files in it private.
    if os.name == "nt":
        return True
    return status.st_uid == os.getuid() and not status.st_mode & 0o077
