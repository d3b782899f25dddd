"""Points on ellipsoids, whose hull collides."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray

from carom.description.pose import Vector3
from carom.native.trigonometry import cos, sin

_RINGS, _SECTORS = 9, 16


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
