"""The scene of all pages: the newest message of each key.

Pages do not get a stream of changes, but all messages newer than those they have. So a page that joins late
or lost its connection gets the whole scene, and a slow page gets the newest state without a backlog.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from threading import Lock
from typing import Any
from weakref import WeakKeyDictionary, WeakSet

from carom.native.uninterrupted import uninterrupted
from carom.viewer.messages import encoded


@dataclass(slots=True)
class _Entry:
    revision: int
    message: bytes
    gone: bool = False


class LatestMessages:
    """Newest messages by key, numbered in order of change. Safe to use from all threads.

    The lock is held in sections only: a signal handler or a finalizer that ran in its own thread with the
    lock held, and draws something, would wait for ever.
    """

    def __init__(self) -> None:
        self._lock = Lock()
        # The oldest first: a changed entry goes to the end.
        self._entries: dict[Hashable, _Entry] = {}
        self._removals: set[Hashable] = set()
        self._revision = 0
        self._readers: WeakSet[Reader] = WeakSet()

    @property
    def revision(self) -> int:
        """Number of the newest entry; it increases with every change."""
        return self._revision

    def put(self, key: Hashable, header: Mapping[str, Any], payload: bytes = b"") -> None:
        """Adds a message, replacing one of the same key."""
        self._enter(key, encoded(header, payload), gone=False)

    def amend(self, key: Hashable, header: Mapping[str, Any]) -> None:
        """Changes a message for pages that join later; other pages keep the old one."""
        message = encoded(header)
        with uninterrupted, self._lock:
            entry = self._entries.get(key)
            if entry is not None:
                entry.message = message

    def remove(self, key: Hashable, header: Mapping[str, Any]) -> None:
        """Removes a message. Pages that have it are sent `header`; unknown keys are ignored."""
        entry = self._entries.get(key)
        if entry is not None and not entry.gone:
            self._enter(key, encoded(header), gone=True)

    def holds(self, key: Hashable) -> bool:
        """Whether there is a message of that key."""
        entry = self._entries.get(key)
        return entry is not None and not entry.gone

    def since(self, revision: int) -> tuple[list[bytes], int]:
        """The messages newer than a revision, 0 for all, the oldest first; and the revision to ask next."""
        newest, present = self.changes(revision)
        # A new page has nothing to remove.
        return [message for _, message, gone in newest if revision or not gone], present

    def reader(self) -> Reader:
        """Somebody who is told of all changes from now on, and of what is there."""
        reader = Reader(self)
        with uninterrupted, self._lock:
            self._readers.add(reader)
        return reader

    def changes(self, revision: int) -> tuple[list[tuple[Hashable, bytes, bool]], int]:
        """As `since`, with the key of each message, and whether it tells that another one is gone."""
        with uninterrupted, self._lock:
            if revision == self._revision:
                return [], revision
            newest: list[tuple[Hashable, bytes, bool]] = []
            for key, entry in reversed(self._entries.items()):
                if entry.revision <= revision:
                    break
                newest.append((key, entry.message, entry.gone))
            newest.reverse()
            return newest, self._revision

    def forget_removals(self, revision: int | None) -> None:
        """Drops removals that all readers have, and the pages: they have a revision, None without pages."""
        if not self._removals:
            return
        with uninterrupted, self._lock:
            known = [reader.revision for reader in self._readers]
            if revision is not None:
                known.append(revision)
            revision = min(known, default=self._revision)
            for key in [key for key in self._removals if self._entries[key].revision <= revision]:
                self._removals.remove(key)
                del self._entries[key]

    def _enter(self, key: Hashable, message: bytes, *, gone: bool) -> None:
        with uninterrupted, self._lock:
            self._move(key, message, gone=gone)

    def _move(self, key: Hashable, message: bytes, *, gone: bool) -> None:
        try:
            self._put_last(key, message, gone=gone)
        except BaseException:
            # Ctrl-C may come after the old entry has been taken out.
            self._put_last(key, message, gone=gone)
            raise

    def _put_last(self, key: Hashable, message: bytes, *, gone: bool) -> None:
        """Enter a message; can be repeated."""
        self._revision += 1
        self._entries.pop(key, None)
        self._entries[key] = _Entry(self._revision, message, gone)
        (self._removals.add if gone else self._removals.discard)(key)


class Reader:
    """Takes the changes of the latest messages one after the other.

    Attributes:
        revision: The revision up to which it has them.
    """

    def __init__(self, latest: LatestMessages) -> None:
        self._latest = latest
        self.revision: int = 0

    def changes(self) -> list[tuple[Hashable, bytes | None]]:
        """What has changed since the last call: messages by key, None where one is gone."""
        changes, self.revision = self._latest.changes(self.revision)
        return [(key, None if gone else message) for key, message, gone in changes]

    def messages(self) -> list[bytes]:
        """What pages would be told of what has changed since the last call."""
        messages, self.revision = self._latest.since(self.revision)
        return messages


latest_of: WeakKeyDictionary[Any, LatestMessages] = WeakKeyDictionary()
"""The latest messages of the viewer of each world that has one."""
