"""Images of round shapes that the near plane cuts are told from others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest
from tests.differ.test_programs import call, outcome
from tools.differ.causes.cut import CUT, cuts_something_round, with_near_planes_next_to_cameras
from tools.differ.compare import compare
from tools.differ.pair import ROOT, Outcome
from tools.differ.programs import Call

NOTHING, WIDTH = -1, 10
PIXELS = WIDTH * WIDTH
CAPSULE, BOX = 7, 3


def program(shape: int = CAPSULE) -> list[Call]:
    return [
        call(0, "createCollisionShape", shape, radius=0.2),
        call(1, "createMultiBody", 1, {"$": 0}),
        call(2, "computeViewMatrix", [0, 0, 1], [0, 0, 0], [0, 1, 0]),
        call(3, "computeProjectionMatrix", -0.05, 0.05, -0.05, 0.05, 0.05, 20),
        call(4, "getCameraImage", WIDTH, WIDTH, {"whole": 2}, {"whole": 3}),
    ]


def image(shown: int) -> Outcome:
    """What came of the program, if so many pixels show its body, the others what is behind it."""
    segments = [0] * shown + [NOTHING] * (PIXELS - shown)
    depths = [0.5] * shown + [1.0] * (PIXELS - shown)
    taken: list[Any] = [WIDTH, WIDTH, [[0] * 4] * PIXELS, depths, segments]
    return outcome(*[["ok", None]] * 4, ["ok", taken])


class Camera:
    """One of the two, which shows so many pixels of the body with a plane next to the camera."""

    def __init__(self, shown: int) -> None:
        self._shown = shown

    def order(self, calls: Sequence[Call]) -> None:
        assert calls[3]["a"] == pytest.approx([-5e-4, 5e-4, -5e-4, 5e-4, 5e-4, 20])

    def answer(self) -> Outcome:
        return image(self._shown)


@pytest.mark.parametrize(
    ("shape", "theirs", "ours", "expected"),
    [
        (CAPSULE, 80, 80, CUT),
        (CAPSULE, 80, 90, CUT),
        (CAPSULE, 90, 80, None),
        (CAPSULE, 40, 80, None),
        (BOX, 80, 80, None),
    ],
)
def test_what_a_nearer_plane_shows_alike_is_cut(shape: int, theirs: int, ours: int, expected: str | None):
    calls = program(shape)
    (difference,) = compare(calls, image(70), image(20))
    assert cuts_something_round(Camera(theirs), Camera(ours), calls, difference) == expected


def test_only_images_are_taken_again():
    calls = [call(0, "getBodyInfo", 0)]
    (difference,) = compare(calls, outcome(["ok", ["a", "b"]]), outcome(["ok", ["a", "c"]]))
    assert cuts_something_round(Camera(1), Camera(1), calls, difference) is None


def test_the_view_stays_the_same():
    calls = program()
    calls[3] = call(3, "computeProjectionMatrixFOV", 60.0, 1.0, 0.1, 10)
    nearer = with_near_planes_next_to_cameras(calls)
    assert nearer is not None
    assert nearer[3]["a"] == pytest.approx([60.0, 1.0, 0.001, 10])
    calls[3] = call(3, "computeViewMatrix", [0, 0, 1], [0, 0, 0], [0, 1, 0])
    assert with_near_planes_next_to_cameras(calls) is None


def test_planes_that_cut_are_stated():
    page = ROOT / "docs" / "differences" / "queries.md"
    assert CUT in " ".join(page.read_text(encoding="utf-8").split())
