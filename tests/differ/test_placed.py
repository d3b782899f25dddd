"""Contacts that PyBullet has in another order, after links without shapes parted, are told from others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest
from tests.differ.test_programs import call, outcome
from tools.differ.causes.placed import PLACED, was_placed_among_bare_links
from tools.differ.compare import compare
from tools.differ.pair import ROOT, Outcome
from tools.differ.perform import perform
from tools.differ.programs import Call

import pybullet_data

GRIPPER = "gripper/wsg50_one_motor_gripper.sdf"


def program(function: str = "loadSDF", file: str = GRIPPER) -> list[Call]:
    return [call(0, function, file), call(1, "stepSimulation"), call(2, "@probe")]


def answered(velocity: float, contacts: int = 2) -> Outcome:
    state = [[[0, [0.0, velocity], [], [], []]], contacts, 0.0]
    return outcome(["ok", [0]], ["ok", None], ["ok", state])


class Passing:
    """PyBullet, which finishes with this velocity if links without shapes meet nothing from the start."""

    def __init__(self, velocity: float) -> None:
        self._velocity = velocity

    def order(self, calls: Sequence[Call]) -> None:
        self._calls = calls

    def answer(self) -> Outcome:
        assert [one["f"] for one in self._calls[1:]] == ["@pass_bare_links", "stepSimulation", "@probe"]
        state = [[[0, [0.0, self._velocity], [], [], []]], 7, 0.0]
        return outcome(["ok", [0]], ["ok", None], ["ok", None], ["ok", state])


@pytest.mark.parametrize(
    ("function", "file", "contacts", "passing", "expected"),
    [
        ("loadSDF", GRIPPER, 2, 1.1, PLACED),
        ("loadSDF", GRIPPER, 2, 1.0, None),
        ("loadSDF", GRIPPER, 2, 1.2, None),
        ("loadSDF", GRIPPER, 2, 1.10001, None),
        ("loadSDF", GRIPPER, 0, 1.1, None),
        ("loadSDF", "stadium.sdf", 2, 1.1, None),
        ("loadURDF", GRIPPER, 2, 1.1, None),
    ],
)
def test_pybullet_agrees_once_links_without_shapes_meet_nothing(
    function: str, file: str, contacts: int, passing: float, expected: str | None
):
    calls, theirs, ours = program(function, file), answered(1.0, contacts), answered(1.1, contacts)
    (difference,) = compare(calls, theirs, ours)
    assert was_placed_among_bare_links(Passing(passing), calls, theirs, ours, difference) == expected


def test_what_is_left_is_a_small_part_of_the_difference():
    calls, theirs, ours = program(), answered(1.0), answered(1.000003)
    (difference,) = compare(calls, theirs, ours)
    assert was_placed_among_bare_links(Passing(1.000003), calls, theirs, ours, difference) == PLACED
    assert was_placed_among_bare_links(Passing(1.0000025), calls, theirs, ours, difference) is None


def test_links_without_shapes_are_kept_from_all_others():
    shape = call(0, "createCollisionShape", 2, radius=0.1)
    still = call(1, "createMultiBody", 0, {"$": 0}, -1)
    bare: dict[str, Any] = {"linkMasses": [1], "linkCollisionShapeIndices": [-1]}
    bare |= {"linkVisualShapeIndices": [-1], "linkPositions": [[0, 0, 0]], "linkOrientations": [[0, 0, 0, 1]]}
    bare |= {"linkInertialFramePositions": [[0, 0, 0]], "linkInertialFrameOrientations": [[0, 0, 0, 1]]}
    bare |= {"linkParentIndices": [0], "linkJointTypes": [4], "linkJointAxis": [[0, 0, 1]]}
    other = call(2, "createMultiBody", 1, {"$": 0}, -1, [0, 0, 0.15], **bare)
    calls = [shape, still, other, call(3, "@pass_bare_links"), call(4, "stepSimulation"), call(5, "@probe")]
    results = list(perform(calls, pybullet_data.getDataPath()))
    assert [result[0] for result in results] == ["ok"] * len(calls)
    assert results[-1][1][1] == 1  # What has shapes still touches.


def test_how_models_are_placed_is_stated():
    page = ROOT / "docs" / "differences" / "contact.md"
    assert PLACED in " ".join(page.read_text(encoding="utf-8").split())
