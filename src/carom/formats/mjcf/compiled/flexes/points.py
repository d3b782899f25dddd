"""Points and cells of the flexes that MuJoCo makes: grids, circles and shells, in its order of points.

Pins name points by their numbers, so these count.
"""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

from carom.native.trigonometry import cos, sin

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Counts = tuple[int, int, int]
# Six tetrahedra of a cell around the diagonal from 3 to 4; bits 2, 1 and 0 of a corner are its x, y and z.
_IN_CELL = ((0, 2, 4, 3), (0, 4, 1, 3), (4, 2, 6, 3), (4, 6, 7, 3), (4, 5, 1, 3), (4, 7, 5, 3))


def grid_points(counts: Counts, spacing: Floats, dimensions: int) -> tuple[Floats, Ints]:
    """A grid around the origin, z fastest: (n, 3) points, and edges, triangles or tetrahedra."""
    steps = [np.arange(count) - 0.5 * (count - 1) for count in counts]
    points = np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 3) * spacing
    _, ny, nz = counts
    cells: list[tuple[int, ...]] = []
    if dimensions == 1:
        cells = [(node, node + 1) for node in range(counts[0] - 1)]
    elif dimensions == 2:
        for i, j in product(range(counts[0] - 1), range(ny - 1)):
            a, b = i * ny + j, (i + 1) * ny + j
            cells += [(a, b, b + 1), (a, b + 1, a + 1)]
    else:
        for i, j, k in product(range(counts[0] - 1), range(ny - 1), range(nz - 1)):
            origin = (i * ny + j) * nz + k
            corner = [origin + (bits >> 2) * ny * nz + (bits >> 1 & 1) * nz + (bits & 1) for bits in range(8)]
            cells += [tuple(corner[bits] for bits in tetra) for tetra in _IN_CELL]
    return points, np.array(cells, np.int32).reshape(-1, dimensions + 1)


def circle_points(count: int, spacing: float) -> tuple[Floats, Ints]:
    """A ring in the plane z = 0: as many edges as one less than `count`, which has the first point twice."""
    edges = count - 1
    angles = (2.0 * np.pi * np.arange(edges) / edges).tolist()
    radius = 0.5 * spacing / sin(np.pi / edges)
    points = np.array([(radius * cos(angle), radius * sin(angle), 0.0) for angle in angles])
    numbers = np.arange(edges)
    return points, np.stack([numbers, (numbers + 1) % edges], axis=1).astype(np.int32)


def disc_points(counts: Counts, spacing: Floats) -> tuple[Floats, Ints]:
    """A grid of triangles in the plane z = 0, drawn in to a disc as MuJoCo does it.

    Its half extents are the squares of those of the grid: in a file of MuJoCo they count twice.
    """
    nx, ny = counts[:2]
    points, _ = grid_points((nx, ny, 1), spacing, 2)
    length = np.linalg.norm(points, axis=1, keepdims=True)
    most = np.abs(points).max(axis=1, keepdims=True)
    half = 0.5 * (np.array(counts) - 1) * spacing
    points = points * np.divide(most, length, out=np.zeros_like(most), where=length > 0.0) * half
    triangles: list[tuple[int, int, int]] = []
    for i, j in product(range(nx - 1), range(ny - 1)):
        a, b, c, d = i * ny + j, i * ny + j + 1, (i + 1) * ny + j, (i + 1) * ny + j + 1
        # The diagonals point to the middle.
        is_apart = (2 * i < nx - 1) != (2 * j < ny - 1)
        triangles += [(a, c, b), (c, d, b)] if is_apart else [(a, c, d), (a, d, b)]
    return points, np.array(triangles, np.int32)


def shell_points(kind: str, counts: Counts, spacing: Floats, *, is_solid: bool) -> tuple[Floats, Ints]:
    """The surface of a box, cylinder or ellipsoid.

    A solid one has its middle as the first point, which all tetrahedra share. One of triangles is open at the
    top, as MuJoCo makes it.
    """
    found: dict[Counts, int] = {}
    triangles: list[tuple[int, int, int]] = []
    first = 1 if is_solid else 0
    for axis, level, turned in _sides(counts, is_solid=is_solid):
        u, v = (each for each in range(3) if each != axis)

        def at(p: int, q: int, axis: int = axis, level: int = level, u: int = u, v: int = v) -> int:
            place = [0, 0, 0]
            place[axis], place[u], place[v] = level, p, q
            return found.setdefault((place[0], place[1], place[2]), first + len(found))

        for p, q in product(range(counts[u]), range(counts[v])):
            at(p, q)
        for p, q in product(range(counts[u] - 1), range(counts[v] - 1)):
            a, b, c, d = at(p, q), at(p, q + 1), at(p + 1, q), at(p + 1, q + 1)
            triangles += [(a, c, b), (c, d, b)] if turned else [(a, c, d), (a, d, b)]
    half = 0.5 * (np.array(counts) - 1)
    places = (np.array(list(found)) - half) / half
    points = _projected(kind, places) * half * spacing
    cells = np.array(triangles, np.int32)
    if not is_solid:
        return points, cells
    middle = np.zeros((len(cells), 1), np.int32)
    return np.concatenate([np.zeros((1, 3)), points]), np.concatenate([middle, cells], axis=1)


def _sides(counts: Counts, *, is_solid: bool) -> list[tuple[int, int, bool]]:
    """Axis and level of the sides in order, and whether the other diagonal of cells is an edge."""
    x, y, z = (count - 1 for count in counts)
    if is_solid:
        return [(2, 0, False), (2, z, False), (1, 0, False), (1, y, False), (0, 0, False), (0, x, False)]
    return [(2, 0, False), (1, 0, False), (1, y, True), (0, 0, True), (0, x, False)]


def _projected(kind: str, places: Floats) -> Floats:
    """Points of the surface of a cube of half side 1, on that of another shape."""
    if kind == "ellipsoid":
        return places / np.linalg.norm(places, axis=1, keepdims=True)
    if kind == "cylinder":
        flat = places[:, :2]
        length = np.linalg.norm(flat, axis=1, keepdims=True)
        most = np.abs(flat).max(axis=1, keepdims=True)
        scaled = flat * np.divide(most, length, out=np.zeros_like(most), where=length > 0.0)
        return np.concatenate([scaled, places[:, 2:]], axis=1)
    return places
