"""Meshes that MJCF makes by name: cones, spheres, plates and wedges."""

from __future__ import annotations

from itertools import pairwise
from math import pi

import numpy as np
from numpy.typing import NDArray

from carom.files.budget import charge
from carom.formats.mjcf.compiled.shapes.curved_meshes import CURVED
from carom.native.products import dots
from carom.native.trigonometry import cos, sin

Made = tuple[NDArray[np.float64], NDArray[np.int32]]
_MAX_DIVISIONS = 4


def builtin_mesh(name: str, parameters: list[float]) -> Made | str:
    """Vertices (n, 3) and triangles (m, 3) of a mesh, or what is wrong with its name and parameters.

    A `cone` has the number of its sides and the radius of its upper end, for 1 at its lower end; it goes
    from -1 to 1 along z. A `sphere` is an icosahedron of radius 1, divided so many times. A `plate` has so
    many points along x and y in the plane z = -1. A `wedge` has them on a sphere of radius 1 around -z,
    within two angles [degrees], and the denser in the middle the more its last parameter is above 0.
    The others are in `carom.formats.mjcf.compiled.shapes.curved_meshes`.
    """
    if name == "cone":
        if len(parameters) != 2 or parameters[0] < 3 or not 0.0 <= parameters[1] <= 1.0:
            return "params of a cone are its number of sides, at least 3, and a radius from 0 to 1"
        charge("vertices", 6 * int(parameters[0]))
        return _cone(int(parameters[0]), parameters[1])
    if name == "sphere":
        if len(parameters) != 1 or not 0 <= parameters[0] <= _MAX_DIVISIONS:
            return f"params of a sphere are a number of divisions from 0 to {_MAX_DIVISIONS}"
        return _sphere(int(parameters[0]))
    if name == "plate":
        if len(parameters) != 2 or min(parameters) < 2:
            return "params of a plate are two numbers of points, at least 2 each"
        charge("vertices", 3 * int(parameters[0]) * int(parameters[1]))
        x, y = (_centres(int(count), 0.0) for count in parameters)
        return _grid([[(a, b, -1.0) for b in y] for a in x])
    if name == "wedge":
        if len(parameters) != 5 or min(parameters[:2]) < 2:
            return "params of a wedge are two numbers of points, at least 2 each, two angles, and a density"
        charge("vertices", 3 * int(parameters[0]) * int(parameters[1]))
        return _wedge(int(parameters[0]), int(parameters[1]), *parameters[2:])
    if name in CURVED:
        return CURVED[name](parameters)
    made = ", ".join(sorted(("cone", "plate", "sphere", "wedge", *CURVED)))
    return f"there is no mesh builtin={name!r}; it can be {made}"


def _centres(count: int, density: float) -> list[float]:
    """Centres of so many cells from -1 to 1; their ends are equally spaced if the density is 0."""
    even = [2.0 * end / count - 1.0 for end in range(count + 1)]
    ends = [(1.0 - density) * x + density * x**5 for x in even]
    return [0.5 * (first + second) for first, second in pairwise(ends)]


def _wedge(columns: int, rows: int, across: float, along: float, density: float) -> Made:
    turns = [across * pi / 180.0 * x for x in _centres(columns, density)]
    slopes = [along * pi / 180.0 * x for x in _centres(rows, density)]
    return _grid(
        [[(sin(a) * cos(b), sin(b), -cos(a) * cos(b)) for b in slopes] for a in turns],
    )


def _grid(points: list[list[tuple[float, float, float]]]) -> Made:
    """Two triangles between each four points of a grid, seen from below."""
    rows = len(points[0])
    triangles: list[tuple[int, int, int]] = []
    for column in range(len(points) - 1):
        for row in range(rows - 1):
            here = column * rows + row
            triangles += [(here, here + 1, here + rows), (here + 1, here + rows + 1, here + rows)]
    return np.array([point for column in points for point in column]), np.array(triangles, np.int32)


def _cone(sides: int, upper: float) -> Made:
    angles = [2.0 * pi * side / sides for side in range(sides)]
    bottom = [(cos(angle), sin(angle), -1.0) for angle in angles]
    triangles = [(0, side + 1, side) for side in range(1, sides - 1)]
    if upper == 0.0:
        triangles += [(side, (side + 1) % sides, sides) for side in range(sides)]
        return np.array([*bottom, (0.0, 0.0, 1.0)]), np.array(triangles, np.int32)
    top = [(upper * x, upper * y, 1.0) for x, y, _ in bottom]
    triangles += [(sides, sides + side, sides + side + 1) for side in range(1, sides - 1)]
    for side in range(sides):
        after = (side + 1) % sides
        triangles += [(side, after, sides + after), (side, sides + after, sides + side)]
    return np.array([*bottom, *top]), np.array(triangles, np.int32)


def _sphere(divisions: int) -> Made:
    golden = 0.5 * (1.0 + 5.0**0.5)
    corners = [(s, t * golden, 0.0) for s in (-1.0, 1.0) for t in (-1.0, 1.0)]
    vertices = [np.roll(corner, turn) for turn in range(3) for corner in corners]
    points = np.array(vertices) / np.sqrt(1.0 + golden * golden)
    triangles = [
        (a, b, c) if dots(points[a], np.cross(points[b], points[c])) > 0.0 else (a, c, b)
        for a in range(12)
        for b in range(a + 1, 12)
        for c in range(b + 1, 12)
        if max(_apart(points, a, b), _apart(points, b, c), _apart(points, a, c)) < 1.2
    ]
    for _ in range(divisions):
        points, triangles = _divided(points, triangles)
    return points, np.array(triangles, np.int32)


def _apart(points: NDArray[np.float64], a: int, b: int) -> float:
    return float(np.sqrt(((points[a] - points[b]) ** 2).sum()))


def _divided(
    points: NDArray[np.float64], triangles: list[tuple[int, int, int]]
) -> tuple[NDArray[np.float64], list[tuple[int, int, int]]]:
    """Each triangle cut into four, the new corners moved to the sphere."""
    kept = list(points)
    between: dict[tuple[int, int], int] = {}

    def middle(a: int, b: int) -> int:
        key = (min(a, b), max(a, b))
        if key not in between:
            point = points[a] + points[b]
            between[key] = len(kept)
            kept.append(point / np.sqrt((point * point).sum()))
        return between[key]

    finer = []
    for a, b, c in triangles:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return np.array(kept), finer
