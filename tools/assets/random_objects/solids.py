"""Solids of several convex parts: how much of their bounds they fill, and how much their hull fills."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]

CELLS = 24
"""Points along each axis at which the volume of a union is counted."""
DIRECTIONS = 400
"""How many half spaces stand for a convex hull."""


@dataclass(frozen=True)
class Part:
    """A convex polyhedron.

    Attributes:
        corners: (n, 3) [m].
        faces: Corner numbers of each face, anticlockwise seen from outside.
    """

    corners: Points
    faces: Sequence[tuple[int, ...]]


@dataclass(frozen=True)
class Size:
    """What a solid measures.

    Attributes:
        low: Least coordinates of its corners (3,) [m].
        high: Greatest ones (3,) [m].
        fill: Volume of the solid over that of its bounds.
        hull: Volume of its convex hull over that of its bounds.
    """

    low: Points
    high: Points
    fill: float
    hull: float

    @property
    def extents(self) -> Points:
        """Edges of the bounds, the shortest first (3,) [m]."""
        return np.sort(self.high - self.low)

    @property
    def volume(self) -> float:
        """Volume of the solid [m³]."""
        return self.fill * float(np.prod(self.high - self.low))


def measured(parts: Sequence[Part]) -> Size:
    """The size of the union of convex parts, counted on a grid of points within its bounds."""
    corners = np.vstack([part.corners for part in parts])
    low, high = corners.min(axis=0), corners.max(axis=0)
    shape = [Part((part.corners - low) / (high - low), part.faces) for part in parts]
    return Size(low, high, fill(shape), hull_fill((corners - low) / (high - low)))


def fill(shape: Sequence[Part]) -> float:
    """How much of the unit cube convex parts fill together."""
    grid = unit_grid()
    inside = np.zeros(len(grid), bool)
    for part in shape:
        inside |= _within(grid, part.corners, part.faces)
    return float(inside.mean())


@cache
def unit_grid() -> Points:
    """Middles of the cells of the unit cube."""
    middles = (np.arange(CELLS) + 0.5) / CELLS
    return np.stack(np.meshgrid(middles, middles, middles, indexing="ij"), axis=-1).reshape(-1, 3)


def _within(points: Points, corners: Points, faces: Sequence[tuple[int, ...]]) -> NDArray[np.bool_]:
    normals, distances = [], []
    for face in faces:
        first, *others = corners[list(face)]
        fan = [np.cross(a - first, b - first) for a, b in pairwise(others)]
        normals.append(np.sum(fan, axis=0))
        distances.append(first @ normals[-1] + 1e-12)
    outward = np.array(normals).T
    return (points @ outward <= np.array(distances)).all(axis=1)


def hull_fill(corners: Points) -> float:
    """How much of the unit cube lies within the half spaces, of many directions, that hold all corners."""
    turn = np.arange(DIRECTIONS) + 0.5
    up = 1.0 - 2.0 * turn / DIRECTIONS
    angle, level = np.pi * (1.0 + np.sqrt(5.0)) * turn, np.sqrt(1.0 - up**2)
    outward = np.column_stack((level * np.cos(angle), level * np.sin(angle), up))
    reach = (corners @ outward.T).max(axis=0)
    inside = (unit_grid() @ outward.T <= reach).all(axis=1)
    return float(inside.mean())


def distance(first: Points, second: Points) -> float:
    """Kolmogorov and Smirnov's distance of two samples: how far apart their shares below any value are."""
    values = np.concatenate((first, second))
    shares = [
        np.searchsorted(np.sort(sample), values, side="right") / len(sample) for sample in (first, second)
    ]
    return float(np.abs(shares[0] - shares[1]).max())
