"""Paths inside spheres: where they touch, and that both ways round are alike."""

from __future__ import annotations

import math

import numpy as np
import pytest

from carom.description.pose import IDENTITY
from carom.description.wrapping import wrapped
from carom.layouts.codes import PathKind

RADIUS = 0.1


def touch(a: tuple[float, float], b: tuple[float, float]) -> np.ndarray:
    """Where a path from a to b, held inside a sphere at the origin, touches it."""
    found = wrapped(PathKind.SPHERE, IDENTITY, RADIUS, (*a, 0.0), (*b, 0.0), (0.0, 0.0, 0.0))
    assert found is not None
    assert found.length == 0.0
    assert found.begin == pytest.approx(found.end, abs=1e-12)
    return np.array(found.begin)


@pytest.mark.parametrize("bend", [0.6, 1.3, 2.2, -0.6, -1.3, -2.2])
def test_a_path_inside_touches_where_it_is_shortest(bend: float) -> None:
    a = (0.3, 0.05)
    b = (0.25 * math.cos(bend), 0.25 * math.sin(bend))
    point = touch(a, b)
    assert np.linalg.norm(point) == pytest.approx(RADIUS, rel=1e-9)
    # Both halves make the same angle with the surface there, as light does in a mirror.
    normal = point / RADIUS
    ways = [np.array([*end, 0.0]) - point for end in (a, b)]
    slopes = [float(way @ normal) / float(np.linalg.norm(way)) for way in ways]
    assert slopes[0] == pytest.approx(slopes[1], abs=1e-6)
    # Backwards it is the same path, and its mirror image that of mirrored ends.
    assert touch(b, a) == pytest.approx(point, abs=1e-9)
    assert touch((a[0], -a[1]), (b[0], -b[1])) == pytest.approx(point * [1, -1, 1], abs=1e-9)
