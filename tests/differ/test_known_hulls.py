"""Causes of differences that the shapes of flat hulls and the bounds of bodies before the first step are."""

from __future__ import annotations

from typing import Any

import pytest
from tests.differ.test_programs import call, outcome
from tests.differ.test_shown import Answers
from tools.differ.causes.calls import Seen
from tools.differ.causes.flat import is_nearer_by_flat_hulls
from tools.differ.causes.unmoved import hits_once_bounds_are_there
from tools.differ.compare import Difference
from tools.differ.values import Place

TRIANGLE = [[0.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.0, 0.3, 0.1], [0.0, 0.0, 0.0]]
SOLID = [*TRIANGLE, [0.1, 0.1, 0.4]]
HIT, BEHIND = [0, 7, 0.2, [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]], [1, -1, 0.5, [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
NOTHING = [-1, -1, 1.0, [0.0] * 3, [0.0] * 3]
NEAR = [0, 7, 0.2003, [0.0, 0.0, 0.9995], [0.0, 0.0, 1.0]]


@pytest.mark.parametrize(
    ("vertices", "more", "nearer", "expected"),
    [
        (TRIANGLE, {}, 1.02e-4, True),
        (TRIANGLE, {}, 2.0e-4, False),
        (TRIANGLE, {}, -1.0e-4, False),
        (TRIANGLE, {"meshScale": [1, 2, 3]}, 1.02e-4, True),
        (TRIANGLE, {"indices": [0, 1, 2]}, 1.02e-4, False),
        (SOLID, {}, 1.02e-4, False),
        ([], {}, 1.02e-4, False),
    ],
)
def test_flat_hulls_are_nearer_by_half_their_thickness(
    vertices: list[list[float]], more: dict[str, Any], nearer: float, expected: bool
):
    shape = call(0, "createCollisionShape", 5, vertices=vertices, **more)
    body, ball = call(1, "createMultiBody", 1, {"$": 0}), call(2, "createCollisionShape", 2, radius=0.1)
    asked = call(3, "getClosestPoints", {"$": 1}, -1, 5, collisionShapeB={"$": 2})
    theirs, ours = ([*[0] * 8, distance] for distance in (0.4, 0.4 - nearer))
    found = Difference(3, "getClosestPoints", Place("distance", theirs, ours, nearer), "start")
    assert is_nearer_by_flat_hulls(Seen(found, [shape, body, ball, asked])) == expected


def test_two_flat_hulls_are_nearer_by_twice_as_much():
    shape = call(0, "createCollisionShape", 5, vertices=TRIANGLE)
    asked = call(2, "getClosestPoints", {"$": 1}, -1, 5, collisionShapeB={"$": 0})
    theirs, ours = ([*[0] * 8, distance] for distance in (0.4, 0.3998))
    found = Difference(2, "getClosestPoints", Place("distance", theirs, ours, 2e-4), "start")
    assert is_nearer_by_flat_hulls(Seen(found, [shape, call(1, "createMultiBody", 1, {"$": 0}), asked]))


@pytest.mark.parametrize(
    ("theirs", "now", "ours", "phase", "expected"),
    [
        ([BEHIND], [NEAR], [HIT], "start", True),
        ([NOTHING], [NEAR], [HIT], "start", True),
        ([NOTHING, BEHIND], [NOTHING, NEAR], [NOTHING, HIT], "start", True),
        # PyBullet hits the other body still, or another link, or another place of this one.
        ([BEHIND], [BEHIND], [HIT], "start", False),
        ([BEHIND], [[0, 6, *NEAR[2:]]], [HIT], "start", False),
        ([BEHIND], [[*NEAR[:3], [0.0, 0.0, 0.9], NEAR[4]]], [HIT], "start", False),
        # What is missing in Carom is a fault, and so is all after the first step.
        ([HIT], [HIT], [NOTHING], "start", False),
        ([BEHIND], [NEAR], [HIT], "free", False),
    ],
)
def test_rays_hit_what_pybullet_hits_once_it_has_looked(
    theirs: list[Any], now: list[Any], ours: list[Any], phase: str, expected: bool
):
    calls = [call(0, "createMultiBody", 1), call(1, "rayTestBatch", [[0] * 3], [[0, 0, 1]])]
    there, here = (outcome(["ok", 0], ["ok", hits]) for hits in (theirs, ours))
    found = Difference(1, "rayTestBatch", Place("hit", theirs[-1], ours[-1]), phase)
    performer = Answers(rayTestBatch=[now])
    assert bool(hits_once_bounds_are_there(performer, calls, there, here, found)) == expected


def test_other_differences_are_not_those_of_rays():
    calls = [call(0, "createMultiBody", 1), call(1, "rayTest", [0] * 3, [0, 0, 1])]
    answers = outcome(["ok", 0], ["ok", [HIT]])
    found = Difference(1, "rayTest", Place("fraction", HIT, NEAR), "start")
    assert hits_once_bounds_are_there(Answers(), calls, answers, answers, found) is None
    lost = Difference(1, "rayTest", Place("hit", BEHIND, HIT), "start")
    died = outcome(["ok", 0], ["error", "x"])
    assert hits_once_bounds_are_there(Answers(rayTest=[[HIT]]), calls, answers, died, lost) is None
