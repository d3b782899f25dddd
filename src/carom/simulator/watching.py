"""Noticing that files have changed: those that were named, and all that were read for them."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from threading import Event, Thread

from carom.files import bounded

_INTERVAL = 0.25
# An editor that writes a file in pieces is done when it has not changed for so many looks.
_QUIET = 1

Mark = tuple[int, int, int] | None


class FileWatch:
    """Looks at files several times a second, from a thread of its own.

    From `listen` to `close` each file that Carom reads is watched: meshes, textures, included files.

    Args:
        changed: Called, from that thread, when files have changed and then stayed as they are for a moment.
        look: Called at each look.
    """

    def __init__(self, changed: Callable[[list[Path]], None], look: Callable[[], None]) -> None:
        self._changed = changed
        self._look = look
        self._marks: dict[Path, Mark] = {}
        self._pending: dict[Path, int] = {}
        self._ended = Event()
        self._thread = Thread(target=self._run, name="carom files", daemon=True)

    def listen(self) -> None:
        """Watches the files that are read from now on."""
        bounded.readers.append(self._note)

    def start(self) -> None:
        """Begins to look."""
        self._thread.start()

    def close(self) -> None:
        """Ends it."""
        self._ended.set()
        if self._note in bounded.readers:
            bounded.readers.remove(self._note)
        if self._thread.is_alive():
            self._thread.join()

    @property
    def paths(self) -> list[Path]:
        """All files that are watched."""
        return [*self._marks]

    def _note(self, file: Path) -> None:
        # What it is like before it is read, from any thread.
        if file not in self._marks:
            self._marks.setdefault(file, _mark(file))

    def _run(self) -> None:
        while not self._ended.wait(_INTERVAL):
            self.look()
            self._look()

    def look(self) -> None:
        """Looks at all files once."""
        for path, known in [*self._marks.items()]:
            mark = _mark(path)
            if mark != known:
                # While an editor puts another file in its place there may be none.
                self._marks[path] = mark
                self._pending[path] = 0 if mark is not None else -_QUIET
            elif path in self._pending:
                self._pending[path] += 1
        if self._pending and min(self._pending.values()) >= _QUIET:
            changed = list(self._pending)
            self._pending.clear()
            self._changed(changed)


def _mark(path: Path) -> Mark:
    """What tells a file from what it was; None if it is not there."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return None
    return (status.st_mtime_ns, status.st_size, status.st_ino)
