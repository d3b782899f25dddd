"""Bullet's search for nearest points by itself: the point of a simplex, and of two cores."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportGeneralTypeIssues=false

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp
from scipy.spatial.transform import Rotation
from tests.kernels.convex_cores import (
    POLYTOPES,
    Solid,
    cores_of,
    differences,
    hull_distance,
    moved,
    point,
    random_polytope,
    segment,
)

from carom.kernels.shapes.bullet_gjk import FAILED, FLAT, FOUND, TOO_FAR, nearest_as_in_bullet, nearest_on
from carom.kernels.shapes.cores import Core
from carom.kernels.types import Int32, Matrix43, RealRows, Vectors3, kernel, real


@kernel
def nearest_on_kernel(simplex: Matrix43, count: Int32, answers: RealRows):
    """Weights, bits and position of the nearest point of a simplex."""
    found = nearest_on(simplex, count)
    for i in range(4):
        answers[0, i] = found.weights[i]
    answers[0, 4] = real(found.used)
    for axis in range(3):
        answers[0, 5 + axis] = found.point[axis]


@kernel
def nearest_as_in_bullet_kernel(
    a: Core, b: Core, vertex_position: Vectors3, max_distance: real, answers: RealRows
):
    """Outcome, distance, normal and nearest point on b of two cores."""
    outcome, distance, normal, on_b = nearest_as_in_bullet(a, b, vertex_position, max_distance)
    answers[0, 0] = real(outcome)
    answers[0, 1] = distance
    for axis in range(3):
        answers[0, 2 + axis] = normal[axis]
        answers[0, 5 + axis] = on_b[axis]


def answers_of(kernel: Any, *arguments: object) -> np.ndarray:
    """The eight numbers that a kernel answers."""
    answers = np.zeros((1, 8))
    rows = wp.array2d(answers, dtype=real, device="cpu", copy=False)
    wp.launch(kernel, dim=1, inputs=[*arguments, rows], device="cpu")
    return answers[0]


def nearest(a: Solid, b: Solid, max_distance: float = 10.0) -> tuple[int, float, np.ndarray, np.ndarray]:
    """Outcome, distance [m], normal and the nearest point of b."""
    found = answers_of(nearest_as_in_bullet_kernel, *cores_of(a, b), max_distance)
    return int(found[0]), found[1], found[2:5], found[5:]


@settings(max_examples=cases(300), deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 4))
def test_the_nearest_point_of_a_simplex_is_made_of_the_corners_it_names(seed: int, count: int) -> None:
    random = np.random.default_rng(seed)
    corners = np.zeros((4, 3))
    corners[:count] = random.normal(size=(count, 3)) + random.normal(size=3)
    found = answers_of(nearest_on_kernel, Matrix43(*corners.ravel()), count)
    weights, used, nearest_point = found[:4], int(found[4]), found[5:]
    expected = hull_distance(corners[:count])
    if expected == 0.0:
        assert used == 0
        return
    assert np.linalg.norm(nearest_point) == pytest.approx(expected, abs=1e-9)
    np.testing.assert_allclose(weights @ corners, nearest_point, atol=1e-9)
    assert weights.sum() == pytest.approx(1.0)
    assert [used >> i & 1 for i in range(4)] == [int(weight > 0.0) for weight in weights]


def test_a_flat_tetrahedron_is_called_flat() -> None:
    corners = np.array([[1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0 + 1e-9]])
    assert answers_of(nearest_on_kernel, Matrix43(*corners.ravel()), 4)[4] == FLAT


@pytest.mark.parametrize("kinds", list(product(POLYTOPES, POLYTOPES)))
def test_nearest_points_of_cores_are_found_almost_always(kinds: tuple[int, int]) -> None:
    random = np.random.default_rng(5)
    failed = 0
    for _ in range(20):
        a, b = (random_polytope(random, kind) for kind in kinds)
        direction = random.normal(size=3)
        direction /= np.linalg.norm(direction)
        apart = a.farthest(direction) + b.farthest(-direction) + random.uniform(0.01, 0.3)
        b = moved(b, direction * apart, Rotation.from_matrix(b.frame))
        expected = hull_distance(differences(a, b))
        outcome, distance, normal, on_b = nearest(a, b)
        if outcome == FAILED:
            failed += 1
            continue
        assert outcome == FOUND
        assert distance == pytest.approx(expected, abs=1e-6)
        assert b.holds(on_b, 1e-6)
        assert a.holds(on_b + distance * normal, 1e-5)
    assert failed <= 1


def test_points_on_segments_are_found_by_their_shares() -> None:
    b = moved(segment(0.5), [0.3, 0.0, 0.4])
    outcome, distance, normal, on_b = nearest(point(), b)
    assert (outcome, distance) == (FOUND, pytest.approx(0.3))
    np.testing.assert_allclose(normal, [-1.0, 0.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(on_b, [0.3, 0.0, 0.0], atol=1e-9)


def test_cores_are_too_far_or_touch() -> None:
    apart = moved(point(), [0.5, 0.0, 0.0])
    assert nearest(point(), apart, 0.499)[0] == TOO_FAR
    assert nearest(point(), apart, 0.501)[:2] == (FOUND, pytest.approx(0.5))
    assert nearest(segment(0.5), point())[0] == FAILED
