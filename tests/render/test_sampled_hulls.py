"""The hulls that PyBullet draws for capsules and cylinders."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from carom.render.sampled_hull import sampled_hull


def volume(points: np.ndarray, triangles: np.ndarray) -> float:
    """Six tetrahedra fill a parallelepiped; positive if triangles are counter-clockwise seen from outside."""
    return float(np.linalg.det(points[triangles]).sum() / 6.0)


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.2])
def test_a_box_has_twelve_triangles_seen_from_outside(turn: float) -> None:
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-2, 2) for z in (-3, 3)], float)
    c, s = np.cos(turn), np.sin(turn)
    corners = corners @ np.array([(c, -s, 0), (s, c, 0), (0, 0, 1)]) + (0.1, 0.2, 0.3)
    points, triangles = sampled_hull(np.concatenate([corners, [(0.1, 0.2, 0.3)]]))
    assert len(triangles) == 12
    assert volume(points, np.array(triangles)) == pytest.approx(2 * 4 * 6)


def test_points_of_a_ball_are_corners_of_a_closed_surface() -> None:
    points = np.random.default_rng(0).normal(size=(40, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    corners, triangles = sampled_hull(points)
    used = np.unique(triangles)
    # Points may be left out that are hardly outside.
    assert len(used) >= 36
    assert len(triangles) == 2 * len(used) - 4
    assert 2.5 < volume(corners, np.array(triangles)) < 4.0 / 3.0 * np.pi


@pytest.mark.parametrize("seed", range(20))
def test_hulls_of_few_points_anywhere_have_their_volume(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(8, 3)) * rng.uniform(0.3, 2.0, 3) + 10.0 * rng.normal(size=3)
    corners, triangles = sampled_hull(points)
    # Points may be left out that are hardly outside.
    assert volume(corners - corners.mean(axis=0), np.array(triangles)) == pytest.approx(
        ConvexHull(points).volume, rel=0.02
    )
