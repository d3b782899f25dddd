"""What contacts of links that fixed joints tie to each other move by rounding is told from other motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest
from tests.differ.test_programs import call, outcome
from tools.differ.causes.tied import TIED, touches_what_it_is_tied_to
from tools.differ.compare import compare
from tools.differ.pair import ROOT, Outcome
from tools.differ.perform import perform
from tools.differ.programs import Call

import pybullet_data

SELF_COLLISION = 8
FIXED, HINGE = 4, 0


def program(flags: int = SELF_COLLISION) -> list[Call]:
    return [call(0, "createMultiBody", 1, flags=flags), call(1, "stepSimulation"), call(2, "@probe")]


def answered(velocity: float, contacts: int = 7) -> Outcome:
    state = [[[0, [0.0, velocity], [], [], []]], contacts, 0.0]
    return outcome(["ok", 0], ["ok", None], ["ok", state])


class Passing:
    """PyBullet, which finishes with this velocity if links that are tied to each other do not touch."""

    def __init__(self, velocity: float) -> None:
        self._velocity = velocity

    def order(self, calls: Sequence[Call]) -> None:
        assert [one["f"] for one in calls[1:]] == ["@pass_tied_links", "stepSimulation", "@probe"]

    def answer(self) -> Outcome:
        state = [[[0, [0.0, self._velocity], [], [], []]], 0, 0.0]
        return outcome(["ok", 0], ["ok", None], ["ok", None], ["ok", state])


@pytest.mark.parametrize(
    ("flags", "contacts", "passing", "expected"),
    [
        (SELF_COLLISION | 128, 7, 1.1, TIED),
        (SELF_COLLISION, 7, 1.0, None),
        (SELF_COLLISION, 7, 1.01, None),
        (SELF_COLLISION, 0, 1.1, None),
        (128, 7, 1.1, None),
    ],
)
def test_pybullet_agrees_once_links_do_not_touch_that_are_tied(
    flags: int, contacts: int, passing: float, expected: str | None
):
    calls, theirs, ours = program(flags), answered(1.0, contacts), answered(1.1, contacts)
    (difference,) = compare(calls, theirs, ours)
    assert touches_what_it_is_tied_to(Passing(passing), calls, theirs, ours, difference) == expected


def test_only_links_that_fixed_joints_tie_do_not_touch(monkeypatch: pytest.MonkeyPatch):
    switched: list[tuple[int, ...]] = []
    monkeypatch.setattr("pybullet.setCollisionFilterPair", lambda *given: switched.append(given))
    links: dict[str, Any] = {"linkMasses": [1] * 3, "linkCollisionShapeIndices": [-1] * 3}
    links |= {"linkVisualShapeIndices": [-1] * 3, "linkPositions": [[0, 0, 0]] * 3}
    links |= {"linkOrientations": [[0, 0, 0, 1]] * 3, "linkInertialFramePositions": [[0, 0, 0]] * 3}
    links |= {"linkInertialFrameOrientations": [[0, 0, 0, 1]] * 3, "linkParentIndices": [0, 1, 2]}
    links |= {"linkJointTypes": [FIXED, HINGE, FIXED], "linkJointAxis": [[0, 0, 1]] * 3}
    calls = [call(0, "createMultiBody", 1, **links), call(1, "@pass_tied_links")]
    results = list(perform(calls, pybullet_data.getDataPath()))
    assert [result[0] for result in results] == ["ok", "ok"]
    assert switched == [(0, 0, 0, -1, 0), (0, 0, 2, 1, 0)]


def test_it_is_stated():
    page = ROOT / "docs" / "differences" / "contact.md"
    assert TIED in " ".join(page.read_text(encoding="utf-8").split())
