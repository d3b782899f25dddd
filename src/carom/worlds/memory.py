"""Checks that there is enough memory for the worlds, before they are made."""

from __future__ import annotations

import os
from pathlib import Path

_MEMINFO = Path("/proc/meminfo")
_GIGABYTE = 1e9


def free_memory() -> int | None:
    """Bytes available without swapping; None if the system does not say."""
    try:
        for line in _MEMINFO.read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, AttributeError):
        return None


def check_memory(count: int, bytes_per_world: int) -> None:
    """Raise `MemoryError` unless there is enough memory for the worlds."""
    needed, free = count * bytes_per_world, free_memory()
    if free is not None and needed > free:
        raise MemoryError(
            f"{count} worlds of {bytes_per_world / 1000:.1f} kB need {needed / _GIGABYTE:.1f} GB, and "
            f"{free / _GIGABYTE:.1f} GB are free: ask for {free // bytes_per_world} worlds at most"
        )
