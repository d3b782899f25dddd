"""Triangles of surfaces, from which pictures of shapes are made."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom.native.trigonometry import cos, sin


class Surface(NamedTuple):
    """Triangles of a surface.

    Attributes:
        positions: (n, 3) [m].
        normals: (n, 3) of unit length, outward.
        uvs: (n, 2) texture coordinates.
        triangles: (m, 3) indices of vertices, counter-clockwise seen from outside.
    """

    positions: NDArray[np.floating]
    normals: NDArray[np.floating]
    uvs: NDArray[np.floating]
    triangles: NDArray[np.integer]

    def ready(self) -> Surface:
        """The same as it is drawn, in single precision."""
        return Surface(
            np.array(self.positions, dtype=np.float32).reshape(-1, 3),
            np.array(self.normals, dtype=np.float32).reshape(-1, 3),
            np.array(self.uvs, dtype=np.float32).reshape(-1, 2),
            np.array(self.triangles, dtype=np.int32).reshape(-1, 3),
        )

    def moved(self, positions: NDArray[np.floating]) -> Surface:
        """The same with other positions, in single precision."""
        return Surface(positions.astype(np.float32), self.normals, self.uvs, self.triangles)


@functools.cache
def circle(segments: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points (segments + 1, 2) around a circle of radius 1, and the fraction of the full turn at each."""
    turn = np.linspace(0.0, 1.0, segments + 1)
    angles = (2.0 * np.pi * turn).tolist()
    return np.array([(cos(angle), sin(angle)) for angle in angles]), turn


def band(lower: int, segments: int) -> NDArray[np.int64]:
    """Triangles (2 segments, 3) between a ring, given by its first vertex, and the next ring."""
    upper = lower + segments + 1
    i = np.arange(segments)
    first = np.stack([lower + i, lower + i + 1, upper + i], axis=1)
    second = np.stack([lower + i + 1, upper + i + 1, upper + i], axis=1)
    return np.stack([first, second], axis=1).reshape(-1, 3)


def ball_between(radius: float, length: float, segments: int) -> Surface:
    """A sphere if `length` is 0, else a capsule whose half-spheres are `length` apart along z."""
    ring, turn = circle(segments)
    # Number of bands of triangles from pole to pole: even, so that a capsule can be cut at the equator.
    rings = segments // 2
    # Latitudes from the lower pole to the upper one; a capsule has the equator twice.
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, rings + 1)
    halves = np.where(angles < 0.0, -0.5, 0.5) * length
    if length > 0.0:
        middle = rings // 2
        angles = np.insert(angles, middle, 0.0)
        halves = np.insert(halves, middle, -0.5 * length)
    positions, normals, uvs = [], [], []
    for angle, shift in zip(angles, halves, strict=True):
        normal = np.column_stack([cos(angle) * ring, np.full(segments + 1, sin(angle))])
        normals.append(normal)
        positions.append(radius * normal + (0.0, 0.0, shift))
        uvs.append(np.column_stack([turn, np.full(segments + 1, angle / np.pi + 0.5)]))
    row = segments + 1
    bands = [band(i * row, segments) for i in range(len(angles) - 1)]
    # At the poles half of the triangles of a band have no area and are left out.
    bands[0], bands[-1] = bands[0][1::2], bands[-1][::2]
    points, outward, coordinates = (np.concatenate(parts) for parts in (positions, normals, uvs))
    return Surface(points, outward, coordinates, np.concatenate(bands)).ready()
