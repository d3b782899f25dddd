"""Learning curves of `time_to_score.py` beside each other: return over time, of both engines.

    python benchmarks/learning_curves.py --plot docs/time-to-score.svg NAME=CAROM.csv,PYBULLET.csv ...

NAME is the title of a panel.
"""

from __future__ import annotations

import argparse
import csv
from pathlib import Path

import matplotlib

ROOT = Path(__file__).resolve().parents[1]
ENGINES = ("Carom", "PyBullet, SubprocVecEnv")
COLOURS = ("#2b6cb0", "#c05621")


def curve_of(file: Path) -> tuple[list[float], list[float]]:
    """Minutes and mean returns that a file of `time_to_score.py` holds."""
    with open(file, newline="", encoding="utf-8") as opened:
        rows = list(csv.DictReader(opened))
    return [float(row["seconds"]) / 60.0 for row in rows], [float(row["mean_return"]) for row in rows]


def main() -> None:
    """Draw, and save."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("panels", nargs="+", metavar="NAME=CAROM.csv,PYBULLET.csv")
    parser.add_argument("--plot", type=Path, default=ROOT / "docs" / "time-to-score.svg")
    parser.add_argument("--score", type=float, default=2000.0, help="the score, a dotted line")
    asked = parser.parse_args()
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "carom"
    import matplotlib.pyplot as plt

    columns = min(len(asked.panels), 2)
    rows = -(-len(asked.panels) // columns)
    figure, panels = plt.subplots(rows, columns, figsize=(4.5 * columns, 3.2 * rows), squeeze=False)
    for empty in panels.flat[len(asked.panels) :]:
        empty.remove()
    for panel, words in zip(panels.flat, asked.panels, strict=False):
        name, _, files = words.partition("=")
        for file, engine, colour in zip(files.split(","), ENGINES, COLOURS, strict=True):
            panel.plot(*curve_of(Path(file)), label=engine, color=colour)
        panel.axhline(asked.score, color="grey", linestyle=":", linewidth=1.0)
        panel.set(title=name, xlabel="time [min]", ylabel="mean return of 100 episodes")
        panel.set_xlim(left=0.0)
        panel.legend(loc="lower right")
    figure.tight_layout()
    figure.savefig(asked.plot, metadata={"Date": None})


if __name__ == "__main__":
    main()
