"""Causes of differences that floors seen from nearby and margins of shapes are: as much as they can do."""

from __future__ import annotations

from typing import Any

import pytest
from tests.differ.test_programs import call, outcome
from tests.differ.test_shown import Answers
from tools.differ.causes.calls import Seen
from tools.differ.causes.depths import is_as_deep_elsewhere
from tools.differ.causes.nearest import has_the_margin_of_a_body
from tools.differ.compare import Difference
from tools.differ.values import Place

FLOOR = call(0, "loadURDF", "plane.urdf")


def image(*depths: float, labels: tuple[int, ...] = (0, 0, -1)) -> list[Any]:
    return [3, 1, [0] * 12, [list(depths)], [list(labels)]]


@pytest.mark.parametrize(
    ("maker", "ours", "pushed", "field", "expected"),
    [
        # PyBullet's own depths change as much.
        (FLOOR, image(0.2001, 0.5, 0.9), image(0.2002, 0.5, 0.9), "depth", True),
        (FLOOR, image(0.2001, 0.5, 0.9), image(0.19994, 0.5, 0.9), "depth", True),
        # They do not, or not where the difference is.
        (FLOOR, image(0.2001, 0.5, 0.9), image(0.20004, 0.5, 0.9), "depth", False),
        (FLOOR, image(0.2001, 0.5, 0.9), image(0.2, 0.5002, 0.9), "depth", False),
        (FLOOR, image(0.2001, 0.5001, 0.9), image(0.2002, 0.5, 0.9), "depth", False),
        # More than single precision does.
        (FLOOR, image(0.2006, 0.5, 0.9), image(0.21, 0.5, 0.9), "depth", False),
        # Another body, or something else.
        (call(0, "loadURDF", "cube.urdf"), image(0.2001, 0.5, 0.9), image(0.2002, 0.5, 0.9), "depth", False),
        (call(0, "createMultiBody", 0), image(0.2001, 0.5, 0.9), image(0.2002, 0.5, 0.9), "depth", False),
        (FLOOR, image(0.2001, 0.5, 0.9), image(0.2002, 0.5, 0.9), "colour", False),
        # Where another body is seen, depths say nothing about this one.
        (FLOOR, image(0.2001, 0.6, 0.9, labels=(0, 7, -1)), image(0.2002, 0.5, 0.9), "depth", True),
    ],
)
def test_depths_of_a_floor_are_as_different_when_it_is_pushed(
    maker: Any, ours: Any, pushed: Any, field: str, expected: bool
):
    calls = [maker, call(1, "getCameraImage", 3, 1)]
    theirs = outcome(["ok", 0], ["ok", image(0.2, 0.5, 0.9)])
    found = Difference(1, "getCameraImage", Place(field, "1 of 3 differ: 0.2 of 0", 0.2001), "start")
    pybullet = Answers(getCameraImage=[pushed])
    said = is_as_deep_elsewhere(pybullet, calls, theirs, outcome(["ok", 0], ["ok", ours]), found)
    assert bool(said) == expected


def test_a_floor_is_not_pushed_where_that_fails():
    calls = [FLOOR, call(1, "getCameraImage", 3, 1)]
    found = Difference(1, "getCameraImage", Place("depth", "1 of 3 differ: 0.2 of 0", 0.2001), "start")

    class Failing(Answers):
        def answer(self) -> Any:
            return outcome(*(["ok", 0] for _ in self.calls[:-1]), ["error", "error", "no"])

    theirs, ours = (outcome(["ok", 0], ["ok", image(depth, 0.5, 0.9)]) for depth in (0.2, 0.2001))
    assert is_as_deep_elsewhere(Failing(), calls, theirs, ours, found) is None


@pytest.mark.parametrize(
    ("changed", "margin", "asked", "farther", "expected"),
    [
        (1, 0.0, "collisionShapeB", 1e-3, True),
        (1, 0.0, "collisionShapeA", -1e-3, True),
        (1, 0.02, "collisionShapeB", -0.019, True),
        # More than the margin, or none at all.
        (1, 0.0, "collisionShapeB", 1.1e-3, False),
        (1, 0.001, "collisionShapeB", 1e-3, False),
        (1, 0.0, "collisionShapeB", 0.0, False),
        # A body of another shape, or nothing that was asked about.
        (2, 0.0, "collisionShapeB", 1e-3, False),
        (1, 0.0, "physicsClientId", 1e-3, False),
    ],
)
def test_shapes_have_the_margin_of_a_body(
    changed: int, margin: float, asked: str, farther: float, expected: bool
):
    bodies = [
        call(0, "createCollisionShape", 5),
        call(1, "createMultiBody", 1, {"$": 0}),
        call(2, "createMultiBody", 1),
    ]
    change = call(3, "changeDynamics", {"$": changed}, -1, collisionMargin=margin)
    query = call(4, "getClosestPoints", {"$": 2}, -1, 5, **{asked: {"$": 0}})
    point = [0, 0, -1, -1, -2, [0.0] * 3, [0.0] * 3, [0.0, 0.0, 1.0], 0.1]
    ours = [*point[:8], 0.1 - farther]
    found = Difference(4, "getClosestPoints", Place("distance", point, ours), "free")
    assert has_the_margin_of_a_body(Seen(found, [*bodies, change, query])) == expected
