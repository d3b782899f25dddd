"""The random objects to grasp: of the sizes and masses that the tables say, spread as PyBullet's are."""

from __future__ import annotations

import numpy as np
import pytest
from original_facts import DATA
from tests.each import each
from tools.assets.random_objects.beams import COUNT, UNITS, drawn, parts, scale_of, wanted
from tools.assets.random_objects.measure import QUANTITIES, SPREAD, mass_in, parts_of, size_in
from tools.assets.random_objects.solids import Part, Size, distance, hull_fill, measured

CUBE = np.array([[x, y, z] for z in (0.0, 1.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
SIDES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
LIMITS = {"share of the bounds within the hull": 0.24}
"""How far distributions may be apart where it is more than 0.05: crossed beams have larger hulls."""


@pytest.fixture(scope="module")
def sizes() -> list[Size]:
    """What all objects measure, from their files."""
    found = [size_in(DATA, number) for number in range(COUNT)]
    return [size for size in found if size is not None]


def test_there_is_a_folder_for_each() -> None:
    folders = sorted(path.name for path in (DATA / "random_urdfs").iterdir())
    assert folders == [f"{number:03d}" for number in range(COUNT)] and len(wanted()) == COUNT


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_they_are_spread_as_pybullets(sizes: list[Size], quantity: str) -> None:
    theirs = np.loadtxt(SPREAD, delimiter=",", skiprows=1)[:, list(QUANTITIES).index(quantity)]
    ours = np.array([QUANTITIES[quantity](size) for size in sizes])
    assert len(ours) == COUNT
    # Percentiles stand for PyBullet's thousand, each for one in a hundred, which adds so much at most.
    assert distance(ours, theirs) < LIMITS.get(quantity, 0.05) + 0.01


def test_they_weigh_what_pybullets_do() -> None:
    assert {mass_in(DATA, number) for number in range(COUNT)} == {0.1}


def test_each_has_the_bounds_and_the_volume_that_were_measured(sizes: list[Size]) -> None:
    for goal, size in zip(wanted(), sizes, strict=True):
        edges = np.array(goal.high) - goal.low
        assert size.high - size.low == pytest.approx(edges, rel=1e-7)
        assert np.abs(size.low - goal.low).max() <= max(scale_of(goal))
        assert size.fill == pytest.approx(goal.fill, abs=0.03)


def test_an_object_of_one_part_is_one_here() -> None:
    for number, goal in enumerate(wanted()):
        path = DATA / f"random_urdfs/{number:03d}/{number:03d}.obj"
        assert (len(parts_of(path)) == 1) == goal.alone
        assert len(parts_of(path)) == len(parts(number)) == len(drawn(goal.lot, alone=goal.alone))


@each("number", range(0, COUNT, 20))
def test_parts_lie_within_the_bounds_and_face_outwards(number: int) -> None:
    for part in parts(number):
        assert part.corners.min() >= 0.0 and part.corners.max() <= UNITS
        middle = part.corners.mean(axis=0)
        for face in part.faces:
            a, b, c, _ = part.corners[list(face)]
            assert np.cross(b - a, c - a) @ (a - middle) >= -1e-6


def test_a_cube_fills_its_bounds_and_two_count_once_where_they_meet() -> None:
    cube = Part(CUBE, SIDES)
    assert measured([cube]).fill == 1.0
    beside = Part(np.add(CUBE, (0.5, 0.0, 0.0)), SIDES)
    size = measured([cube, beside])
    assert (size.fill, size.hull) == (1.0, pytest.approx(1.0, abs=0.02))
    assert size.volume == pytest.approx(1.5) and size.extents == pytest.approx([1.0, 1.0, 1.5])
    apart = measured([cube, Part(np.add(CUBE, (2.0, 0.0, 0.0)), SIDES)])
    assert (apart.fill, apart.hull) == (pytest.approx(2.0 / 3.0), pytest.approx(1.0, abs=0.02))


def test_the_hull_of_a_corner_is_a_sixth_of_the_cube() -> None:
    corners = np.vstack((np.zeros(3), np.eye(3)))
    assert hull_fill(corners) == pytest.approx(1.0 / 6.0, abs=0.04)


def test_distance_of_samples() -> None:
    first = np.arange(10.0)
    assert distance(first, first) == 0.0
    assert distance(first, first + 100.0) == 1.0
    assert distance(first, first + 5.0) == pytest.approx(0.5)
