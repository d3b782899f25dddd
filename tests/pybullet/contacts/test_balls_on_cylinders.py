"""Balls touch rims of cylinders where PyBullet's search ends, which is beside the nearest point."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import pybullet as p

# Radius and height of a cylinder, radius of a ball [m]; place of the ball, turn of the cylinder, whether the
# ball is made first; PyBullet's normal and distance [m]. They stay where a ball is up to 1e-11 m elsewhere.
RIMS: list[tuple[tuple[float, float, float], list[float], list[float], bool, list[float], float]] = [
    (
        (0.05, 0.1, 0.1),
        [0.151, 0.0021, -0.0727],
        [0.051, 0.676, -0.503, 0.536],
        False,
        [-0.8674013619, -0.1282014512, 0.4808110494],
        -0.000633879651,
    ),
    (
        (0.05, 0.1, 0.2),
        [-0.0529, 0.261, -0.0198],
        [0.351, 0.577, 0.719, -0.163],
        True,
        [-0.1213215889, 0.9913388438, -0.0502828885],
        -0.000634156516,
    ),
    (
        (0.05, 0.3, 0.2),
        [-0.0046, -0.0331, -0.3286],
        [-0.287, 0.863, -0.412, -0.055],
        False,
        [0.0870217137, -0.232282827, 0.9687475985],
        -0.000657934847,
    ),
    (
        (0.05, 0.3, 0.1),
        [0.0168, -0.0856, 0.2414],
        [0.067, -0.281, 0.924, -0.252],
        True,
        [0.1168702249, -0.3745433626, 0.9198144487],
        -0.000781826212,
    ),
    (
        (0.1, 0.1, 0.1),
        [-0.0797, -0.145, 0.1249],
        [0.811, -0.327, -0.263, 0.407],
        False,
        [0.2665615711, 0.6327894049, -0.7269955281],
        -0.000928359879,
    ),
    (
        (0.1, 0.3, 0.2),
        [-0.1506, -0.1311, 0.3074],
        [0.145, -0.125, -0.683, -0.705],
        True,
        [-0.4771298199, -0.541049301, 0.692540821],
        -0.00070878392,
    ),
]
# Sine of the angle between PyBullet's normal and that of the nearest point, at least.
BESIDE = 1e-6


def nearest_normal(radius: float, height: float, place: list[float], turn: list[float]) -> np.ndarray:
    """Direction from the ball's centre to the nearest point of the cylinder without its margin."""
    axes = np.array(p.getMatrixFromQuaternion(turn)).reshape(3, 3)
    local = axes.T @ place
    across = min(radius - 0.001, np.hypot(*local[:2]))
    edge = np.append(local[:2] * across / np.hypot(*local[:2]), np.clip(local[2], -height / 2, height / 2))
    away = axes @ (edge - local)
    return away / np.linalg.norm(away)


@pytest.mark.parametrize(("size", "place", "turn", "ball_first", "normal", "distance"), RIMS)
def test_balls_touch_rims_where_pybullet_finds_them(
    size: tuple[float, float, float],
    place: list[float],
    turn: list[float],
    ball_first: bool,
    normal: list[float],
    distance: float,
):
    p.connect(p.DIRECT)
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=size[2])
    cylinder = p.createCollisionShape(p.GEOM_CYLINDER, radius=size[0], height=size[1])
    bodies = [(cylinder, [0, 0, 0], turn), (ball, place, [0, 0, 0, 1])]
    for shape, position, rotation in reversed(bodies) if ball_first else bodies:
        p.createMultiBody(1, shape, -1, position, rotation)
    p.performCollisionDetection()
    (contact,) = p.getContactPoints()
    assert_allclose(contact[7], normal, atol=1e-9)
    assert_allclose(contact[8], distance, atol=1e-11)
    beside = np.cross(normal, nearest_normal(*size[:2], place, turn))
    assert np.linalg.norm(beside) > BESIDE
