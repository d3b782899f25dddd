"""Keeping the cache small: entries that have not been used for long are removed, the oldest first."""

from __future__ import annotations

import contextlib
import shutil
import time
from pathlib import Path

_MAX_SECONDS = 30 * 24 * 3600.0
_MAX_BYTES = 400 << 20
# Folders of killed builds; those of running builds are younger.
_MAX_WORK_SECONDS = 24 * 3600.0
# Files that are compiled again if missing. Zig manages its own cache.
_FOLDERS = ("libraries", "code", "objects")


def prune(cache: Path, most_bytes: int = _MAX_BYTES) -> None:
    """Remove files not used for 30 days, then the oldest ones until the rest has at most so many bytes.

    No other build may use the cache meanwhile.
    """
    now = time.time()
    entries = [
        entry for folder in _FOLDERS if (cache / folder).is_dir() for entry in (cache / folder).iterdir()
    ]
    kept_bytes = 0
    for used, entry in sorted(((entry.stat().st_mtime, entry) for entry in entries), reverse=True):
        kept_bytes += _size(entry)
        if now - used > _MAX_SECONDS or kept_bytes > most_bytes:
            _remove(entry)
    for entry in cache.glob("work-*"):
        if now - entry.stat().st_mtime > _MAX_WORK_SECONDS:
            _remove(entry)


def _size(entry: Path) -> int:
    files = entry.rglob("*") if entry.is_dir() else [entry]
    return sum(file.stat().st_size for file in files)


def _remove(entry: Path) -> None:
    # On Windows a library that a process has loaded cannot be removed; it stays until another build.
    if entry.is_dir():
        shutil.rmtree(entry, ignore_errors=True)
    else:
        with contextlib.suppress(OSError):
            entry.unlink()
