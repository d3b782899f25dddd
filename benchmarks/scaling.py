"""Draws how the rate of many worlds grows with their number and with the threads: `make scaling`.

The plot goes to docs/scaling.svg, the figures to standard output.
"""

from __future__ import annotations

import argparse
import os
import statistics
import time
from pathlib import Path

from throughput import CASES, ROOT, SCENES

from carom import Worlds

COUNTS = (1, 4, 16, 64, 256, 1024, 4096)


def rate(case: str, count: int, threads: int, seconds: float) -> float:
    """World-steps per second, one step a call: median of three turns."""
    worlds = Worlds(SCENES[case](), count, threads=threads)
    worlds.step(20)
    turns = []
    for _ in range(3):
        start, steps = time.perf_counter(), 0
        while time.perf_counter() - start < seconds:
            worlds.step()
            steps += 1
        turns.append(count * steps / (time.perf_counter() - start))
    return statistics.median(turns)


def main() -> None:
    """Measure, print and draw."""
    parser = argparse.ArgumentParser(description="Draw how the rate of many worlds grows.")
    parser.add_argument(
        "--seconds", type=float, default=0.3, help="time spent on each point in each of 3 turns"
    )
    parser.add_argument("--plot", type=Path, default=ROOT / "docs" / "scaling.svg")
    arguments = parser.parse_args()
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "carom"
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, len(CASES), figsize=(9, 3.6), layout="constrained")
    for axis, (case, title) in zip(axes, CASES.items(), strict=True):
        for threads, style in zip(range(1, cores + 1), ("o-", "s--", "^:", "d-."), strict=False):
            rates = [rate(case, count, min(threads, count), arguments.seconds) for count in COUNTS]
            for count, value in zip(COUNTS, rates, strict=True):
                print(f"{title}: {count} worlds, {threads} threads, {value:,.0f} steps a second", flush=True)
            axis.loglog(COUNTS, rates, style, label=f"{threads} thread{'s' if threads > 1 else ''}")
        axis.set_title(title)
        axis.set_xlabel("worlds")
        axis.grid(which="both", alpha=0.3)
        axis.legend()
    axes[0].set_ylabel("world-steps per second")
    figure.savefig(arguments.plot, metadata={"Date": None})


if __name__ == "__main__":
    main()
