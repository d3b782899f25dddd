"""What PyBullet itself has two answers to is told from what Carom does otherwise."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import pytest
from tests.differ.test_programs import call, outcome
from tools.differ.causes.rounding import (
    MEMORY,
    ROUNDING,
    doubted_by_pybullet,
)
from tools.differ.compare import Difference
from tools.differ.pair import ROOT, Outcome
from tools.differ.programs import Call
from tools.differ.values import Place

PROGRAM = [
    call(0, "createMultiBody", 1, -1, -1, [0.0, 0.0, 1.0], linkPositions=[[0.0, 0.0, 0.1]]),
    call(1, "loadURDF", "cube.urdf"),
    call(2, "stepSimulation"),
    call(3, "@probe"),
]


def falls(velocity: float, touches: bool = True) -> Outcome:
    """What a program came to: the velocity of a base, and whether it touches something."""
    state = [[0, [0.0, velocity], [], [], []]]
    return outcome(["ok", 0], ["ok", 1], ["ok", None], ["ok", [state, int(touches), 0.0]])


class Fake:
    """Performs programs as a function says."""

    def __init__(self, says: Callable[[Sequence[Call]], Outcome]) -> None:
        self._says = says

    def order(self, calls: Sequence[Call]) -> None:
        self._calls = calls

    def answer(self) -> Outcome:
        return self._says(self._calls)


def chaotic(size: float, touches: bool) -> Callable[[Sequence[Call]], Outcome]:
    """Answers that change by so much with a change of a program, which is a small one."""

    def answer(calls: Sequence[Call]) -> Outcome:
        moved = abs(calls[0]["a"][3][2] - 1.0)
        assert moved <= (1e-12 if touches else 1e-14)
        return falls(1.0 + size if moved else 1.0, touches)

    return answer


@pytest.mark.parametrize(
    ("elsewhere", "afresh", "phase", "expected"),
    [
        (0.0, 1.0, "contact", None),
        (3e-3, 1.0, "contact", ROUNDING),
        (3e-4, 1.0, "contact", None),
        (3e-3, 1.0, "free", ROUNDING),
        (3e-4, 1.0, "free", None),
        (0.0, 1.004, "contact", MEMORY),
        (0.0, 1.002, "contact", None),
    ],
)
def test_pybullet_is_asked_again(elsewhere: float, afresh: float, phase: str, expected: str | None):
    touches = phase == "contact"
    place = Place("base.0.1", 1.0, 1.004, 2e-3)
    said = doubted_by_pybullet(
        Fake(chaotic(elsewhere, touches)),
        Fake(lambda calls: falls(afresh, touches)),
        PROGRAM,
        falls(1.0, touches),
        falls(1.004, touches),
        Difference(3, "@probe", place, phase),
    )
    assert said == expected


def at_a_limit(resets: float, beyond: float) -> Callable[[Sequence[Call]], Outcome]:
    """Answers that change by so much if joints at limits are reset, and if they are put beyond them."""

    def answer(calls: Sequence[Call]) -> Outcome:
        nudges = [one["a"] for one in calls if one["f"] == "@nudge"]
        changes = [resets + (beyond if side == 1 else 0.0) for _, _, side in nudges]
        found = falls(1.0 + sum(changes), touches=False)
        # Each has a result of its own, before that of the step.
        found["results"][2:2] = [["ok", None]] * len(nudges)
        return found

    return answer


@pytest.mark.parametrize(
    ("resets", "beyond", "expected"),
    [(0.0, 0.0, None), (0.0, 3e-3, ROUNDING), (0.0, 3e-4, None), (3e-3, 3e-3, None)],
)
def test_joints_at_limits_are_put_on_both_sides(resets: float, beyond: float, expected: str | None):
    place = Place("base.0.1", 1.0, 1.004, 2e-3)
    said = doubted_by_pybullet(
        Fake(at_a_limit(resets, beyond)),
        Fake(lambda _: falls(1.0, touches=False)),
        PROGRAM,
        falls(1.0, touches=False),
        falls(1.004, touches=False),
        Difference(3, "@probe", place, "free"),
    )
    assert said == expected


def contact(place: float, link: int = -1) -> list[object]:
    return [0, 0, 1, link, -1, [place, 0.0, 0.0], [0.0] * 3, [0.0, 0.0, 1.0], -1e-3]


@pytest.mark.parametrize(
    ("moved", "field", "expected"),
    [
        ([contact(1.0), contact(2.00002)], ".1.5", ROUNDING),
        ([contact(1.0), contact(2.000008)], ".1.5", None),
        ([contact(1.00002), contact(2.0)], ".1.5", None),
        ([contact(1.0), contact(2.00002, link=3)], ".1.5", None),
        ([contact(2.00002)], ".1.5", None),
        ([contact(1.0), contact(2.00002)], ".1.8", None),
        ([contact(1.0), contact(2.00002)], "links", None),
    ],
)
def test_places_of_contacts_are_asked_for_with_bodies_elsewhere(
    moved: list[list[object]], field: str, expected: str | None
):
    program = [*PROGRAM[:2], call(2, "performCollisionDetection"), call(3, "getContactPoints")]
    before, ours = [contact(1.0), contact(2.0)], [contact(1.0), contact(2.00002)]

    def answered(contacts: list[list[object]]) -> Outcome:
        return outcome(["ok", 0], ["ok", 1], ["ok", None], ["ok", contacts])

    def answer(calls: Sequence[Call]) -> Outcome:
        away = abs(calls[0]["a"][3][2] - 1.0)
        assert away <= 1e-12
        return answered(moved if away else before)

    place = Place(field, before[1][5], ours[1][5])
    difference = Difference(3, "getContactPoints", place, "start")
    afresh = Fake(lambda _: answered(before))
    said = doubted_by_pybullet(Fake(answer), afresh, program, answered(before), answered(ours), difference)
    assert said == expected


@pytest.mark.parametrize(
    ("moved", "field", "expected"),
    [
        ([contact(1.0)], "links", ROUNDING),
        ([contact(1.0)], ".len", ROUNDING),
        ([contact(1.0), contact(2.0, link=1)], "links", None),
        ([contact(2.0, link=1)], "links", None),
    ],
)
def test_pairs_that_come_and_go_are_left_to_rounding(
    moved: list[list[object]], field: str, expected: str | None
):
    program = [*PROGRAM[:2], call(2, "performCollisionDetection"), call(3, "getContactPoints")]
    before, ours = [contact(1.0), contact(2.0, link=1)], [contact(1.0)]

    def answered(contacts: list[list[object]]) -> Outcome:
        return outcome(["ok", 0], ["ok", 1], ["ok", None], ["ok", contacts])

    def answer(calls: Sequence[Call]) -> Outcome:
        return answered(moved if calls[0]["a"][3][2] != 1.0 else before)

    difference = Difference(3, "getContactPoints", Place(field, before, ours), "start")
    afresh = Fake(lambda _: answered(before))
    said = doubted_by_pybullet(Fake(answer), afresh, program, answered(before), answered(ours), difference)
    assert said == expected


def test_differences_near_the_bound_are_seen_in_other_answers_of_pybullet():
    error = 1.2e-6
    place = Place("base.0.1", 1.0, 1.0 + 2 * error, error)
    said = doubted_by_pybullet(
        Fake(chaotic(1.4 * error, touches=True)),
        Fake(lambda _: falls(1.0)),
        PROGRAM,
        falls(1.0),
        falls(1.0 + 2 * error),
        Difference(3, "@probe", place, "contact"),
    )
    assert said == ROUNDING


@pytest.mark.parametrize(("share", "expected"), [(1.0, ROUNDING), (0.0, None)])
def test_joints_are_put_elsewhere_that_a_program_leaves_as_they_are(share: float, expected: str | None):
    types = {"linkJointTypes": [0, 2, 4], "linkParentIndices": [0, 1, 2]}
    program = [
        call(0, "createMultiBody", 0, -1, -1, [0.0, 0.0, 1.0], **types),
        call(1, "loadMJCF", "mjcf/reacher.xml"),
        *PROGRAM[2:],
    ]

    def answer(calls: Sequence[Call]) -> Outcome:
        resets = [one for one in calls if one["f"] == "resetJointState"]
        size = max((abs(one["a"][2]) for one in resets), default=0.0)
        assert size <= 1e-14
        # Resets look for pairs, which changes answers as well.
        velocity = 1.0 + share * 3e-3 * (size > 0.0) + 3e-3 * bool(resets)
        results = falls(velocity, touches=False)["results"]
        places = [n for n, one in enumerate(calls) if one["f"] not in ("resetJointState", "@nudge")]
        made = [["ok", None]] * len(calls)
        for place, result in zip(places, results, strict=True):
            made[place] = result
        ends = {(one["a"][0]["$"], one["a"][0].get("i"), one["a"][1]) for one in resets}
        assert not ends or {(0, None, 0), (0, None, 2)} <= ends
        assert (0, None, 1) not in ends
        assert not ends or any(body == 1 and number is not None for body, number, _ in ends)
        return outcome(*made)

    difference = Difference(3, "@probe", Place("base.0.1", 1.0, 1.004, 2e-3), "free")
    afresh = Fake(lambda calls: falls(1.0, touches=False))
    ours = falls(1.004, touches=False)
    said = doubted_by_pybullet(Fake(answer), afresh, program, falls(1.0, False), ours, difference)
    assert said == expected


@pytest.mark.parametrize(
    ("nearby", "turned", "spins", "expected"),
    [
        (2e-6, 2e-5, 0.0, ROUNDING),
        (2e-6, 0.0, 0.0, None),
        (2e-6, 0.0, 1e-3, None),
    ],
)
def test_what_differs_by_less_does_not_hide_what_comes_after_it(
    nearby: float, turned: float, spins: float, expected: str | None
):
    def answer(calls: Sequence[Call]) -> Outcome:
        moved = float(calls[0]["a"][3][2] != 1.0)
        base = [[moved * nearby] * 3, [moved * turned, 0.0, 0.0, 1.0], [moved * spins] * 3, [0.0] * 3]
        state = [[0, base, [], [], []]]
        return outcome(["ok", 0], ["ok", 1], ["ok", None], ["ok", [state, 1, 0.0]])

    theirs = answer(PROGRAM)
    ours = outcome(
        *theirs["results"][:3], ["ok", [[[0, [[0.0] * 3, [2e-5, 0.0, 0.0, 1.0]], [], [], []]], 1, 0.0]]
    )
    difference = Difference(3, "@probe", Place("base.0.1", 0.0, 2e-5, 1e-5), "contact")
    said = doubted_by_pybullet(Fake(answer), Fake(answer), PROGRAM, theirs, ours, difference)
    assert said == expected


def test_what_pybullet_doubts_is_stated():
    pages = (ROOT / "docs" / "differences" / "contact.md", ROOT / "docs" / "conformance" / "method.md")
    text = " ".join(" ".join(page.read_text(encoding="utf-8").split()) for page in pages)
    assert ROUNDING in text
    assert MEMORY in text
