"""Meshes of soft bodies as the text of files, for either engine."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

_IN_CELL = ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7))


def square_text(side: int) -> str:
    """A square of 1 m with so many nodes along each side, as an OBJ file."""
    lines = [f"v {i / (side - 1) - 0.5} {j / (side - 1) - 0.5} 0" for j in range(side) for i in range(side)]
    for j in range(side - 1):
        for i in range(side - 1):
            a = j * side + i + 1
            lines += [f"f {a} {a + 1} {a + side + 1}", f"f {a} {a + side + 1} {a + side}"]
    return "\n".join(lines) + "\n"


def cuboid_text(cells: tuple[int, int, int], size: tuple[float, float, float], *, ball: bool = False) -> str:
    """A cuboid of tetrahedra, six in each cell, as a VTK file; one of equal sides may be made a ball."""
    x, y, z = (count + 1 for count in cells)
    points = []
    for k in range(z):
        for j in range(y):
            for i in range(x):
                place = np.array([i / cells[0], j / cells[1], k / cells[2]]) - 0.5
                length = float(np.linalg.norm(place))
                if ball and length > 0.0:
                    place *= np.abs(place).max() / length
                points.append(" ".join(f"{value:.9g}" for value in place * size))
    tetras = []
    for k in range(cells[2]):
        for j in range(cells[1]):
            for i in range(cells[0]):
                corner = [((k + (b >> 2)) * y + j + (b >> 1 & 1)) * x + i + (b & 1) for b in range(8)]
                tetras += [[corner[b] for b in four] for four in _IN_CELL]
    lines = ["# vtk DataFile Version 2.0", "cuboid", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines += [f"POINTS {len(points)} double", *points, f"CELLS {len(tetras)} {5 * len(tetras)}"]
    lines += [" ".join(map(str, [4, *four])) for four in tetras]
    lines += [f"CELL_TYPES {len(tetras)}", *["10"] * len(tetras)]
    return "\n".join(lines) + "\n"


@contextmanager
def mesh_file(name: str, text: str) -> Iterator[str]:
    """The path of a file with a text, for as long as it is needed."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_text(text)
        yield str(path)
