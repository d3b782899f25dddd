"""Causes of differences that other answers of PyBullet show: only those, and only as much as they can do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest
from tests.differ.test_programs import call, outcome
from tools.differ.causes.bounds import has_present_bounds
from tools.differ.causes.heights import touches_heights_elsewhere
from tools.differ.causes.shadows import differs_by_shadows
from tools.differ.causes.surfaces import is_as_good, off_surfaces
from tools.differ.compare import Difference, compare, differences
from tools.differ.pair import Outcome
from tools.differ.programs import Call
from tools.differ.values import Place

STEP = call(50, "stepSimulation")


class Answers:
    """An interpreter whose calls have given answers, by function; a list is taken one by one."""

    def __init__(self, **answers: Any) -> None:
        self.calls: Sequence[Call] = ()
        self._answers = answers

    def order(self, calls: Sequence[Call]) -> None:
        self.calls = calls

    def answer(self) -> Outcome:
        left = {name: iter(values) for name, values in self._answers.items()}
        return outcome(*(["ok", next(left[one["f"]], None) if one["f"] in left else 0] for one in self.calls))


@pytest.mark.parametrize(
    ("missing", "new", "bounds", "moved", "expected"),
    [
        # The link is in the box by its present bounds, and Carom has it.
        ([], [[0, -1]], [[0.5] * 3, [2.0] * 3], True, True),
        ([], [[0, -1]], [[1.5] * 3, [2.0] * 3], True, False),
        # It is outside, but for PyBullet's margin, or has been put there.
        ([[0, -1]], [], [[1.01] * 3, [2.0] * 3], False, True),
        ([[0, -1]], [], [[1.5] * 3, [2.0] * 3], False, False),
        ([[0, -1]], [], [[1.5] * 3, [2.0] * 3], True, True),
        # It is in the box: that Carom lacks it is a fault.
        ([[0, -1]], [], [[0.5] * 3, [2.0] * 3], True, False),
    ],
)
def test_overlaps_are_those_of_present_bounds(
    missing: list[Any], new: list[Any], bounds: list[Any], moved: bool, expected: bool
):
    asked = call(2, "getOverlappingObjects", [0.0] * 3, [1.0] * 3)
    calls = [call(0, "createMultiBody", 1), *([] if moved else [STEP]), asked]
    place = Place("new" if new else "missing", missing, new)
    found = Difference(len(calls) - 1, "getOverlappingObjects", place, "start")
    assert bool(has_present_bounds(Answers(getAABB=[bounds]), calls, found)) == expected


IMAGE = call(2, "getCameraImage", 2, 2, {"whole": 0}, {"whole": 1}, lightAmbientCoeff=0.5)
LENS = call(1, "computeProjectionMatrixFOV", 60, 1, 0.1, 10)


def picture(shade: int) -> list[Any]:
    return [2, 2, [[[shade, shade, shade, 255]] * 2] * 2, [[0.5] * 2] * 2, [[0] * 2] * 2]


@pytest.mark.parametrize(("without", "expected"), [(90, True), (80, False)])
def test_shadows_are_only_where_none_are_left_without(without: int, expected: bool):
    calls = [call(0, "computeViewMatrix"), LENS, IMAGE]
    dark, bright = outcome(["ok", 0], ["ok", 0], ["ok", picture(50)]), picture(90)
    (found,) = compare(calls, dark, outcome(["ok", 0], ["ok", 0], ["ok", bright]))
    assert found.place.field == "colour"
    pybullet, carom = Answers(getCameraImage=[picture(without)]), Answers(getCameraImage=[bright])
    assert bool(differs_by_shadows(pybullet, carom, calls, found)) == expected
    assert pybullet.calls[-1]["k"]["shadow"] == 0


def test_a_little_brighter_is_another_colour():
    assert not differences("getCameraImage", ["ok", picture(50)], ["ok", picture(51)], 0.0)
    (place,) = differences("getCameraImage", ["ok", picture(50)], ["ok", picture(54)], 0.0)
    assert (place.field, place.error) == ("colour", 4)


def nearest(a: list[float], b: list[float], normal: list[float], distance: float) -> list[Any]:
    return [0, 1, 2, -1, -1, a, b, normal, distance]


@pytest.mark.parametrize(
    ("ours", "field"),
    [
        (nearest([0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], 1.0), None),
        (nearest([0.2, 0.0, 1.0], [0.2, 0.0, 0.0], [0.0, 0.0, 1.0], 1.0), "points"),
        (nearest([0.001, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], 1.0), "beside"),
        (nearest([0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, -1.0], 1.0), "beside"),
    ],
)
def test_nearest_points_are_compared(ours: list[Any], field: str | None):
    theirs = nearest([0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], 1.0)
    places = differences("getClosestPoints", ["ok", [theirs]], ["ok", [ours]], 1e-9)
    assert [place.field for place in places] == ([field] if field else [])


def test_a_ball_is_put_beside_nearest_points():
    points = [nearest([0.2, 0.0, 1.0], [0.2, 0.0, 0.0], [0.0, 0.0, 1.0], 1.0)]
    beside = [[nearest([0.0] * 3, [0.0] * 3, [0.0, 0.0, 1.0], distance)] for distance in (0.005, 0.015)]
    pybullet = Answers(getClosestPoints=[*beside])
    (off,) = off_surfaces(pybullet, [call(0, "getClosestPoints", 1, 2, 5.0)], points)
    assert off == pytest.approx(0.009)
    above, below = (one["k"]["collisionShapePositionB"] for one in pybullet.calls[-2:])
    assert above == pytest.approx([0.2, 0.0, 0.99])
    assert below == pytest.approx([0.2, 0.0, 0.01])


@pytest.mark.parametrize(
    ("theirs", "ours", "expected"),
    [(0.0, 1e-7, True), (0.0, 1e-5, False), (5e-5, 4e-5, True), (0.1, 0.05, False), (0.0, None, False)],
)
def test_points_are_on_surfaces_as_well_as_pybullets(theirs: float, ours: float | None, expected: bool):
    assert is_as_good(theirs, ours) == expected


FIELD = [call(0, "createCollisionShape", 9), call(1, "createMultiBody", 0, {"$": 0})]
BALLS = [call(2, "createMultiBody", 1), call(3, "createMultiBody", 1)]
PROGRAM = [*FIELD, *BALLS, STEP, call(60, "@probe")]


def touch(body: int, x: float) -> list[Any]:
    return [0, body, 0, -1, -1, [x, 0.0, 0.0], [x, 0.0, 0.0], [0.0, 0.0, 1.0], -0.001]


def moving(*speeds: float) -> Outcome:
    bodies = [[0, [[0.0] * 3, [0.0] * 4, [0.0] * 3, [0.0] * 3], [], [], []]]
    for body, speed in enumerate(speeds, 1):
        bodies.append([body, [[0.0] * 3, [0.0] * 4, [speed, 0.0, 0.0], [0.0] * 3], [], [], []])
    return outcome(*(["ok", body] for body in (0, 0, 1, 2)), ["ok", None], ["ok", [bodies, 1, -0.001]])


@pytest.mark.parametrize(
    ("speeds", "x", "expected"),
    [
        ((1.1, 0.0), 0.1, True),
        # The points are the same.
        ((1.1, 0.0), 0.0, False),
        # The other ball touches nothing.
        ((1.1, 0.1), 0.1, False),
        # No contact makes it so fast.
        ((9.0, 0.0), 0.1, False),
    ],
)
def test_only_what_touches_height_fields_at_other_points_may_differ(
    speeds: tuple[float, ...], x: float, expected: bool
):
    theirs, ours = moving(1.0, 0.0), moving(*speeds)
    (found,) = compare(PROGRAM, theirs, ours)
    pybullet, carom = (Answers(getContactPoints=[[touch(1, place)]]) for place in (0.0, x))
    says = touches_heights_elsewhere(pybullet, carom, PROGRAM, theirs, ours, found)
    assert bool(says) == expected
