"""Points on ellipsoids, whose hull collides."""

from __future__ import annotations

from functools import cache
from math import pi

import numpy as np
from numpy.typing import NDArray

from carom.description import TriangleMesh
from carom.description.pose import Vector3
from carom.native.trigonometry import cos, sin

_RINGS, _SECTORS = 9, 16
_SEEN_RINGS, _SEEN_SECTORS = 24, 48


def ellipsoid_points(axes: Vector3) -> NDArray[np.float64]:
    """Points (n, 3) on an ellipsoid with these half axes: rings of latitude and the poles."""
    points = [(0.0, 0.0, axes[2]), (0.0, 0.0, -axes[2])]
    for across, cosine, sine, height in _rings():
        points.append((axes[0] * across * cosine, axes[1] * across * sine, axes[2] * height))
    return np.array(points)


def ellipsoid_surface(axes: Vector3) -> TriangleMesh:
    """The surface of an ellipsoid with these half axes, with smooth normals and texture coordinates."""
    unit, triangles, uvs = _sphere()
    return TriangleMesh(unit * axes, triangles, normals=unit / axes, uvs=uvs)


@cache
def _rings() -> list[tuple[float, float, float, float]]:
    """Of the points of a unit sphere without the poles: radius of the ring, cosine, sine, and height."""
    found = []
    for ring in range(1, _RINGS + 1):
        polar = pi * ring / (_RINGS + 1)
        for sector in range(_SECTORS):
            angle = 2.0 * pi * (sector + 0.5 * (ring % 2)) / _SECTORS
            found.append((sin(polar), cos(angle), sin(angle), cos(polar)))
    return found


@cache
def _sphere() -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.float64]]:
    """Points of a unit sphere, triangles and texture coordinates."""
    points, uvs = [], []
    for ring in range(_SEEN_RINGS + 1):
        height = pi * ring / _SEEN_RINGS
        for sector in range(_SEEN_SECTORS + 1):
            angle = 2.0 * pi * sector / _SEEN_SECTORS
            points.append((sin(height) * cos(angle), sin(height) * sin(angle), -cos(height)))
            uvs.append((sector / _SEEN_SECTORS, ring / _SEEN_RINGS))
    triangles = []
    row = _SEEN_SECTORS + 1
    for ring in range(_SEEN_RINGS):
        for sector in range(_SEEN_SECTORS):
            here = ring * row + sector
            # At the poles one triangle of each two has no area.
            if ring > 0:
                triangles.append((here, here + 1, here + row + 1))
            if ring < _SEEN_RINGS - 1:
                triangles.append((here, here + row + 1, here + row))
    made = np.array(points), np.array(triangles, dtype=np.int32), np.array(uvs)
    for array in made:
        array.setflags(write=False)
    return made
