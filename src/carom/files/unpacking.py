"""Files that appear when they are asked for: members of archives, see `archives.py`."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import Protocol

from carom.errors import DescriptionError


class Unpacking(Protocol):
    """A folder in which files appear."""

    def has(self, path: str) -> bool:
        """Whether a file appears at a path in the folder."""
        ...

    def unpack(self, path: str) -> None:
        """Let a file appear, if there is one; raises `DescriptionError` if it is damaged or too large."""
        ...


in_use: dict[str, Unpacking] = {}
"""These folders, by their path with a separator at its end."""


def unpack(path: str | Path) -> None:
    """Let a file appear, if it is in such a folder; raises `DescriptionError` as `Unpacking.unpack` does."""
    folder = _folder_of(path) if in_use else None
    if folder is not None:
        folder.unpack(os.fspath(path))


def appears(path: str | Path) -> bool:
    """Whether a path is that of a file in such a folder, which is unpacked if nothing is wrong with it.

    What is wrong with it is said when it is read.
    """
    folder = _folder_of(path) if in_use else None
    if folder is None or not folder.has(os.fspath(path)):
        return False
    with suppress(DescriptionError):
        folder.unpack(os.fspath(path))
    return True


def _folder_of(path: str | Path) -> Unpacking | None:
    text = os.fspath(path)
    return next((it for prefix, it in tuple(in_use.items()) if text.startswith(prefix)), None)
