"""The cache of built files, so that nothing is built twice.

Every start in a clone uses this module to find its library, so modules that only building needs are imported
in functions.
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
    """The folder for libraries, objects and generated code; it may not exist yet.

    The environment variable `CAROM_CACHE_PATH` overrides it.
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
    """Whether a folder can be the cache: it is writable, or already contains libraries."""
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
    return os.access(folder, os.W_OK | os.X_OK) or (folder / _LIBRARIES).is_dir()


@functools.cache
def _temporary_folder() -> Path:
    """The cache without a writable home: shared by all processes, unless other users could write to it."""
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
    """Path of the library that is built from the sources with a digest; it may not exist yet."""
    return cache / _LIBRARIES / digest / name


def is_there(library: Path) -> bool:
    """Whether a library and its manifest exist."""
    return library.exists() and (library.parent / MANIFEST).exists()


def mark_used(entry: Path) -> None:
    """Set the time at which a file or folder directly in one of the cache's folders was last used."""
    # A folder of another user, or one that is not writable, needs no mark.
    with contextlib.suppress(OSError):
        os.utime(entry)


def content_key(*contents: bytes | str) -> str:
    """A name for a file that is built from some contents; another order gives another name."""
    from hashlib import blake2b

    digest = blake2b(digest_size=_KEY_BYTES)
    for content in contents:
        content = content.encode() if isinstance(content, str) else content
        digest.update(f"{len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()


@contextlib.contextmanager
def work_folder(cache: Path) -> Iterator[Path]:
    """A temporary folder in the cache, on its file system."""
    import tempfile

    cache.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=cache, prefix="work-", ignore_cleanup_errors=True) as folder:
        yield Path(folder)


def keep(made: Path, kept: Path) -> None:
    """Move a file or folder to its path in the cache atomically.

    Another process may have put the same file there meanwhile.
    """
    kept.parent.mkdir(parents=True, exist_ok=True)
    try:
        os.replace(made, kept)
    except OSError:
        # Existing folders cannot be replaced; on Windows nor can files that are in use.
        if not kept.exists():
            raise


@contextlib.contextmanager
def alone(cache: Path) -> Iterator[None]:
    """Lock the cache for a build: wait until no other process builds with it, and make others wait.

    The lock is released whenever its process ends.
    """
    cache.mkdir(parents=True, exist_ok=True)
    with open(cache / "lock", "a+b") as lock:
        _lock(lock.fileno())
        yield


def _lock(descriptor: int) -> None:
    """Lock a file, by repeated attempts, so that Ctrl-C works meanwhile."""
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
