"""The choice of the four contact points that are kept, by itself: closed forms, and the rule in NumPy."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportArgumentType=false

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp

from carom.engine.detection_capacity import CANDIDATES
from carom.kernels.contact.candidates import flip_candidates, keep_four
from carom.kernels.structs import Candidate, CandidateRows
from carom.kernels.types import Int32, Ints, kernel

UP = (0.0, 0.0, 1.0)


@kernel
def keep_four_kernel(candidates: CandidateRows, count: Int32, kept: Ints):
    """Choose four."""
    kept[0] = keep_four(candidates, 0, count)


@kernel
def flip_candidates_kernel(candidates: CandidateRows, count: Int32):
    """Exchange the two shapes."""
    flip_candidates(candidates, 0, count)


def rows_of(points: np.ndarray, distances: np.ndarray) -> np.ndarray:
    rows = np.zeros((1, CANDIDATES), Candidate.numpy_dtype())
    rows["point"][0, : len(points)] = points
    rows["normal"][0, : len(points)] = UP
    rows["distance"][0, : len(points)] = distances
    return rows


def kept(points: np.ndarray, distances: np.ndarray | float = -0.01) -> np.ndarray:
    """The points that are kept, in their order (n, 3)."""
    rows = rows_of(points, np.broadcast_to(distances, len(points)))
    candidates = wp.array(rows, dtype=Candidate, device="cpu", copy=True)
    count = wp.zeros(1, dtype=Int32, device="cpu")
    wp.launch(keep_four_kernel, dim=1, inputs=[candidates, len(points), count], device="cpu")
    left = candidates.numpy()[0, : len(points)]
    # They change places, and nothing else about them changes.
    assert {row.tobytes() for row in left} == {row.tobytes() for row in rows[0, : len(points)]}
    return left["point"][: count.numpy()[0]]


def chosen(points: np.ndarray, distances: np.ndarray) -> list[np.ndarray]:
    """The same rule, written down once more: deepest, farthest, farthest from the line, farthest outside."""
    a = points[np.argmin(distances)]
    b = points[np.argmax(np.linalg.norm(points - a, axis=1))]
    along = (b - a) / np.linalg.norm(b - a)
    beside = points - a - ((points - a) @ along)[:, None] * along
    c = points[np.argmax(np.linalg.norm(beside, axis=1))]
    normal = np.cross(b - a, c - a)
    # Height outside each side times its length: how much the area of the polygon grows.
    gains = [np.cross(points - p, q - p) @ normal for p, q in ((a, b), (b, c), (c, a))]
    most = np.max(gains, axis=0)
    result = [a, b, c]
    if most.max() > 1e-9:
        result.append(points[np.argmax(most)])
    return result


@settings(max_examples=cases(200), deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(4, CANDIDATES))
def test_the_rule(seed: int, count: int) -> None:
    random = np.random.default_rng(seed)
    points = np.column_stack([random.normal(size=(count, 2)), np.zeros(count)])
    distances = -random.permutation(count) * 1e-3
    np.testing.assert_array_equal(kept(points, distances), chosen(points, distances))


def test_of_a_grid_the_corners_are_left() -> None:
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, 4), np.linspace(-0.5, 0.5, 4))
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(16)])
    assert {tuple(abs(point)) for point in kept(points)} == {(1.0, 0.5, 0.0)}
    assert len(np.unique(kept(points), axis=0)) == 4


def test_the_deepest_is_the_first() -> None:
    random = np.random.default_rng(3)
    points = random.uniform(-1.0, 1.0, (12, 3)) * (1.0, 1.0, 0.0)
    for deepest in range(12):
        distances = np.where(np.arange(12) == deepest, -0.02, -0.01)
        np.testing.assert_array_equal(kept(points, distances)[0], points[deepest])


def test_of_those_equally_deep_the_outermost_is_the_first_and_of_these_the_first() -> None:
    points = np.array(
        [[0.1, 0.0, 0.0], [0.5, 0.0, 0.0], [-0.5, 0.0, 0.0], [0.0, 0.2, 0.0], [-0.1, -0.2, 0.0]]
    )
    np.testing.assert_array_equal(kept(points - [0.0, 0.0, 1.0])[0], [0.5, 0.0, -1.0])
    # A difference less than rounding makes does not count.
    np.testing.assert_array_equal(kept(points, [-0.01 - 1e-9, *[-0.01] * 4])[0], [0.5, 0.0, 0.0])
    np.testing.assert_array_equal(kept(points, [-0.01 - 1e-6, *[-0.01] * 4])[0], [0.1, 0.0, 0.0])


@pytest.mark.parametrize(
    ("points", "count"),
    [
        ([[1.0, 2.0, 3.0]], 1),
        ([[1.0, 2.0, 3.0]] * 5, 1),
        # As near as a micrometre.
        ([[1.0, 2.0, 3.0], [1.0 + 9e-7, 2.0, 3.0]], 1),
        ([[1.0, 2.0, 3.0], [1.0 + 2e-6, 2.0, 3.0]], 2),
        # On a line.
        ([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0], [3.0, 3.0, 0.0]], 2),
        # In a triangle.
        ([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.2, 0.0]], 3),
        ([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.9, 0.9, 0.0]], 4),
    ],
)
def test_no_point_is_kept_that_spans_nothing(points: list[list[float]], count: int) -> None:
    assert len(kept(np.array(points))) == count


def test_exchanging_the_shapes_moves_points_to_the_other() -> None:
    random = np.random.default_rng(4)
    rows = rows_of(random.normal(size=(5, 3)), random.normal(size=5))
    candidates = wp.array(rows, dtype=Candidate, device="cpu", copy=True)
    wp.launch(flip_candidates_kernel, dim=1, inputs=[candidates, 5], device="cpu")
    flipped = candidates.numpy()[0, :5]
    before = rows[0, :5]
    np.testing.assert_allclose(flipped["point"], before["point"] + before["distance"][:, None] * UP)
    np.testing.assert_array_equal(flipped["normal"], -before["normal"])
    np.testing.assert_array_equal(flipped["distance"], before["distance"])
