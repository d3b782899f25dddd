"""Meshes that MJCF makes by name: cones and spheres."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray

from carom.native.products import dots
from carom.native.trigonometry import cos, sin

Made = tuple[NDArray[np.float64], NDArray[np.int32]]
_MAX_DIVISIONS = 4


def builtin_mesh(name: str, parameters: list[float]) -> Made | str:
    """Vertices (n, 3) and triangles (m, 3) of a mesh, or what is wrong with its name and parameters.

    A `cone` has the number of its sides and the radius of its upper end, for 1 at its lower end; it goes
    from -1 to 1 along z. A `sphere` is an icosahedron of radius 1, divided so many times.
    """
    if name == "cone":
        if len(parameters) != 2 or parameters[0] < 3 or not 0.0 <= parameters[1] <= 1.0:
            return "params of a cone are its number of sides, at least 3, and a radius from 0 to 1"
        return _cone(int(parameters[0]), parameters[1])
    if name == "sphere":
        if len(parameters) != 1 or not 0 <= parameters[0] <= _MAX_DIVISIONS:
            return f"params of a sphere are a number of divisions from 0 to {_MAX_DIVISIONS}"
        return _sphere(int(parameters[0]))
    return f"Carom makes no mesh builtin={name!r}; it makes cone and sphere. Write the mesh to a file"


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
