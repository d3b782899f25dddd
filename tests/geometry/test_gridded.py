"""Hulls that one call of the library makes are, bit by bit, those that are put together in Python."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.geometry.test_hull import clouds, lattices
from tests.thorough.profiles import cases

from carom.geometry import gridded, hull
from carom.geometry.gridded import hull_on_grid
from carom.geometry.polyhedron import Polyhedron
from carom.native.library import library

TOLERANCE, MOST = 1e-4, 512


def contents(solid: Polyhedron) -> list[tuple[str, tuple[int, ...], bytes]]:
    arrays = (solid.vertices, solid.planes, solid.first_corner, solid.corner_count, solid.corners)
    return [(it.dtype.str, it.shape, it.tobytes()) for it in arrays]


def in_python(points: np.ndarray, uses: np.ndarray | None, most: int | None = MOST) -> Polyhedron:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hull, "hull_on_grid", lambda *_: None)
        return hull.gridded_hull(points, uses, tolerance=TOLERANCE, most_vertices=most)


def assert_same(points: np.ndarray, uses: np.ndarray | None, most: int = MOST) -> None:
    made = hull_on_grid(points, uses, TOLERANCE, most)
    assert made is not None
    assert contents(made) == contents(in_python(points, uses, most))


def spread(points: np.ndarray) -> bool:
    """Whether points span a volume, as the grid of each axis needs an extent."""
    centred = points - 0.5 * (points.min(axis=0) + points.max(axis=0))
    return len(gridded.first_corners(centred, gridded.FLAT * float(np.abs(centred).max()))) == 4


@settings(max_examples=cases(150), deadline=None)
@given(points=st.one_of(clouds, lattices), seed=st.integers(0, 9), most=st.sampled_from([4, 7, MOST]))
def test_hulls_are_those_of_python(points: np.ndarray, seed: int, most: int) -> None:
    if (np.ptp(points, axis=0) > 0.0).all() and spread(points):
        uses = np.random.default_rng(seed).integers(1, 6, len(points)).astype(np.int32)
        assert_same(points, None if seed == 0 else uses, most)


@pytest.mark.parametrize("count", [300, 3000])
def test_round_hulls_are_those_of_python(count: int) -> None:
    """They have more corners than there is room for at first, and corners that share a cell."""
    points = np.random.default_rng(count).normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    assert_same(np.concatenate([points, points + 1e-6]), None)


@pytest.mark.parametrize("stretch", [(1, 2, 3), (3, 2, 1), (2, 3, 1), (1, 1, 1), (2, 2, 1), (1, 3, 3)])
def test_the_order_of_axes_is_that_of_python(stretch: tuple[int, int, int]) -> None:
    points = np.random.default_rng(5).normal(size=(80, 3))
    points = np.clip(points, -1.0, 1.0) * np.array(stretch)
    assert_same(points, None)


def test_flat_and_broken_points_are_left_to_python() -> None:
    square = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 0.0]])
    for points in (square, square * 1e71, square * np.nan, square[:1]):
        assert hull_on_grid(points, None, TOLERANCE, MOST) is None
    assert len(hull.gridded_hull(square, None, tolerance=TOLERANCE, most_vertices=MOST).vertices) == 8


def test_a_hull_gets_more_room(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where memory for what vanishes on the way is not enough, it is made again with more."""
    points = np.random.default_rng(2).normal(size=(200, 3))
    expected = contents(in_python(points, None))
    symbols, factors = library().symbols, []

    class Counted:
        """The function, which says once that there is no room."""

        def __call__(self, *arguments: object) -> int:
            factors.append(arguments[2][3])  # type: ignore[index]
            return 1 if len(factors) == 1 else symbols["carom_gridded_hull"](*arguments)

    own = {"carom_gridded_bytes": symbols["carom_gridded_bytes"], "carom_gridded_hull": Counted()}
    monkeypatch.setattr(gridded, "library", lambda: SimpleNamespace(symbols=own))
    made = hull_on_grid(points, None, TOLERANCE, MOST)
    assert made is not None
    assert contents(made) == expected
    assert factors == [1, 2]
