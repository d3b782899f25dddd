"""Where Carom loses digits of moments of inertia is told from what it does otherwise."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from tests.differ.test_programs import call, outcome
from tools.differ.causes.digits import DIGITS, LOST, loses_digits
from tools.differ.compare import Difference, compare
from tools.differ.pair import ROOT, Outcome
from tools.differ.perform import perform
from tools.differ.programs import Call
from tools.differ.values import Place

import pybullet_data

FILE = "spherical_joint_limit.urdf"
PROGRAM = [call(0, "loadURDF", FILE), call(1, "stepSimulation"), call(2, "@probe")]


def turns(velocity: float, contacts: int = 0) -> Outcome:
    state = [[[0, [0.0, velocity], [], [], []]], contacts, 0.0]
    return outcome(["ok", 0], ["ok", None], ["ok", state])


class Rounding:
    """Carom, which loses digits as a ratio says, and changes by so much with bodies turned by 1e-14."""

    def __init__(self, ratio: float, change: float) -> None:
        self._ratio, self._change = ratio, change

    def order(self, calls: Sequence[Call]) -> None:
        self._calls = calls

    def answer(self) -> Outcome:
        if self._calls[-1]["f"] == "@digits_lost":
            return outcome(["ok", 0], ["ok", None], ["ok", [self._ratio]])
        turned = self._calls[0]["k"]["baseOrientation"]
        assert max(abs(a - b) for a, b in zip(turned, [0, 0, 0, 1], strict=True)) <= 1e-14
        return turns(1.0 + self._change)


@pytest.mark.parametrize(
    ("ratio", "change", "contacts", "expected"),
    [
        (2 * LOST, 1e-6, 0, DIGITS),
        (2 * LOST, 1e-8, 0, None),
        (0.5 * LOST, 1e-6, 0, None),
        (2 * LOST, 1e-6, 1, None),
    ],
)
def test_carom_loses_digits_where_it_changes_itself(
    ratio: float, change: float, contacts: int, expected: str | None
):
    ours, theirs = turns(1.0, contacts), turns(1.000001 if not contacts else 1.1, contacts)
    (difference,) = compare(PROGRAM, theirs, ours)
    assert loses_digits(Rounding(ratio, change), PROGRAM, ours, difference) == expected


def test_bodies_and_calls_count_for_themselves():
    carom = Rounding(2 * LOST, 1e-6)
    other_body = Difference(2, "@probe", Place("base.1.1", 0.0, 1.0, 1e-6), "free", 0.0)
    assert loses_digits(carom, PROGRAM, turns(1.0), other_body) is None
    getter = Difference(2, "getLinkState", Place("base.0.1", 0.0, 1.0, 1e-6), "free", 0.0)
    assert loses_digits(carom, PROGRAM, turns(1.0), getter) is None


def test_digits_are_those_of_masses_far_away():
    fixed = call(0, "loadURDF", FILE, useFixedBase=True)
    freed = call(1, "changeDynamics", {"$": 0}, -1, mass=0.4, localInertiaDiagonal=[2.5e-7] * 3)
    calls = [fixed, freed, call(2, "loadURDF", FILE), call(3, "@digits_lost")]
    *_, (status, lost) = perform(calls, pybullet_data.getDataPath())
    # A link of 1 kg, whose centre is 1.3 m from that of the base.
    assert status == "ok"
    assert lost[0] == pytest.approx(1.69 / 2.5e-7)


def test_lost_digits_are_stated():
    page = ROOT / "docs" / "differences" / "robots.md"
    assert DIGITS in " ".join(page.read_text(encoding="utf-8").split())
