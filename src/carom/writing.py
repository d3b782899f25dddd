"""Writing a file atomically: whatever happens meanwhile, it is the old file or the new one, and complete."""

from __future__ import annotations

import errno
import os
import secrets
import stat
from contextlib import suppress
from pathlib import Path

_BINARY = getattr(os, "O_BINARY", 0)
# Where there is nothing to rename: the files there stand for devices and for files that are already open.
_OPEN_FILES = ("/dev/", "/proc/")
_PRIVATE = 0o600
# Errors that mean that a folder, or a file mounted at its place, allows no new file, though perhaps writing.
_NOT_BESIDE = frozenset({errno.EACCES, errno.EPERM, errno.EROFS, errno.EBUSY})


def write_whole(path: str | Path, data: bytes | memoryview, *, private: bool = False) -> None:
    """Write a file under a temporary name in the same folder, then rename it.

    A symbolic link is kept, and its target is written. An existing file keeps its permissions and, if the
    system allows it, its owner; a new one has the permissions of the umask. Devices, such as `/dev/null`, and
    pipes that somebody reads are written to and never replaced. If the folder allows no new files, an
    existing file is written in place, because then there is no other way.

    Args:
        path: The file.
        data: Its content.
        private: Only the user may read the file, also while it is being written.

    Raises:
        OSError: The file cannot be written; an existing file is unchanged.
    """
    given = os.fspath(path)
    try:
        status = os.stat(given)
    except FileNotFoundError:
        status = None
    if status is not None:
        if stat.S_ISDIR(status.st_mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), given)
        if not stat.S_ISREG(status.st_mode) or given.startswith(_OPEN_FILES):
            _write_into(given, data)
            return
        if not os.access(given, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), given)
    target = os.path.realpath(given)
    folder = os.path.dirname(target)
    if not os.path.isdir(folder):
        raise FileNotFoundError(errno.ENOENT, "there is no such folder", folder)
    try:
        _write_beside(target, folder, data, status, private=private)
    except OSError as problem:
        if status is None or problem.errno not in _NOT_BESIDE:
            raise
        _write_into(target, data)


def write_text(path: str | Path, text: str) -> None:
    """Write a text in UTF-8 as `write_whole` does, with line feeds on all systems."""
    write_whole(path, text.encode())


def _write_beside(
    target: str, folder: str, data: bytes | memoryview, status: os.stat_result | None, *, private: bool
) -> None:
    draft = os.path.join(folder, f".carom-{secrets.token_hex(8)}")
    # Not by `tempfile`: its files never have the permissions of the umask.
    mode = 0o666 if status is None and not private else _PRIVATE
    descriptor = os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _BINARY, mode)
    try:
        with os.fdopen(descriptor, "wb") as stream:
            stream.write(data)
        if status is not None and not private:
            _take_over(draft, status)
        os.replace(draft, target)
    except BaseException:
        with suppress(OSError):
            os.unlink(draft)
        raise


def _take_over(draft: str, status: os.stat_result) -> None:
    """Give a file the owner, if possible, and the permissions of another one."""
    own = os.stat(draft)
    if hasattr(os, "chown") and (own.st_uid, own.st_gid) != (status.st_uid, status.st_gid):
        with suppress(OSError):
            os.chown(draft, status.st_uid, status.st_gid)
    os.chmod(draft, status.st_mode & 0o777)


def _write_into(target: str, data: bytes | memoryview) -> None:
    # A pipe that nobody reads is an error instead of a wait.
    descriptor = os.open(target, os.O_WRONLY | os.O_TRUNC | _BINARY | getattr(os, "O_NONBLOCK", 0))
    with os.fdopen(descriptor, "wb") as stream:
        if os.name != "nt":
            os.set_blocking(descriptor, True)
        stream.write(data)
