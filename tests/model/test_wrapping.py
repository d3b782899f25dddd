"""Paths inside spheres: where they touch, and that both ways round are alike."""

from __future__ import annotations

import math

import numpy as np
import pytest

from carom import Pose
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


def crosses(a: np.ndarray, b: np.ndarray, ray: np.ndarray) -> bool:
    """Whether the way from a to b meets a ray from the origin."""
    share, distance = np.linalg.solve(np.array([a - b, ray]).T, a)
    return 0.0 < share < 1.0 and distance > 0.0


@pytest.mark.parametrize("kind", [PathKind.SPHERE, PathKind.CYLINDER])
@pytest.mark.parametrize("with_side", [False, True])
def test_a_path_goes_around_what_is_in_its_way_or_on_the_wrong_side(kind: PathKind, with_side: bool) -> None:
    random = np.random.default_rng(4)
    around = 0
    for _ in range(300):
        a, b, side = (
            random.uniform(1.05, 3.0) * RADIUS * np.array((np.cos(angle), np.sin(angle)))
            for angle in random.uniform(-np.pi, np.pi, 3)
        )
        way = a + np.linspace(0.0, 1.0, 4001)[:, None] * (b - a)
        gap = np.linalg.norm(way, axis=1).min() - RADIUS
        wrong = with_side and crosses(a, b, -side)
        if abs(gap) < 1e-6:
            continue
        found = wrapped(kind, IDENTITY, RADIUS, (*a, 0.0), (*b, 0.0), (*side, 0.0) if with_side else None)
        if found is None:
            assert gap > 0.0 and not wrong
            continue
        assert gap < 0.0 or wrong
        around += 1
        first, last = np.array(found.begin[:2]), np.array(found.end[:2])
        # It leaves along tangents, and follows the circle in between, one way round or the other.
        for end, point in ((a, first), (b, last)):
            assert np.linalg.norm(point) == pytest.approx(RADIUS)
            assert (end - point) @ point == pytest.approx(0.0, abs=1e-12)
        angle = np.arccos(np.clip(first @ last / RADIUS**2, -1.0, 1.0))
        lengths = RADIUS * np.array((angle, 2.0 * np.pi - angle))
        assert np.abs(lengths - found.length).min() < 1e-8
        if not with_side:
            assert found.length == pytest.approx(RADIUS * angle, abs=1e-8)
            assert found.length <= np.pi * RADIUS
        elif wrong and gap > 0.0:
            # The whole circle lies between the way and the site at its side: the long way round.
            assert (first + last) @ side > 0.0 or found.length > np.pi * RADIUS
    assert around > 50


@pytest.mark.parametrize("inside", [False, True])
def test_a_path_around_a_sphere_turns_with_everything(inside: bool) -> None:
    """In whatever plane its ends and the middle lie, it is the same path."""
    a, b = (0.3, 0.05, 0.0), (0.1, 0.25, 0.0) if inside else (-0.2, 0.12, 0.0)
    side = (0.0, 0.0 if inside else 0.2, 0.0)
    flat = wrapped(PathKind.SPHERE, IDENTITY, RADIUS, a, b, side)
    assert flat is not None
    for turn in np.random.default_rng(7).normal(size=(20, 4)):
        rotation = Pose((0.0, 0.0, 0.0), turn / np.linalg.norm(turn)).rotation
        ends = [tuple((rotation @ each).tolist()) for each in (a, b, side)]
        found = wrapped(PathKind.SPHERE, IDENTITY, RADIUS, *ends)  # type: ignore[arg-type]
        assert found is not None
        assert found.length == pytest.approx(flat.length, abs=1e-9)
        assert found.begin == pytest.approx((rotation @ flat.begin).tolist(), abs=1e-9)
        assert found.end == pytest.approx((rotation @ flat.end).tolist(), abs=1e-9)
