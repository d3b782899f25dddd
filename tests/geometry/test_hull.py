"""Convex hulls against SciPy's, and where they have to be robust."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.spatial import ConvexHull as Reference
from tests.geometry.hull_reference import reference_loops
from tests.thorough.profiles import cases

from carom.description import ConvexHull as Geometry
from carom.geometry import hull
from carom.geometry.hull import LARGEST, SMALLEST, THICKEST_SLAB, convex_hull, extreme_points
from carom.geometry.polyhedron import Polyhedron
from carom.model.shape_pieces import shape_pieces

CUBE = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])


def assert_is_closed_convex(solid: Polyhedron, points: np.ndarray, outside: float) -> None:
    """Faces close around a solid that no vertex and hardly a point is outside of."""
    size = np.ptp(points, axis=0).max() + 2 * THICKEST_SLAB
    heights = solid.vertices @ solid.planes[:, :3].T - solid.planes[:, 3]
    assert heights.max() <= 2e-5 * size
    assert (points @ solid.planes[:, :3].T - solid.planes[:, 3]).max() <= outside
    edges = []
    for first, count in zip(solid.first_corner, solid.corner_count, strict=True):
        loop = solid.corners[first : first + count].tolist()
        assert len(set(loop)) == count >= 3
        edges += list(zip(loop, [*loop[1:], loop[0]], strict=True))
    assert len(edges) == len(set(edges))
    assert {(end, start) for start, end in edges} == set(edges)
    assert len(solid.vertices) - len(edges) // 2 + len(solid.planes) == 2
    np.testing.assert_allclose(np.linalg.norm(solid.planes[:, :3], axis=1), 1.0, rtol=1e-12)


@pytest.mark.parametrize("size", [1e-3, 1.0, 50.0, 1e3, 1e6, 1e14, 1e60])
@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_flat_sets_of_any_size_have_a_slab(size: float, count: int) -> None:
    points = size * np.array([[0.0, 0.0, 0.0], [1.0, 0.3, 0.2], [-0.2, 1.0, 0.4], [0.8, 1.3, 0.6]])[:count]
    solid = convex_hull(points)
    assert_is_closed_convex(solid, points, 1e-5 * size)
    assert len(solid.vertices) == {1: 8, 2: 8, 3: 6, 4: 8}[count]


def volume(solid: Polyhedron) -> float:
    total = 0.0
    for first, count in zip(solid.first_corner, solid.corner_count, strict=True):
        corners = solid.vertices[solid.corners[first : first + count]]
        for i in range(1, count - 1):
            total += float(np.linalg.det(corners[[0, i, i + 1]]))
    return total / 6.0


coordinates = st.floats(-100.0, 100.0, width=32)
clouds = hnp.arrays(np.float64, st.tuples(st.integers(1, 40), st.just(3)), elements=coordinates)
# Few different coordinates make many coincident, collinear and coplanar points.
lattices = hnp.arrays(
    np.float64, st.tuples(st.integers(1, 60), st.just(3)), elements=st.integers(0, 3).map(float)
)


@settings(max_examples=cases(150), deadline=None)
@given(st.one_of(clouds, lattices))
def test_any_points_have_a_closed_hull_around_them(points: np.ndarray) -> None:
    solid = convex_hull(points)
    size = np.ptp(points, axis=0).max()
    assert_is_closed_convex(solid, points, 2e-5 * size)


@settings(max_examples=cases(100), deadline=None)
@given(st.integers(0, 10_000), st.integers(5, 200))
def test_hulls_have_the_corners_and_the_volume_scipy_finds(seed: int, count: int) -> None:
    points = np.random.default_rng(seed).normal(size=(count, 3))
    reference = Reference(points)
    solid = convex_hull(points)
    assert {tuple(row) for row in extreme_points(points)} <= {tuple(row) for row in points}
    assert volume(solid) == pytest.approx(reference.volume, rel=1e-4)
    ours = {tuple(np.round(row, 9)) for row in solid.vertices}
    theirs = {tuple(np.round(points[index], 9)) for index in reference.vertices}
    assert ours <= theirs
    # Corners that stand out by less than the tolerance may be missing.
    assert len(theirs - ours) <= 1


@settings(max_examples=cases(60), deadline=None)
@given(lattices)
def test_lattices_have_the_volume_scipy_finds(points: np.ndarray) -> None:
    if np.linalg.matrix_rank(points - points[0]) < 3:
        return
    assert volume(convex_hull(points)) == pytest.approx(Reference(points).volume, rel=1e-9)


@pytest.mark.parametrize("rotation_seed", [None, 1, 2])
def test_a_grid_in_a_cube_has_the_cube_as_hull(rotation_seed: int | None) -> None:
    ticks = np.linspace(-1.0, 1.0, 9)
    grid = np.stack(np.meshgrid(ticks, ticks, ticks), axis=-1).reshape(-1, 3)
    if rotation_seed is not None:
        grid = grid @ np.linalg.qr(np.random.default_rng(rotation_seed).normal(size=(3, 3)))[0]
        # As read from a file.
        grid = grid.astype(np.float32).astype(np.float64) + 3.0
    solid = convex_hull(grid)
    assert (len(solid.vertices), len(solid.planes)) == (8, 6)
    assert set(solid.corner_count.tolist()) == {4}
    assert volume(solid) == pytest.approx(8.0, rel=1e-6)


def test_a_drum_has_two_polygons_and_a_ring_of_quads() -> None:
    angles = np.arange(32) * np.pi / 16
    rim = np.column_stack([np.sin(angles), np.cos(angles)])
    points = np.concatenate([np.column_stack([rim, np.full(32, z)]) for z in (-0.5, 0.5)])
    solid = convex_hull(points)
    assert sorted(solid.corner_count.tolist()) == [4] * 32 + [32] * 2
    assert_is_closed_convex(solid, points, 1e-12)


@pytest.mark.parametrize(
    ("points", "extent"),
    [
        pytest.param([(1.0, 2.0, 3.0)] * 3, (0.0, 0.0, 0.0), id="one point"),
        pytest.param([(0.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 1.0, 0.0)], (0.0, 2.0, 0.0), id="a line"),
        pytest.param(CUBE * (1.0, 0.0, 1.0), (2.0, 0.0, 2.0), id="a square"),
    ],
)
def test_what_has_no_volume_becomes_a_thin_slab(points: object, extent: tuple[float, float, float]) -> None:
    rows = np.array(points)
    solid = convex_hull(rows)
    assert_is_closed_convex(solid, rows, 0.0)
    low, high = solid.bounds()
    thickness = 2 * THICKEST_SLAB
    expected = [side if side else thickness for side in extent]
    np.testing.assert_allclose(high - low, expected, rtol=1e-9)


@pytest.mark.parametrize("size", [5.0 * SMALLEST, 0.1 * LARGEST])
@pytest.mark.parametrize("thickness", [1.0, 1e-3, 1e-5, 0.0])
def test_the_smallest_and_the_largest_hulls_have_faces(size: float, thickness: float) -> None:
    points = np.random.default_rng(4).normal(size=(40, 3)) * size * (1.0, 1.0, thickness)
    assert_is_closed_convex(convex_hull(points), points, 1e-5 * size)


def test_points_nearer_to_each_other_are_one_and_farther_ones_are_refused() -> None:
    low, high = convex_hull(0.9 * SMALLEST * CUBE).bounds()
    np.testing.assert_allclose(high - low, 2 * THICKEST_SLAB, rtol=1e-9)
    with pytest.raises(ValueError, match="too far apart"):
        convex_hull(LARGEST * CUBE)


def test_corners_of_a_flat_shape_are_those_of_its_outline() -> None:
    square = [(0.0, 0.0, 1.0), (2.0, 0.0, 1.0), (2.0, 2.0, 1.0), (0.0, 2.0, 1.0)]
    points = np.array([*square, (1.0, 1.0, 1.0), (1.0, 0.0, 1.0)])
    assert {tuple(row) for row in extreme_points(points)} == set(square)


@pytest.mark.parametrize("most", [4, 16, 64, 128])
def test_simplified_hulls_lie_inside_and_not_far_inside(most: int) -> None:
    ball = np.random.default_rng(3).normal(size=(4000, 3))
    ball /= np.linalg.norm(ball, axis=1, keepdims=True)
    solid = convex_hull(ball, most_vertices=most)
    assert len(solid.vertices) <= most
    # Vertices spread evenly over a ball leave caps of about 4 / n of its radius uncovered.
    depth = float((ball @ solid.planes[:, :3].T - solid.planes[:, 3]).max())
    assert_is_closed_convex(solid, ball, min(1.0, 5.0 / most) if most > 4 else 1.0)
    assert depth > 0.0


def test_a_tolerance_bounds_what_is_left_out() -> None:
    ball = np.random.default_rng(4).normal(size=(3000, 3))
    ball /= np.linalg.norm(ball, axis=1, keepdims=True)
    size = np.abs(ball - 0.5 * (ball.min(axis=0) + ball.max(axis=0))).max()
    solid = convex_hull(ball, tolerance=0.02)
    assert_is_closed_convex(solid, ball, 0.02 * size + 2e-5)
    assert len(solid.vertices) < 400


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_size_and_place_do_not_matter(scale: float) -> None:
    points = np.random.default_rng(5).normal(size=(200, 3))
    plain = convex_hull(points)
    moved = convex_hull(points * scale + 10.0 * scale)
    assert len(moved.vertices) == len(plain.vertices)
    np.testing.assert_allclose(moved.vertices, plain.vertices * scale + 10.0 * scale, rtol=1e-9)


@pytest.mark.parametrize("bad", [np.empty((0, 3)), [(0.0, 0.0, np.nan)], [(np.inf, 0.0, 0.0)]])
def test_no_points_and_points_that_are_none_are_refused(bad: object) -> None:
    with pytest.raises(ValueError, match="point"):
        convex_hull(np.array(bad))


def assert_as_in_plain_python(points: np.ndarray, tolerance: float, most: int | None) -> None:
    """The native loops give the very same corners, in the same order."""
    _, centred, corners, counts = hull._hull_loops(points, tolerance, most)
    size = float(np.abs(centred).max())
    first = hull.first_corners(centred, 0.0 if len(centred) != len(points) else hull.FLAT * size)
    expected = reference_loops(centred, first, size, tolerance, most)
    assert np.split(corners, np.cumsum(counts)[:-1])[0].tolist() == expected[0]
    assert [it.tolist() for it in np.split(corners, np.cumsum(counts)[:-1])] == expected


@settings(max_examples=cases(60), deadline=None)
@given(st.one_of(clouds, lattices), st.sampled_from([(1e-4, 512), (1e-7, None), (0.0, 8)]))
def test_native_hulls_are_those_of_plain_python(points: np.ndarray, limits: tuple[float, int | None]) -> None:
    assert_as_in_plain_python(points, *limits)


def test_large_native_hulls_are_those_of_plain_python() -> None:
    random = np.random.default_rng(3)
    ball = random.normal(size=(900, 3))
    ball /= np.linalg.norm(ball, axis=1, keepdims=True)
    for tolerance, most in ((1e-4, 512), (1e-7, None), (0.0, 40)):
        assert_as_in_plain_python(ball, tolerance, most)


def test_the_same_points_are_hulled_once() -> None:
    points = np.random.default_rng(5).normal(size=(60, 3))
    made = shape_pieces(Geometry(points), implicit_cylinder=True)
    again = shape_pieces(Geometry(points.copy()), implicit_cylinder=True)
    assert made[0] is again[0]
    moved = shape_pieces(Geometry(points + 1e-12), implicit_cylinder=True)
    assert moved[0] is not made[0]
