"""Reading regular files within the budget, and a cache that detects changed files."""

from __future__ import annotations

import os
import time
from collections import OrderedDict
from collections.abc import Callable, Hashable
from contextlib import suppress
from pathlib import Path
from stat import S_ISREG
from threading import RLock
from typing import BinaryIO, Generic, NamedTuple, TypeVar

from carom.errors import DescriptionError
from carom.files.budget import charge, check_size
from carom.files.unpacking import unpack
from carom.forks import free_in_forks

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")

SETTLED_NS = 2_000_000_000
"""A file changed more recently than this could change again without a new time stamp, which is coarse."""

_MORE = 1 << 20
# Opening a pipe does not wait for whoever writes to it. Windows has neither flag but that for bytes.
_READ_ONLY = (
    os.O_RDONLY
    | getattr(os, "O_NONBLOCK", 0)
    | getattr(os, "O_CLOEXEC", 0)
    | getattr(os, "O_BINARY", 0)
    | getattr(os, "O_NOCTTY", 0)
)

readers: list[Callable[[Path], None]] = []
"""Called, from any thread, with each file that is read, or that a cache knows the content of."""

FRESH_NS = 60_000_000_000
"""A file written more recently than this may be a temporary one that is deleted soon."""


class FileStamp(NamedTuple):
    """File metadata by which changes are detected.

    Attributes:
        modified: Time of the last modification [ns].
        size: [bytes].
        inode: Distinguishes a file moved into place from the one it replaced.
        taken: When the stamp was taken [ns]; not compared.
    """

    modified: int
    size: int
    inode: int
    taken: int

    @classmethod
    def of(cls, file: Path) -> FileStamp:
        """The stamp of a file as it is now."""
        status = os.stat(file)
        return cls(status.st_mtime_ns, status.st_size, status.st_ino, time.time_ns())

    def is_of(self, file: Path) -> bool:
        """Whether a file certainly has the same content as when the stamp was taken."""
        status = os.stat(file)
        return (
            status.st_mtime_ns == self.modified
            and status.st_size == self.size
            and status.st_ino == self.inode
            and min(self.taken, time.time_ns()) - self.modified > SETTLED_NS
        )


def is_fresh(file: Path) -> bool:
    """Whether a file was written very recently, so that it may be a temporary one."""
    try:
        modified = os.stat(file).st_mtime_ns
    except OSError:
        return False
    return time.time_ns() - modified < FRESH_NS


def read_bounded(file: Path, limit: str = "file_bytes") -> tuple[bytes, FileStamp]:
    """Content of a regular file and its stamp.

    Raises:
        DescriptionError: It cannot be read, is a pipe, a device or a folder, or is larger than that limit of
            `carom.files.budget.Budget`.
    """
    unpack(file)
    try:
        stream, status = open_regular(file)
        with stream:
            stamp = FileStamp(status.st_mtime_ns, status.st_size, status.st_ino, time.time_ns())
            check_size(limit, stamp.size, file)
            charge("files", file=file)
            charge("bytes", stamp.size, file=file)
            # One byte more than there should be, to detect files that grow or that report no size.
            data = stream.read(stamp.size + 1)
            if len(data) > stamp.size:
                data = _whole(file, data, stream, limit)
    except OSError as error:
        raise DescriptionError(f"cannot be read: {error.strerror or error}", file=file) from error
    except ValueError as error:
        raise DescriptionError(f"cannot be read: {error}", file=file) from error
    return data, stamp


def _whole(file: Path, start: bytes, stream: BinaryIO, limit: str) -> bytes:
    """The content of a file that is longer than its status said."""
    data = bytearray(start)
    while more := stream.read(_MORE):
        data += more
        check_size(limit, len(data), file)
        charge("bytes", len(more), file=file)
    return bytes(data)


def open_regular(file: str | Path) -> tuple[BinaryIO, os.stat_result]:
    """A regular file, opened to read its bytes, and its status.

    Raises:
        DescriptionError: It is another kind: a pipe would block until it is written to, and a device may
            have no end.
        OSError: It cannot be opened.
        ValueError: No file can have this name.
    """
    for reader in readers:
        reader(Path(file))
    descriptor = os.open(file, _READ_ONLY)
    try:
        status = os.fstat(descriptor)
        if not S_ISREG(status.st_mode):
            raise DescriptionError("it is not a regular file", file=Path(file))
        return open(descriptor, "rb"), status
    except BaseException:
        os.close(descriptor)
        raise


class FileCache(Generic[Key, Value]):
    """Values made from files, kept while the files are unchanged; the least recently used are dropped first.

    With `outlive` it also returns values of deleted files. `most_bytes` bounds the sum of the sizes that
    `put` is told; the value put last is kept, whatever its size.
    """

    def __init__(self, capacity: int, *, outlive: bool = False, most_bytes: int | None = None) -> None:
        self._capacity = capacity
        self._most_bytes = most_bytes
        self._sizes: dict[Key, int] = {}
        self._outlive = outlive
        self._entries: OrderedDict[Key, tuple[FileStamp, Value]] = OrderedDict()
        # The thread that holds it may come again: a signal handler, a finalizer or a tracer can load files.
        self._lock = free_in_forks(RLock())

    def get(self, key: Key, file: Path) -> Value | None:
        """The value of `key`, made from `file`; None if there is none, or the file may have changed."""
        for reader in readers:
            reader(file)
        with self._lock:
            entry = self._entries.get(key)
            if entry is None:
                return None
            stamp, value = entry
            try:
                unchanged = stamp.is_of(file)
            except FileNotFoundError:
                unchanged = self._outlive
            except OSError:
                unchanged = False
            if self._entries.get(key) is not entry:
                # It was replaced or dropped by the same thread meanwhile.
                return value if unchanged else None
            if not unchanged:
                self._entries.pop(key, None)
                self._sizes.pop(key, None)
                return None
            with suppress(KeyError):
                self._entries.move_to_end(key)
            return value

    def put(self, key: Key, stamp: FileStamp, value: Value, size: int = 0) -> None:
        """Keep a value, of this size in bytes, made from a file that had this stamp before it was read."""
        with self._lock:
            self._entries[key] = (stamp, value)
            self._sizes[key] = size
            with suppress(KeyError):
                self._entries.move_to_end(key)
                while len(self._entries) > self._capacity or self._is_too_large():
                    oldest, _ = self._entries.popitem(last=False)
                    self._sizes.pop(oldest, None)

    def _is_too_large(self) -> bool:
        return (
            self._most_bytes is not None
            and len(self._entries) > 1
            and sum(self._sizes.get(key, 0) for key in self._entries) > self._most_bytes
        )
