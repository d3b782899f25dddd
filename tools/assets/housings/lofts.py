"""Housings as lofts: skins over sections that change along an axis of their link."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from tools.assets.fields import Points
from tools.assets.obj_mesh import ObjMesh, together

SIDES = 20
"""Facets around a loft."""
PAINT = 0.0006
"""Thickness of what lies on a loft [m]: enough that it hides what is below."""
OTHERS = {"x": (1, 2), "y": (0, 2), "z": (0, 1)}
"""The axes of a section, by the axis along which it is pushed."""

Section = tuple[float, float, float, float, float]
"""Its place along the axis, its middle and its half widths along the other two axes, in their order [m]."""


@dataclass(frozen=True)
class Loft:
    """A skin over sections, flat at both ends.

    Attributes:
        axis: The axis of the link along which the sections lie.
        power: How square they are: `|u / a|**power + |v / b|**power = 1` is their outline, 2 an ellipse.
        sections: In the order of their places.
    """

    axis: Literal["x", "y", "z"]
    power: float
    sections: Sequence[Section]


def band(loft: Loft, low: float, high: float) -> Loft:
    """What lies on a loft like paint between two places along its axis [m]."""
    table = np.array(loft.sections)
    places = [low, *(place for place in table[:, 0].tolist() if low < place < high), high]
    columns = [np.interp(places, table[:, 0], column) for column in table[:, 1:].T]
    columns[2:] = [half + PAINT for half in columns[2:]]
    rows = np.column_stack((places, *columns)).tolist()
    return Loft(loft.axis, loft.power, [(place, u, v, a, b) for place, u, v, a, b in rows])


def loft_mesh(loft: Loft) -> ObjMesh:
    """A closed mesh, smooth-shaded but for its ends."""
    table = np.array(loft.sections)
    if len(table) < 2 or np.any(np.diff(table[:, 0]) <= 0.0):
        raise ValueError(f"a loft needs two sections or more, each further along {loft.axis} than the last")
    turn = 2.0 * np.pi * np.arange(SIDES) / SIDES
    outline = np.column_stack((np.cos(turn), np.sin(turn)))
    outline /= (np.abs(outline) ** loft.power).sum(axis=1, keepdims=True) ** (1.0 / loft.power)
    flat = table[:, None, 1:3] + table[:, None, 3:] * outline
    rings = _placed(loft.axis, table[:, 0], flat)
    normals = _outward(rings, loft.axis)
    faces: list[tuple[int, ...]] = [
        (SIDES * i + j, SIDES * i + k, SIDES * (i + 1) + k, SIDES * (i + 1) + j)
        for i in range(len(table) - 1)
        for j, k in ((j, (j + 1) % SIDES) for j in range(SIDES))
    ]
    first = SIDES * len(table)
    faces += [tuple(range(first + SIDES - 1, first - 1, -1)), tuple(range(first + SIDES, first + 2 * SIDES))]
    if loft.axis == "y":  # x, z and y are left-handed.
        faces = [tuple(reversed(face)) for face in faces]
    end = np.eye(3)["xyz".index(loft.axis)]
    return ObjMesh(
        np.concatenate((*rings, rings[0], rings[-1])),
        faces,
        np.concatenate((*normals, np.tile(-end, (SIDES, 1)), np.tile(end, (SIDES, 1)))),
    )


def housing(lofts: Sequence[Loft]) -> ObjMesh:
    """Lofts that run into each other, as one mesh."""
    return together([loft_mesh(loft) for loft in lofts])


def _placed(axis: str, along: NDArray[np.float64], flat: Points) -> Points:
    """Points (n, m, 3) of sections whose outlines are (n, m, 2)."""
    points = np.empty((*flat.shape[:2], 3))
    points[..., "xyz".index(axis)] = along[:, None]
    points[..., list(OTHERS[axis])] = flat
    return points


def _outward(rings: Points, axis: str) -> Points:
    """Unit normals (n, SIDES, 3) of the skin."""
    around = np.roll(rings, -1, axis=1) - np.roll(rings, 1, axis=1)
    along = np.gradient(rings, axis=0)
    normals = np.cross(around, along)
    normals *= -1.0 if axis == "y" else 1.0
    return normals / np.linalg.norm(normals, axis=-1, keepdims=True)
