"""How much memory the process has used."""

from __future__ import annotations

import sys

MOST_BYTES = 1 << 30


def check_memory() -> None:
    """See that the process has never used more than a gigabyte, where the system tells."""
    if sys.platform == "win32":
        return
    import resource

    unit = 1 if sys.platform == "darwin" else 1024
    used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
    assert used < MOST_BYTES, f"{used >> 20} MB of memory were used"
