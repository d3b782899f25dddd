"""Find an arrangement of beams for each of our random objects, and write it beside its size.

python -m tools.assets.random_objects.arrange
"""

from __future__ import annotations

import numpy as np
from tools.assets.random_objects.beams import SIZES, UNITS, Beam, arranged, drawn, part_of
from tools.assets.random_objects.solids import fill, hull_fill

LOTS = 700
"""Arrangements that are drawn."""
GUESSES = (0.15, 0.4, 0.8, 1.4)
"""Thicknesses at which all are measured beforehand."""
HALVINGS = 10
HEADER = "of,parts,low x,low y,low z,high x,high y,high z,fill,hull,lot,thick"


def hull_of(beams: list[Beam], thick: float) -> float:
    """Share of the unit cube within the hull of beams."""
    return hull_fill(np.vstack([part.corners for part in arranged(beams, thick)]) / UNITS)


def thickness(beams: list[Beam], goal: float) -> float:
    """How thick beams are that fill so much of the unit cube."""
    thin, thick = 0.0, 4.0
    for _ in range(HALVINGS):
        middle = (thin + thick) / 2.0
        if fill([part_of(beam, middle) for beam in beams]) < goal:
            thin = middle
        else:
            thick = middle
    return round((thin + thick) / 2.0, 4)


def best_alone(goal: float) -> int:
    """The lot of the beam that fills most nearly so much of the unit cube, which it spans."""
    filled = [fill([part_of(beam, 1.0) for beam in drawn(lot, alone=True)]) for lot in range(LOTS)]
    return int(np.argmin(np.abs(np.array(filled) - goal)))


def main() -> None:
    """Of all arrangements, take for each object the one that fills what it should, and whose hull does."""
    rows = np.loadtxt(SIZES, delimiter=",", skiprows=1)
    texts = [",".join(line.split(",")[:10]) for line in SIZES.read_text().splitlines()[1:]]
    lots = [drawn(lot) for lot in range(LOTS)]
    known = np.array(
        [[(fill([part_of(b, t) for b in beams]), hull_of(beams, t)) for t in GUESSES] for beams in lots]
    )
    taken: set[int] = set()
    lines = [HEADER]
    for text, (parts, volume, hull) in zip(texts, rows[:, (1, 8, 9)], strict=True):
        if parts == 1:
            lines.append(f"{text},{best_alone(volume)},1.0")
            continue
        expected = np.array([np.interp(volume, fills, hulls) for fills, hulls in np.moveaxis(known, 2, 1)])
        lot = next(lot for lot in np.argsort(np.abs(expected - hull)).tolist() if lot not in taken)
        taken.add(lot)
        lines.append(f"{text},{lot},{thickness(lots[lot], volume)}")
    SIZES.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
