"""How much memory the process has used."""

from __future__ import annotations

import sys
from pathlib import Path

MAX_BYTES = 1 << 30


def check_memory() -> None:
    """See that the process has never used more than a gigabyte, where the system tells."""
    if sys.platform == "win32":
        return
    used = _peak_on_linux() if sys.platform == "linux" else _peak()
    assert used < MAX_BYTES, f"{used >> 20} MB of memory were used"


def _peak_on_linux() -> int:
    """Peak of this program [bytes]; that of `getrusage` includes what the process was forked from."""
    lines = Path("/proc/self/status").read_text(encoding="utf-8").splitlines()
    [peak] = [line.split()[1] for line in lines if line.startswith("VmHWM:")]
    return int(peak) << 10


def _peak() -> int:
    import resource

    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
