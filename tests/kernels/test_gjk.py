"""Nearest points of two cores by themselves: closed forms, brute force, and what proves them nearest."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportGeneralTypeIssues=false

from __future__ import annotations

from itertools import product

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
    box,
    cores_of,
    cylinder,
    differences,
    hull_distance,
    moved,
    point,
    random_polytope,
    segment,
)

from carom.kernels.shapes.cores import Core
from carom.kernels.shapes.gjk import nearest_points
from carom.kernels.types import RealRows, Vector3, Vector3Rows, Vectors3, kernel, real
from carom.layouts.codes import BOX, CAPSULE, HULL, SPHERE

QUARTER = Rotation.from_euler("z", 45, degrees=True)
seeds = st.integers(0, 2**32 - 1)


@kernel
def nearest_points_kernel(
    a: Core,
    b: Core,
    vertex_position: Vectors3,
    start: Vector3,
    max_distance: real,
    corners: Vector3Rows,
    corners_a: Vector3Rows,
    answers: RealRows,
):
    """Distance and nearest points of two cores, and the number of corners around the origin."""
    distance, on_a, on_b, count = nearest_points(
        a, b, vertex_position, start, max_distance, corners, corners_a, 0
    )
    answers[0, 0] = distance
    answers[0, 7] = real(count)
    for axis in range(3):
        answers[0, 1 + axis] = on_a[axis]
        answers[0, 4 + axis] = on_b[axis]


def nearest(
    a: Solid, b: Solid, start: tuple[float, float, float] = (0.0, 0.0, 0.0), max_distance: float = np.inf
) -> tuple[float, np.ndarray, np.ndarray]:
    """Distance [m], and the nearest points of a and of b."""
    answers, _corners, _on_a = searched(a, b, start, max_distance)
    return answers[0], answers[1:4], answers[4:7]


def searched(
    a: Solid, b: Solid, start: tuple[float, float, float] = (0.0, 0.0, 0.0), max_distance: float = np.inf
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """All answers, and corners of the difference around the origin with their points on a."""
    answers = np.zeros((1, 8))
    rows = wp.array2d(answers, dtype=real, device="cpu", copy=False)
    corners = [wp.zeros((1, 4), dtype=Vector3, device="cpu") for _ in range(2)]
    inputs = [*cores_of(a, b), Vector3(*start), max_distance, *corners, rows]
    wp.launch(nearest_points_kernel, dim=1, inputs=inputs, device="cpu")
    return answers[0], corners[0].numpy()[0], corners[1].numpy()[0]


@pytest.mark.parametrize(
    ("a", "b", "distance", "on_a", "on_b"),
    [
        (point(), moved(point(), [3.0, 4.0, 0.0]), 5.0, [0, 0, 0], [3, 4, 0]),
        # Beside the end of a segment, and beside its middle.
        (segment(0.5), moved(point(), [0.3, 0.0, 0.9]), 0.5, [0, 0, 0.5], [0.3, 0, 0.9]),
        (segment(0.5), moved(point(), [0.3, 0.0, 0.2]), 0.3, [0, 0, 0.2], [0.3, 0, 0.2]),
        # Crossing lines.
        (
            segment(1.0),
            moved(segment(1.0), [0.2, 0.1, 0.3], Rotation.from_euler("x", 90, degrees=True)),
            0.2,
            [0, 0, 0.3],
            [0.2, 0, 0.3],
        ),
        # A face, an edge and a corner of a box.
        (box(0.1, 0.2, 0.3), moved(point(), [0.05, 0.5, -0.1]), 0.3, [0.05, 0.2, -0.1], [0.05, 0.5, -0.1]),
        (box(0.1, 0.2, 0.3), moved(point(), [0.4, 0.6, 0.1]), 0.5, [0.1, 0.2, 0.1], [0.4, 0.6, 0.1]),
        (box(0.1, 0.2, 0.3), moved(point(), [0.2, 0.4, 0.5]), 0.3, [0.1, 0.2, 0.3], [0.2, 0.4, 0.5]),
        # An edge over a face: half a diagonal nearer than a face would be.
        (
            box(1.0, 1.0, 1.0),
            moved(box(0.1, 0.1, 0.1), [1.5, 0.0, 0.0], QUARTER),
            0.5 - 0.1 * np.sqrt(2.0),
            None,
            None,
        ),
        # The side of a cylinder, its cap, and its rim.
        (cylinder(0.3, 0.5), moved(point(), [0.6, 0.8, 0.1]), 0.7, [0.18, 0.24, 0.1], [0.6, 0.8, 0.1]),
        (cylinder(0.3, 0.5), moved(point(), [0.1, 0.1, 0.9]), 0.4, [0.1, 0.1, 0.5], [0.1, 0.1, 0.9]),
        (cylinder(0.3, 0.5), moved(point(), [0.6, 0.0, 0.9]), 0.5, [0.3, 0.0, 0.5], [0.6, 0.0, 0.9]),
    ],
)
def test_closed_forms(
    a: Solid, b: Solid, distance: float, on_a: list[float] | None, on_b: list[float] | None
) -> None:
    found = nearest(a, b)
    assert found[0] == pytest.approx(distance, abs=1e-12)
    if on_a is not None and on_b is not None:
        np.testing.assert_allclose(found[1], on_a, atol=1e-7)
        np.testing.assert_allclose(found[2], on_b, atol=1e-7)


@settings(max_examples=cases(150), deadline=None)
@given(seeds, st.sampled_from(list(product(POLYTOPES, POLYTOPES))), st.floats(0.0, 1.5))
def test_distances_are_those_of_all_simplices(seed: int, kinds: tuple[int, int], apart: float) -> None:
    random = np.random.default_rng(seed)
    a, b = (random_polytope(random, kind) for kind in kinds)
    b = moved(b, random.normal(size=3) * apart, Rotation.from_quat(random.normal(size=4)))
    distance, on_a, on_b = nearest(a, b)
    expected = hull_distance(differences(a, b))
    assert distance == pytest.approx(expected, abs=1e-9)
    assert np.linalg.norm(on_a - on_b) == pytest.approx(distance, abs=1e-9)
    assert a.holds(on_a, 1e-9)
    # Where cores overlap, one point of a stands for both.
    assert distance == 0.0 or b.holds(on_b, 1e-9)


@settings(max_examples=cases(100), deadline=None)
@given(seeds, st.sampled_from(POLYTOPES))
def test_a_slab_between_the_points_parts_the_cores(seed: int, kind: int) -> None:
    random = np.random.default_rng(seed)
    a = moved(cylinder(*random.uniform(0.05, 0.3, 2)), np.zeros(3), Rotation.from_quat(random.normal(size=4)))
    b = random_polytope(random, kind)
    direction = random.normal(size=3)
    direction /= np.linalg.norm(direction)
    apart = a.farthest(direction) + b.farthest(-direction) + 0.1
    b = moved(b, direction * apart, Rotation.from_matrix(b.frame))
    distance, on_a, on_b = nearest(a, b)
    assert distance >= 0.1 - 1e-9
    assert a.holds(on_a, 1e-9)
    assert b.holds(on_b, 1e-9)
    normal = (on_b - on_a) / distance
    # No point of a is above its point, and none of b below its own: nothing else can be nearer.
    assert a.farthest(normal) <= on_a @ normal + 1e-7
    assert -b.farthest(-normal) >= on_b @ normal - 1e-7


@settings(max_examples=cases(50), deadline=None)
@given(seeds, st.sampled_from(POLYTOPES), st.sampled_from(POLYTOPES))
def test_where_the_search_starts_makes_no_difference(seed: int, kind_a: int, kind_b: int) -> None:
    random = np.random.default_rng(seed)
    a, b = random_polytope(random, kind_a), random_polytope(random, kind_b)
    b = moved(b, random.normal(size=3), Rotation.from_quat(random.normal(size=4)))
    distances = [nearest(a, b, tuple(random.normal(size=3)))[0] for _ in range(3)]
    np.testing.assert_allclose(distances, distances[0], atol=1e-10)


@settings(max_examples=cases(50), deadline=None)
@given(seeds, st.floats(0.01, 2.0))
def test_the_search_ends_where_the_cores_are_too_far_apart(seed: int, max_distance: float) -> None:
    random = np.random.default_rng(seed)
    a, b = random_polytope(random, BOX), random_polytope(random, HULL)
    b = moved(b, random.normal(size=3), Rotation.from_quat(random.normal(size=4)))
    distance = nearest(a, b)[0]
    bounded = nearest(a, b, max_distance=max_distance)[0]
    if distance > max_distance:
        assert max_distance < bounded <= distance + 1e-12
    else:
        assert bounded == distance


@settings(max_examples=cases(100), deadline=None)
@given(seeds, st.sampled_from([(BOX, BOX), (BOX, HULL), (HULL, HULL), (BOX, SPHERE), (CAPSULE, BOX)]))
def test_cores_that_overlap_are_found_to(seed: int, kinds: tuple[int, int]) -> None:
    random = np.random.default_rng(seed)
    a, b = (random_polytope(random, kind) for kind in kinds)
    # A point of each, put in the same place.
    shares = [random.dirichlet(np.ones(len(solid.corners()))) @ solid.corners() for solid in (a, b)]
    b = moved(b, shares[0] - shares[1], Rotation.from_matrix(b.frame))
    distance, on_a, on_b = nearest(a, b)
    assert distance == 0.0
    np.testing.assert_array_equal(on_a, on_b)
    answers, corners, corners_a = searched(a, b)
    if answers[7] == 4:
        # Shares of corners that add up to the origin.
        shares = np.linalg.solve(np.vstack([corners.T, np.ones(4)]), [0.0, 0.0, 0.0, 1.0])
        assert shares.min() > -1e-9
        assert all(a.holds(corner, 1e-9) for corner in corners_a)
        assert all(b.holds(on_a - corner, 1e-9) for corner, on_a in zip(corners, corners_a, strict=True))
    assert a.holds(on_a, 1e-9)
