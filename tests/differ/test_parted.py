"""Pairs of bounds that have parted, and that PyBullet keeps for a while, are told from other differences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest
from tests.differ.test_programs import call, outcome
from tools.differ.causes.parted import PARTED, keeps_what_parted
from tools.differ.compare import compare
from tools.differ.pair import ROOT, Outcome
from tools.differ.programs import Call

PROGRAM = [
    call(0, "setPhysicsEngineParameter", numSubSteps=2),
    call(1, "stepSimulation"),
    call(2, "@probe"),
    call(3, "stepSimulation"),
    call(4, "@probe"),
]


def answered(*velocities: float) -> Outcome:
    states = [["ok", [[[0, [0.0, one], [], [], []]], 0, 0.0]] for one in velocities]
    return outcome(["ok", None], *(part for state in states for part in (["ok", None], state)))


class Searching:
    """PyBullet, which finishes with these velocities: without searches before each substep, and with them."""

    def __init__(self, without: float, with_all: float) -> None:
        self._without, self._with_all = without, with_all

    def order(self, calls: Sequence[Call]) -> None:
        self._calls = calls

    def answer(self) -> Outcome:
        results, velocity = list[Any](), 1.0
        for number, one in enumerate(self._calls):
            if one["f"] == "stepSimulation":
                before = self._calls[number - 1]
                assert before["f"] == "@search"
                velocity = self._with_all if before["a"][0] else self._without
            state = [[[0, [0.0, velocity], [], [], []]], 5, 0.0]
            results.append(["ok", state if one["f"] == "@probe" else None])
        return outcome(*results)


@pytest.mark.parametrize(
    ("without", "with_all", "expected"),
    [(1.0, 1.1, PARTED), (1.0, 1.0, None), (1.0, 1.2, None), (1.1, 1.1, None), (1.1, 1.0, None)],
)
def test_pybullet_agrees_once_it_has_looked_at_all_pairs(
    without: float, with_all: float, expected: str | None
):
    program, theirs, ours = PROGRAM[:3], answered(1.0), answered(1.1)
    (difference,) = compare(program, theirs, ours)
    assert keeps_what_parted(Searching(without, with_all), program, theirs, ours, difference) == expected


def test_other_answers_are_not_doubted():
    program, theirs, ours = PROGRAM[:1], outcome(["ok", 1]), outcome(["ok", 2])
    (difference,) = compare(program, theirs, ours)
    assert keeps_what_parted(Searching(1.0, 1.1), program, theirs, ours, difference) is None


def test_what_pybullet_keeps_is_stated():
    page = ROOT / "docs" / "differences" / "contact.md"
    assert PARTED in " ".join(page.read_text(encoding="utf-8").split())
