"""Contacts of all substeps of a step count, where a program is compared."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tests.differ.test_programs import call, outcome
from tools.differ.causes.substeps import with_contacts_of_substeps
from tools.differ.compare import compare
from tools.differ.pair import Outcome
from tools.differ.programs import Call

PROGRAM = [
    call(0, "setPhysicsEngineParameter", fixedTimeStep=0.01, numSubSteps=4, erp=0.1),
    call(1, "stepSimulation"),
    call(2, "@probe"),
    call(3, "setTimeStep", 0.02),
    call(4, "stepSimulation"),
    call(5, "@probe"),
]


def state(velocity: float, contacts: int = 0, deepest: float = 0.0) -> list[Any]:
    return ["ok", [[[0, [0.0, velocity], [], [], []]], contacts, deepest]]


def answered(velocity: float) -> Outcome:
    none = ["ok", None]
    return outcome(none, none, state(velocity), none, none, state(velocity))


class Substeps:
    """Performs programs, with a contact in the second step of all."""

    def __init__(self, depth: float) -> None:
        self.calls: list[Call] = []
        self._depth = depth

    def order(self, calls: Sequence[Call]) -> None:
        self.calls = list(calls)

    def answer(self) -> Outcome:
        steps, results = 0, list[Any]()
        for one in self.calls:
            steps += one["f"] == "stepSimulation"
            touches = steps == 2
            probed = state(0.0, int(touches), -self._depth if touches else 0.0)
            results.append(probed if one["f"] == "@probe" else ["ok", None])
        return outcome(*results)


def test_deep_contacts_of_a_substep_end_the_comparison():
    theirs, ours = answered(1.0), answered(1.1)
    assert [one.phase for one in compare(PROGRAM, theirs, ours)] == ["free"]
    assert not compare(PROGRAM, with_contacts_of_substeps(Substeps(0.1), PROGRAM, theirs), ours)
    seen = with_contacts_of_substeps(Substeps(0.001), PROGRAM, theirs)
    assert [one.phase for one in compare(PROGRAM, seen, ours)] == ["contact"]


def test_there_is_a_step_for_each_substep():
    pybullet = Substeps(0.0)
    with_contacts_of_substeps(pybullet, PROGRAM, answered(1.0))
    assert [one["f"] for one in pybullet.calls].count("stepSimulation") == 8
    assert pybullet.calls[0]["k"] == {"fixedTimeStep": 0.01, "erp": 0.1}
    lengths = [one["a"][0] for one in pybullet.calls if one["f"] == "setTimeStep"]
    assert lengths == [0.0025, 0.01, 0.02, 0.005, 0.02]


def test_nothing_is_performed_again_without_substeps():
    pybullet, theirs = Substeps(0.1), answered(1.0)
    assert with_contacts_of_substeps(pybullet, PROGRAM[1:], theirs) is theirs
    assert not pybullet.calls
