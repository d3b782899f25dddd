"""Writing a file atomically: other programs never see an incomplete file."""

from __future__ import annotations

import errno
import os
import secrets
from contextlib import suppress
from pathlib import Path


def write_whole(path: Path, data: bytes) -> None:
    """Write a file under a temporary name in the same folder, then rename it.

    A symbolic link is kept, and its target is written. An existing file keeps its permissions; a new one has
    those of the umask. Devices, such as `/dev/null`, are written to and never replaced.

    Raises:
        OSError: The file cannot be written; an existing file is unchanged.
    """
    target = Path(os.path.realpath(path))
    mode = 0o666
    if target.is_symlink():
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), str(path))
    if target.exists():
        if not target.is_file():
            _write_into(target, data)
            return
        mode = target.stat().st_mode & 0o777
    if not target.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "there is no such folder", str(target.parent))
    draft = target.parent / f".carom-{secrets.token_hex(8)}"
    # Not by `tempfile`: only the owner may read such files.
    descriptor = os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    try:
        with os.fdopen(descriptor, "wb") as stream:
            stream.write(data)
        if target.exists():
            draft.chmod(mode)
        os.replace(draft, target)
    except BaseException:
        with suppress(OSError):
            draft.unlink()
        raise


def _write_into(target: Path, data: bytes) -> None:
    if not target.is_char_device():
        raise OSError(f"{target} is neither a file nor a device to write to")
    with target.open("wb") as stream:
        stream.write(data)
