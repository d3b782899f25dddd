"""Draws how the time of a step grows with the number of bodies: `make growth`.

The bodies lie side by side on the floor, so that with their number only the number of contacts grows.
The plot goes to docs/growth.svg, the figures to standard output.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from engines import ROOT, Engine

COUNTS = (100, 200, 500, 1000, 2000, 5000)


def measure(engine: Engine, seconds: float) -> list[float]:
    """Median seconds of a step for each number of bodies."""
    with engine.worker(seconds, "") as worker:
        times = [worker.time(f"step_{count}_apart") for count in COUNTS]
    if None in times:
        raise SystemExit(f"{engine.name} failed")
    return [time for time in times if time is not None]


def main() -> None:
    """Measure, print and draw."""
    parser = argparse.ArgumentParser(description="Draw how the time of a step grows.")
    parser.add_argument("--oracle", type=Path, default=ROOT / ".oracle" / "bin" / "python")
    parser.add_argument("--seconds", type=float, default=1.0, help="time spent on each number of bodies")
    parser.add_argument("--plot", type=Path, default=ROOT / "docs" / "growth.svg")
    arguments = parser.parse_args()
    engines = [
        Engine("Carom", Path(sys.executable), "pybullet_cases", {"PYTHONPATH": str(ROOT / "src")}),
        Engine("PyBullet", arguments.oracle.absolute(), "pybullet_cases"),
    ]

    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "carom"
    from matplotlib import pyplot

    figure, axis = pyplot.subplots(figsize=(7, 3.6), layout="constrained")
    for engine, style in zip(engines, ("o-", "s--"), strict=True):
        times = measure(engine, arguments.seconds)
        for count, time in zip(COUNTS, times, strict=True):
            print(
                f"{engine.name}: {count} bodies, {1e3 * time:.3g} ms a step, {1e6 * time / count:.3g} µs each"
            )
        axis.loglog(COUNTS, [1e3 * time for time in times], style, label=engine.name)
    axis.set_xlabel("free bodies")
    axis.set_ylabel("time of a step [ms]")
    axis.grid(which="both", alpha=0.3)
    axis.legend()
    figure.savefig(arguments.plot, metadata={"Date": None})


if __name__ == "__main__":
    main()
