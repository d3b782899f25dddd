"""The long form of the memory test: a million steps, two thousand robots loaded and removed.

.venv/bin/python -m tests.conformance.soak [--steps N] [--cycles N]
"""

from __future__ import annotations

import argparse
import importlib
import sys
import time
from collections.abc import Callable
from typing import Any

from .memory import Growth, growth_of, loading, stepping

# The resident size wobbles by what the allocators hold back; a leak of 8 bytes a step exceeds this.
ALLOWED_RESIDENT = 4_000_000
ALLOWED_PYTHON = 200_000


def soak(title: str, prepare: Callable[[Any], Callable[[int], None]], count: int) -> bool:
    """Do the work in a world of its own, say how memory fared, and whether it stayed."""
    pybullet = importlib.import_module("pybullet")
    client = pybullet.connect(pybullet.DIRECT)
    start = time.perf_counter()
    growth: Growth = growth_of(prepare(pybullet), count)
    seconds = time.perf_counter() - start
    pybullet.disconnect(client)
    holds = growth.python <= ALLOWED_PYTHON and (growth.resident or 0) <= ALLOWED_RESIDENT
    resident = "unknown" if growth.resident is None else f"{growth.resident / 1024:.0f} KiB"
    print(
        f"{title}: {count} in {seconds:.0f} s; growth in the second half: process {resident}, "
        f"Python objects {growth.python / 1024:.0f} KiB: {'ok' if holds else 'GROWS'}",
        flush=True,
    )
    return holds


def main() -> None:
    """Run both, or one if the count of the other is 0; the exit code tells whether memory stayed."""
    parser = argparse.ArgumentParser(description="Check over a long time that memory does not grow.")
    parser.add_argument("--steps", type=int, default=1_000_000)
    parser.add_argument("--cycles", type=int, default=2_000)
    arguments = parser.parse_args()
    works = (("load, step, remove", loading, arguments.cycles), ("steps", stepping, arguments.steps))
    results = [soak(title, prepare, count) for title, prepare, count in works if count]
    sys.exit(0 if all(results) else 1)


if __name__ == "__main__":
    main()
