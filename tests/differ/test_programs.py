"""The differential fuzzer itself: programs, comparisons, and how programs are made short."""

from __future__ import annotations

import ast
import math
from typing import Any

import pytest
from tools.differ.causes.known import KNOWN
from tools.differ.compare import compare, difference
from tools.differ.each_call import CALLS, programs_of_getters
from tools.differ.minimise import Minimiser
from tools.differ.pair import ROOT, Outcome
from tools.differ.perform import perform
from tools.differ.programs import Call, all_references, closed, script
from tools.differ.themes import KINDS, THEMES, program

import pybullet_data


def call(number: int, function: str, *arguments: Any, **keywords: Any) -> Call:
    return {"f": function, "a": list(arguments), "k": keywords, "id": number}


def outcome(*results: Any, died: str | None = None) -> Outcome:
    return {"results": list(results), "died": died}


@pytest.mark.parametrize("theme", THEMES)
def test_programs_are_the_same_for_the_same_seed(theme: str):
    assert program(3, theme) == program(3, theme) != program(4, theme)
    for seed in range(20):
        calls = program(seed, theme)
        assert closed(calls) == calls
        ast.parse(script(calls))


def test_all_kinds_of_calls_are_in_some_theme():
    assert {kind for theme in THEMES.values() for kind in theme.kinds} == set(KINDS)


def test_getters_are_asked_after_every_other_call():
    names = [name for name, _ in programs_of_getters()]
    assert len(set(names)) == len(names) == 2 * len(CALLS)
    _, calls = next(programs_of_getters())
    results = list(perform(calls, pybullet_data.getDataPath()))
    assert [result for result in results if result[0] != "ok"] == []


def test_what_refers_to_a_call_that_is_gone_goes_with_it():
    calls = [call(0, "a"), call(1, "b", {"$": 0}), call(2, "c", [{"whole": 1}]), call(3, "d")]
    assert all_references(calls[2]) == {1}
    assert closed(calls[1:]) == [calls[3]]


def test_results_that_refer_to_failures_are_lost():
    calls = [call(0, "loadURDF", "nothing.urdf"), call(1, "getNumJoints", {"$": 0}), call(2, "getNumBodies")]
    error, lost, count = perform(calls, pybullet_data.getDataPath())
    assert (error[:2], lost, count) == (["error", "error"], ["lost"], ["ok", 0])


@pytest.mark.parametrize(
    ("function", "theirs", "ours", "field"),
    [
        ("getAABB", [[0.0, 1.0]], [[0.0, 1.0 + 1e-10]], None),
        ("getAABB", [[0.0, 1.0]], [[0.0, 1.001]], ".0"),
        ("getAABB", [[0.0]], [[math.nan]], ".0.nan"),
        ("getNumBodies", 2, 3, ""),
        ("getLinkState", [[0.0, HALF := math.sqrt(0.5), HALF, 1e-9]], [[0.0, -HALF, -HALF, -1e-9]], None),
        ("getLinkState", [[0.0, 0.6, 0.0, 0.8]], [[0.0, -0.6, 0.0, -0.8]], ".0"),
        ("rayTest", [[1, -1, 0.5, [0, 0, 0], [0, 0, 1]]], [[2, -1, 0.5, [0, 0, 0], [0, 0, 1]]], "hit"),
        ("rayTest", [[1, -1, 0.5, [0, 0, 0], [0, 0, 1]]], [[1, -1, 0.6, [0, 0, 0], [0, 0, 1]]], "fraction"),
        ("getOverlappingObjects", [[1, -1], [0, -1]], [[0, -1], [1, -1]], None),
        ("getOverlappingObjects", None, [[0, -1]], "new"),
        (
            "getMeshData",
            [2, [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]],
            [2, [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]],
            None,
        ),
        ("@reach", [0.1, 0.0, [1.0]], [0.2, 0.0, [1.5]], "worse"),
        ("@reach", [0.0, 0.0, [1.0]], [0.0, 0.0, [1.5]], "other"),
    ],
)
def test_differences(function: str, theirs: Any, ours: Any, field: str | None):
    place = difference(function, ["ok", theirs], ["ok", ours], 1e-9)
    assert (place and place.field) == field


def test_messages_may_say_more_but_nothing_else():
    assert not difference("f", ["error", "error", "No body."], ["error", "error", "No body. There is 0."], 0)
    place = difference("f", ["error", "error", "No body."], ["error", "error", "No joint."], 0)
    assert place and place.field == "text"
    place = difference("f", ["ok", 1], ["error", "error", "No joint."], 0)
    assert place and place.field == "ok/error"


def state(x: float, contacts: int = 0, deepest: float = 0.0) -> Any:
    return ["ok", [[[0, [[x, 0.0, 0.0]], [], [], []]], contacts, deepest]]


def test_states_are_compared_until_they_differ():
    calls = [call(number, "@probe") for number in range(3)]
    found = compare(calls, outcome(state(1), state(1), state(1)), outcome(state(1), state(2), state(3)))
    assert [(one.call, one.place.field) for one in found] == [(1, "base.0.0")]
    # Where PyBullet has no numbers, there is nothing to compare with.
    assert not compare(calls, outcome(state(math.nan), state(1)), outcome(state(1), state(2)))


def test_after_contacts_states_are_compared_for_some_steps_only():
    calls = [call(2 * n + k, f) for n in range(20) for k, f in enumerate(("stepSimulation", "@probe"))]
    theirs = [["ok", None] if one["f"] == "stepSimulation" else state(0, contacts=1) for one in calls]
    for steps, differs in ((2, True), (10, False)):
        ours = [*theirs[: 2 * steps - 1], *([state(1, contacts=1), ["ok", None]] * 20)][: len(calls)]
        assert bool(compare(calls, outcome(*theirs), outcome(*ours))) == differs


def test_nothing_is_compared_after_bodies_were_deep_in_each_other():
    calls = [call(number, f) for number, f in enumerate(("stepSimulation", "@probe", "getNumBodies"))]
    for deepest, differs in ((-0.001, True), (-0.1, False)):
        results = (["ok", None], state(0, 1, deepest))
        found = compare(calls, outcome(*results, ["ok", 1]), outcome(*results, ["ok", 2]))
        assert bool(found) == differs


def test_how_deep_bodies_are_is_told_with_a_difference_of_states():
    calls = [call(0, "stepSimulation"), call(1, "@probe")]
    theirs, ours = (
        outcome(["ok", None], state(velocity, 1, depth)) for velocity, depth in ((1, -0.001), (2, -0.003))
    )
    assert [one.deepest for one in compare(calls, theirs, ours)] == [-0.003]


def test_a_process_that_dies_differs():
    calls = [call(0, "a"), call(1, "b")]
    found = compare(calls, outcome(["ok", 1], ["ok", 1]), outcome(["ok", 1], died="signal 11"))
    assert [(one.call, one.place.field) for one in found] == [(1, "died")]


class Fake:
    """Interpreters that differ where a program has calls of `a` and `b`, the latter with a large number."""

    oracle = None

    def run(self, calls: list[Call], seconds: float = 0) -> tuple[Outcome, Outcome]:
        before: set[str] = set()
        ours: list[Any] = []
        for one in calls:
            differs = one["f"] == "b" and "a" in before and one["k"].get("size", 0.0) > 0.5
            ours.append(["ok", int(differs)])
            before.add(one["f"])
        return outcome(*(["ok", 0] for _ in calls)), outcome(*ours)


def test_programs_are_made_short():
    calls = [call(number, "c", 0.123) for number in range(20)]
    calls[4] = call(4, "a", 0.123, other=1)
    calls[15] = call(15, "b", size=0.76543)
    short, found = Minimiser(Fake(), "b", budget=200).minimise(calls)  # pyright: ignore[reportArgumentType]
    assert found and found.call == 1
    assert short == [call(4, "a", 0.1), call(15, "b", size=0.8)]


def test_of_deep_contacts_only_the_links_are_compared():
    deep = [0, 0, 1, -1, 2, [0.0] * 3, [0.0] * 3, [0.0, 0.0, 1.0], -0.1]
    turned = [0, 1, 0, 2, -1, [0.0] * 3, [0.0] * 3, [0.0, 1.0, 0.0], -0.2]
    assert difference("getContactPoints", ["ok", [deep, deep]], ["ok", [turned]], 1e-9) is None
    other = [0, 0, 1, -1, 3, *deep[5:]]
    place = difference("getContactPoints", ["ok", [deep]], ["ok", [other]], 1e-9)
    assert place and place.field == "links"
    near = [*deep[:8], -0.001]
    assert difference("getContactPoints", ["ok", [near]], ["ok", [[*turned[:8], -0.001]]], 1e-9)


def test_known_differences_are_stated():
    pages = [ROOT / "docs" / "differences.md", *sorted((ROOT / "docs" / "differences").glob("*.md"))]
    text = " ".join(" ".join(page.read_text(encoding="utf-8") for page in pages).split())
    assert [known.says for known in KNOWN if " ".join(known.says.split()) not in text] == []


@pytest.mark.parametrize(("side", "beyond"), [(1, 1e-14), (0, 0.0), (-1, -1e-14)])
def test_joints_at_limits_are_put_to_one_side(side: int, beyond: float):
    calls = [
        call(0, "loadURDF", "laikago/laikago_toes_limits.urdf"),
        call(1, "resetJointState", {"$": 0}, 0, 0.25, 0.5),
        call(2, "@nudge", 1e-14, 0, side),
        call(3, "getJointStates", {"$": 0}, [0, 2]),
    ]
    hip, knee = list(perform(calls, pybullet_data.getDataPath()))[3][1]
    assert hip[:2] == [0.25, 0.5]
    assert knee[:2] == [beyond, 0.0]
