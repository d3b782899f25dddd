"""Points on ellipsoids, whose hull collides."""

from __future__ import annotations

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
    for ring in range(1, _RINGS + 1):
        height = pi * ring / (_RINGS + 1)
        for sector in range(_SECTORS):
            angle = 2.0 * pi * (sector + 0.5 * (ring % 2)) / _SECTORS
            across = sin(height)
            points.append(
                (axes[0] * across * cos(angle), axes[1] * across * sin(angle), axes[2] * cos(height))
            )
    return np.array(points)


def ellipsoid_surface(axes: Vector3) -> TriangleMesh:
    """The surface of an ellipsoid with these half axes, with smooth normals and texture coordinates."""
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
    unit = np.array(points)
    return TriangleMesh(
        unit * axes,
        np.array(triangles, dtype=np.int32),
        normals=unit / axes,
        uvs=np.array(uvs),
    )
