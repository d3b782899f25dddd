"""Measure the sizes of PyBullet's random objects, choose those of ours, and compare the two distributions.

Run `.oracle/bin/python -m tools.assets.random_objects.measure` with `record` or `compare`, from the root.
`record` writes `sizes.csv`, to which `arrange.py` adds what our objects are made of, and `spread.csv`;
`compare` prints the table of the documentation. Both need an interpreter that has PyBullet and the original
pybullet_data.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tools.assets.random_objects.beams import COUNT, SIZES
from tools.assets.random_objects.solids import Part, Size, distance, measured

SPREAD = Path(__file__).with_name("spread.csv")
OURS = Path(__file__).resolve().parents[3] / "src" / "pybullet_data"
RECORDED = 10
"""The first ones have the sizes of PyBullet's of the same numbers, of which the tests know all facts."""
GOAL = 0.03
"""How far the distribution of a quantity among ours may be from that among PyBullet's."""

QUANTITIES: Mapping[str, Callable[[Size], float]] = {
    "shortest edge of the bounds": lambda size: float(size.extents[0]),
    "middle edge": lambda size: float(size.extents[1]),
    "longest edge": lambda size: float(size.extents[2]),
    "volume": lambda size: size.volume,
    "share of the bounds that is filled": lambda size: size.fill,
    "share of the bounds within the hull": lambda size: size.hull,
}


def parts_of(path: Path) -> list[Part]:
    """The objects of an OBJ file."""
    corners: list[list[float]] = []
    objects: list[list[tuple[int, ...]]] = []
    for words in map(str.split, path.read_text().splitlines()):
        if words[:1] == ["o"]:
            objects.append([])
        elif words[:1] == ["v"]:
            corners.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            objects[-1].append(tuple(int(word.split("/")[0]) - 1 for word in words[1:]))
    return [_alone(np.array(corners), faces) for faces in objects if faces]


def _alone(corners: NDArray[np.float64], faces: list[tuple[int, ...]]) -> Part:
    used = sorted({corner for face in faces for corner in face})
    number = {corner: place for place, corner in enumerate(used)}
    return Part(corners[used], [tuple(number[corner] for corner in face) for face in faces])


def size_in(folder: Path, number: int) -> Size | None:
    """The size of an object, or None if its mesh is none (one of PyBullet's is of NaN)."""
    path = folder / f"random_urdfs/{number:03d}/{number:03d}.urdf"
    text = path.read_text()
    scale = np.array([float(word) for word in _attribute(text, "scale").split()])
    parts = [
        Part(part.corners * scale, part.faces)
        for part in parts_of(path.with_suffix(".obj"))
        if np.isfinite(part.corners).all()
    ]
    return measured(parts) if parts else None


def mass_in(folder: Path, number: int) -> float:
    """The mass of an object [kg]."""
    text = (folder / f"random_urdfs/{number:03d}/{number:03d}.urdf").read_text()
    return float(re.findall(r'<mass value="([^"]*)"', text)[0])


def _attribute(text: str, name: str) -> str:
    return re.findall(rf'\b{name}="([^"]*)"', text)[-1]


def chosen(sizes: Mapping[int, Size]) -> list[int]:
    """Numbers of the objects whose sizes ours have.

    First those of the same numbers; then some are exchanged, by chance, until every quantity is spread as
    among all.
    """
    columns = [np.array([value(size) for size in sizes.values()]) for value in QUANTITIES.values()]
    numbers = list(sizes)
    picked = list(range(COUNT))

    def apart() -> float:
        return max(distance(column[picked], column) for column in columns)

    random = np.random.default_rng(0)
    best = apart()
    while best > GOAL:
        place, other = int(random.integers(RECORDED, COUNT)), int(random.integers(len(numbers)))
        if other in picked:
            continue
        before, picked[place] = picked[place], other
        if (now := apart()) <= best:
            best = now
        else:
            picked[place] = before
    return [numbers[place] for place in picked]


def record(originals: Path) -> None:
    """Write the sizes that ours are to have."""
    sizes = _all_sizes(originals, 1000)
    lines = ["of,parts,low x,low y,low z,high x,high y,high z,fill,hull"]
    for number in chosen(sizes):
        size = sizes[number]
        row = [*size.low.tolist(), *size.high.tolist()]
        shares = f"{size.fill:.4f},{size.hull:.4f}"
        parts = len(parts_of(originals / f"random_urdfs/{number:03d}/{number:03d}.obj"))
        lines.append(f"{number},{parts}," + ",".join(f"{value:.9g}" for value in row) + f",{shares}")
    SIZES.write_text("\n".join(lines) + "\n")
    write_spread(list(sizes.values()))


def write_spread(sizes: list[Size]) -> None:
    """Write the percentiles of every quantity among PyBullet's objects, for the tests."""
    columns = [np.array([value(size) for size in sizes]) for value in QUANTITIES.values()]
    rows = np.quantile(np.array(columns), np.linspace(0.0, 1.0, 101), axis=1)
    lines = [",".join(QUANTITIES), *(",".join(f"{value:.5g}" for value in row) for row in rows)]
    SPREAD.write_text("\n".join(lines) + "\n")


def _all_sizes(folder: Path, count: int) -> dict[int, Size]:
    found = {number: size_in(folder, number) for number in range(count)}
    return {number: size for number, size in found.items() if size is not None}


def compare(originals: Path) -> None:
    """Print how far apart the distributions are."""
    ours, theirs = (
        list(_all_sizes(folder, count).values()) for folder, count in ((OURS, COUNT), (originals, 1000))
    )
    print("| quantity | PyBullet's: 5 %, half, 95 % | ours | distance |\n|---|---|---|---|")
    for name, value in QUANTITIES.items():
        _print_row(name, *(np.array([value(size) for size in sizes]) for sizes in (theirs, ours)))
    masses = [
        np.array([mass_in(folder, number) for number in range(count)])
        for folder, count in ((originals, 1000), (OURS, COUNT))
    ]
    _print_row("mass", *masses)


def _print_row(name: str, theirs: NDArray[np.float64], ours: NDArray[np.float64]) -> None:
    cells = [
        ", ".join(f"{value:.3g}" for value in np.quantile(column, (0.05, 0.5, 0.95)))
        for column in (theirs, ours)
    ]
    print(f"| {name} | {cells[0]} | {cells[1]} | {distance(ours, theirs):.3f} |")


if __name__ == "__main__":
    import pybullet_data

    {"record": record, "compare": compare}[sys.argv[1]](Path(pybullet_data.getDataPath()))
