"""The cache of built files, so that nothing is built twice.

Every start in a clone comes here to find its library: what only building needs is imported when that begins.
"""

from __future__ import annotations

import contextlib
import functools
import os
import stat
import sys
import time
from collections.abc import Iterator
from pathlib import Path

MANIFEST = "manifest.json"
_LIBRARIES = "libraries"
_KEY_BYTES = 16
_LOCK_SECONDS = 0.1


def cache_folder() -> Path:
    """The folder for libraries, objects and generated code; it need not be there yet.

    `CAROM_CACHE_PATH` names another one.
    """
    named = os.environ.get("CAROM_CACHE_PATH")
    if named:
        return Path(named)
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local"
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    usual = Path(base) / "carom" / "native"
    return usual if _is_of_use(usual) else _temporary_folder()


def _is_of_use(folder: Path) -> bool:
    """Whether there can be a cache: in a folder that can be written, or has libraries already."""
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
    return os.access(folder, os.W_OK | os.X_OK) or (folder / _LIBRARIES).is_dir()


@functools.cache
def _temporary_folder() -> Path:
    """The cache of who has no home to write to: one for all processes, unless others could write to it."""
    import tempfile

    if os.name != "nt":
        folder = Path(tempfile.gettempdir()) / f"carom-native-{os.getuid()}"
        with contextlib.suppress(OSError):
            folder.mkdir(mode=0o700, exist_ok=True)
            status = folder.lstat()
            if stat.S_ISDIR(status.st_mode) and status.st_uid == os.getuid() and not status.st_mode & 0o022:
                return folder
    return Path(tempfile.mkdtemp(prefix="carom-native-"))


def library_place(cache: Path, digest: str, name: str) -> Path:
    """Where a library is kept that was made from the sources of a digest; it need not be there yet."""
    return cache / _LIBRARIES / digest / name


def is_there(library: Path) -> bool:
    """Whether a library and its manifest are there."""
    return library.exists() and (library.parent / MANIFEST).exists()


def mark_used(entry: Path) -> None:
    """Note that something in the cache is of use now.

    Args:
        entry: A file or folder directly in one of the cache's folders.
    """
    # A folder of another user, or one that is not writable, needs no mark.
    with contextlib.suppress(OSError):
        os.utime(entry)


def content_key(*contents: bytes | str) -> str:
    """A name for what is made from contents.

    Args:
        *contents: The contents, in an order that matters.
    """
    from hashlib import blake2b

    digest = blake2b(digest_size=_KEY_BYTES)
    for content in contents:
        content = content.encode() if isinstance(content, str) else content
        digest.update(f"{len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()


@contextlib.contextmanager
def work_folder(cache: Path) -> Iterator[Path]:
    """A temporary folder in the cache, on its file system.

    Args:
        cache: The cache folder.
    """
    import tempfile

    cache.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=cache, prefix="work-", ignore_cleanup_errors=True) as folder:
        yield Path(folder)


def keep(made: Path, kept: Path) -> None:
    """Move a file or folder into the cache atomically.

    Another process may have put the same there meanwhile.

    Args:
        made: The file or folder.
        kept: Its place.
    """
    kept.parent.mkdir(parents=True, exist_ok=True)
    try:
        os.replace(made, kept)
    except OSError:
        # Folders are not replaced; nor are, on Windows, files that are in use.
        if not kept.exists():
            raise


@contextlib.contextmanager
def alone(cache: Path) -> Iterator[None]:
    """Wait until no other process builds with this cache, and keep others waiting meanwhile.

    The lock is released when its process ends, in any way.

    Args:
        cache: The cache folder.
    """
    cache.mkdir(parents=True, exist_ok=True)
    with open(cache / "lock", "a+b") as lock:
        _lock(lock.fileno())
        yield


def _lock(descriptor: int) -> None:
    """Lock a file, trying again and again so that an interrupt is obeyed."""
    while True:
        try:
            if sys.platform == "win32":
                import msvcrt

                os.lseek(descriptor, 0, os.SEEK_SET)
                msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
            else:
                import fcntl

                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            time.sleep(_LOCK_SECONDS)
        else:
            return
