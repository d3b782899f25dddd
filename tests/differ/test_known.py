"""Which differences the fuzzer takes for known: only those whose cause is in the program."""

from __future__ import annotations

import math
from typing import Any

import pytest
from tests.differ.test_programs import call, outcome, state
from tools.differ.causes.known import statement
from tools.differ.compare import Difference, compare
from tools.differ.programs import Call
from tools.differ.values import Place

BODY = {"$": 0}
BOX, CUBE = call(0, "createMultiBody", 1), "cube_small.urdf"
STEP, PROBE = call(50, "stepSimulation"), call(60, "@probe")
CHANGE, ASK = call(1, "changeDynamics", BODY, -1, mass=2), call(2, "calculateMassMatrix", BODY, [0.0])
BOUNCE = call(1, "changeDynamics", BODY, -1, restitution=0.5)


def is_known(calls: list[Call], field: str, theirs: Any, ours: Any) -> bool:
    """Whether a difference in what the last call returns is one that docs/differences states."""
    place = Place(field, theirs, ours)
    return statement(calls, Difference(len(calls) - 1, calls[-1]["f"], place, "free")) is not None


@pytest.mark.parametrize(
    ("calls", "expected"),
    [
        ([BOX, ASK, CHANGE, ASK], True),
        ([BOX, CHANGE, ASK], False),
        ([BOX, ASK, BOUNCE, ASK], False),
        ([BOX, call(2, "calculateMassMatrix", {"$": 7}, [0.0]), CHANGE, ASK], False),
    ],
)
def test_masses_are_remembered_from_the_first_question(calls: list[Call], expected: bool):
    assert is_known(calls, "", 1.0, 2.0) == expected


RIGHT = call(10, "resetBasePositionAndOrientation", BODY, [0, 0, 0], [0, 0, 0, 1])
TILTED = call(10, "resetBasePositionAndOrientation", BODY, [0, 0, 0], [0.4, -0.6, 0.6, 0.3])


@pytest.mark.parametrize(
    ("distance", "apart", "expected"),
    [(0.0999, 0.0999, True), (0.1001, 0.1001, False), (0.0995, 0.0995, False), (0.0999, 0.1, False)],
)
def test_nearest_points_may_be_a_little_nearer(distance: float, apart: float, expected: bool):
    theirs = [0, 0, 1, -1, -1, [0.0] * 3, [0.1, 0.0, 0.0], [1.0, 0.0, 0.0], 0.1]
    ours = [*theirs[:6], [apart, 0.0, 0.0], theirs[7], distance]
    calls = [call(0, "getClosestPoints", BODY, {"$": 1}, 1.0)]
    assert is_known(calls, "distance", theirs, ours) == expected


@pytest.mark.parametrize(("nearer", "expected"), [(1e-5, True), (1e-7, False), (-1e-5, False), (1e-3, False)])
def test_what_is_a_little_nearer_may_have_another_normal(nearer: float, expected: bool):
    theirs = [0, 0, 1, -1, -1, [0.0] * 3, [0.1, 0.0, 0.0], [1.0, 0.0, 0.0], 0.1]
    ours = [*theirs[:6], [0.0, 0.1 - nearer, 0.0], [0.0, 1.0, 0.0], 0.1 - nearer]
    assert is_known([call(0, "getClosestPoints", BODY, {"$": 1}, 1.0)], "normal", theirs, ours) == expected


@pytest.mark.parametrize(("bound", "expected"), [(0, True), (1.0, False)])
def test_contacts_are_asked_for_at_a_distance_of_0_only(bound: float, expected: bool):
    assert is_known([call(0, "getClosestPoints", BODY, {"$": 1}, bound)], "pairs", [], [[0]]) == expected


TIE = call(5, "createConstraint", BODY, 0, -1, -1, 5, [0, 0, 0], [0, 0, 0], [0, 0, 0])
BOUNDS = call(11, "getAABB", BODY)


@pytest.mark.parametrize(
    ("calls", "expected"),
    [
        ([BOX, TILTED, STEP, BOUNDS], True),
        ([BOX, TILTED, STEP, STEP, BOUNDS], False),
        ([BOX, RIGHT, STEP, BOUNDS], False),
        ([BOX, TIE, TILTED, STEP, PROBE], True),
        ([BOX, TILTED, STEP, PROBE], False),
    ],
)
def test_what_is_no_rotation_is_felt_for_one_step(calls: list[Call], expected: bool):
    assert is_known(calls, ".0", 0.0, 0.1) == expected


@pytest.mark.parametrize(
    ("calls", "expected"),
    [([TILTED], True), ([RIGHT], False), ([TILTED, STEP], False), ([], False)],
)
@pytest.mark.parametrize(("body", "asked"), [(BODY, True), ({"$": 7}, False)])
def test_what_is_no_rotation_is_felt_by_closest_points(
    calls: list[Call], body: dict[str, int], asked: bool, expected: bool
):
    ask = call(60, "getClosestPoints", body, {"$": 8}, 5)
    theirs, ours = (
        [0, 0, 1, 0, -1, [0.0, 0.0, 1.0], [0.0, 0.0, 1.0 - gap], [0.0, 0.0, 1.0], gap] for gap in (0.2, 0.3)
    )
    assert is_known([BOX, *calls, ask], "distance", theirs, ours) == (expected and asked)


@pytest.mark.parametrize(
    ("turn", "expected"), [([1, 0, 0, 0], True), ([0, 0, math.sqrt(0.5), math.sqrt(0.5)], False)]
)
def test_half_a_turn_of_a_spherical_joint(turn: list[float], expected: bool):
    body = call(0, "createMultiBody", 1, linkJointTypes=[2])
    calls = [body, call(1, "resetJointStateMultiDof", BODY, 0, turn), STEP, PROBE]
    assert is_known(calls, "base.0.0", 0.0, 0.1) == expected


def limited(joint: int, **limits: float) -> list[Call]:
    """A program that gives limits to a joint, spherical if it is the first, else revolute, and steps."""
    body = call(0, "createMultiBody", 1, linkJointTypes=[2, 0])
    return [body, call(1, "changeDynamics", {"$": 0}, joint, **limits), call(2, "@probe")]


@pytest.mark.parametrize(
    ("calls", "expected"),
    [
        (limited(0, jointLowerLimit=-1.0, jointUpperLimit=1.0), True),
        (limited(1, jointLowerLimit=-1.0, jointUpperLimit=1.0), False),
        (limited(0, jointLowerLimit=1.0, jointUpperLimit=-1.0), False),
        (limited(0, jointLowerLimit=-1.0), False),
    ],
)
def test_only_limits_of_joints_that_have_none_are_known_to_stop_the_solver(calls: list[Call], expected: bool):
    results = [["ok", 0], ["ok", None]]
    found = compare(calls, outcome(*results, state(1)), outcome(*results, state(1.00001)))
    assert bool(statement(calls, found[0])) == expected


MESH = {"fileName": "sphere_smooth.obj"}


@pytest.mark.parametrize(
    ("shape", "ours", "other", "expected"),
    [
        (MESH, 0.1005, 5, True),
        (MESH, 0.0995, 5, False),
        (MESH, 0.1035, 5, True),
        (MESH, 0.105, 5, False),
        (MESH, 0.1005, 6, False),
        ({"fileName": "cube.obj"}, 0.1005, 5, False),
    ],
)
def test_fine_hulls_may_be_a_little_farther(shape: dict[str, str], ours: float, other: int, expected: bool):
    said = [[0, 0, 1, -1, -1, [0.0] * 3, [gap, 0.0, 0.0], [1.0, 0.0, 0.0], gap] for gap in (0.1, ours)]
    fine = [call(3, "createCollisionShape", 5, **shape), call(5, "createMultiBody", 1, {"$": 3})]
    calls = [BOX, *fine, call(6, "loadURDF", CUBE), call(7, "getClosestPoints", BODY, {"$": other}, 1.0)]
    assert is_known(calls, "distance", *said) == expected


@pytest.mark.parametrize(("ours", "expected"), [(-0.0995, True), (-0.1005, False)])
def test_fine_hulls_may_be_a_little_less_deep(ours: float, expected: bool):
    said = [[0, 0, 1, -1, -1, [0.0] * 3, [gap, 0.0, 0.0], [1.0, 0.0, 0.0], gap] for gap in (-0.1, ours)]
    fine = [call(3, "createCollisionShape", 5, **MESH), call(5, "createMultiBody", 1, {"$": 3})]
    calls = [BOX, *fine, call(7, "getClosestPoints", BODY, {"$": 5}, 1.0)]
    assert is_known(calls, "depth", *said) == expected


@pytest.mark.parametrize(
    ("file", "ours", "expected"),
    [
        ("mjcf/humanoid.xml", -0.09, True),
        ("mjcf/humanoid.xml", -0.19, False),
        ("mjcf/humanoid.xml", -0.01, False),
        ("mjcf/swimmer.xml", -0.20000000298, True),
        ("mjcf/swimmer.xml", -0.2000001, False),
        ("mjcf/ground.xml", -0.09, False),
        ("a1/a1.urdf", -0.09, False),
    ],
)
def test_crossing_capsules_are_those_of_mjcf(file: str, ours: float, expected: bool):
    said = [[0, 0, 0, 1, 2, [0.0] * 3, [0.0] * 3, [1.0, 0.0, 0.0], depth] for depth in (-0.02, ours)]
    function = "loadMJCF" if file.endswith(".xml") else "loadURDF"
    calls = [call(0, function, file), call(4, "getClosestPoints", BODY, BODY, 1.0)]
    assert is_known(calls, "depth", *said) == expected


@pytest.mark.parametrize(
    ("file", "ours", "apart", "expected"),
    [
        ("mjcf/reacher.xml", -0.02, 0.02, True),
        ("mjcf/reacher.xml", -0.02, 0.021, False),
        ("mjcf/reacher.xml", -0.009, 0.009, False),
        ("mjcf/reacher.xml", -0.031, 0.031, False),
        ("mjcf/cylinder.xml", -0.02, 0.02, False),
    ],
)
def test_a_search_for_the_way_out_of_capsules_may_end_deeper(
    file: str, ours: float, apart: float, expected: bool
):
    said = [
        [0, 0, 1, 1, 2, [0.0] * 3, [way, 0.0, 0.0], [-1.0, 0.0, 0.0], depth]
        for way, depth in ((0.03, -0.03), (apart, ours))
    ]
    calls = [BOX, call(5, "loadMJCF", file), call(7, "getClosestPoints", BODY, {"$": 5, "i": 0}, 1.0)]
    assert is_known(calls, "depth", *said) == expected


def test_balls_of_mjcf_are_round_as_well():
    said = [[0, 0, 0, 0, -1, [0.0] * 3, [0.0] * 3, [1.0, 0.0, 0.0], depth] for depth in (-0.32, -0.33)]
    calls = [call(0, "loadMJCF", "mjcf/ant.xml"), call(4, "getClosestPoints", BODY, BODY, 1.0)]
    assert is_known(calls, "depth", *said)


@pytest.mark.parametrize(
    ("file", "ours", "expected"),
    [
        ("mjcf/pusher.xml", 0.159, True),
        ("mjcf/pusher.xml", 0.161, False),
        ("mjcf/pusher.xml", 0.099, False),
        ("mjcf/ant.xml", 0.101, False),
    ],
)
def test_thin_capsules_of_mjcf_have_a_margin(file: str, ours: float, expected: bool):
    said = [[0, 0, 1, 1, 2, [0.0] * 3, [0.0] * 3, [1.0, 0.0, 0.0], gap] for gap in (0.1, ours)]
    made = {"$": 5, "i": 0}
    calls = [BOX, call(5, "loadMJCF", file), call(7, "getClosestPoints", BODY, made, 1.0)]
    assert is_known(calls, "distance", *said) == expected


@pytest.mark.parametrize(
    ("ours", "expected"), [("a/b/c.stl", True), ("a//b/c.stl", False), ("a/b/d.stl", False)]
)
def test_paths_have_no_doubled_slashes(ours: str, expected: bool):
    assert is_known([BOX, call(1, "getCollisionShapeData", BODY, -1)], ".0.4", "a//b/c.stl", ours) == expected


@pytest.mark.parametrize(
    ("body", "fraction", "expected"), [(2, 0.5, True), (2, 0.5001, False), (-1, 0.5, False)]
)
def test_a_ray_may_meet_two_bodies_at_one_place(body: int, fraction: float, expected: bool):
    hits = [[each, -1, part, [0.0] * 3, [0.0] * 3] for each, part in ((0, 0.5), (body, fraction))]
    assert is_known([BOX, STEP, call(51, "rayTest", [0] * 3, [1] * 3)], "hit", *hits) == expected


SAVE, RESTORE = call(20, "saveState"), call(22, "restoreState", {"$": 20})
PUSH = call(21, "applyExternalForce", BODY, -1, [1, 0, 0], [0, 0, 0], 1)


@pytest.mark.parametrize(
    ("calls", "expected"),
    [
        ([BOX, SAVE, PUSH, RESTORE, STEP, PROBE], True),
        ([BOX, SAVE, PUSH, STEP, RESTORE, STEP, PROBE], False),
        ([BOX, SAVE, RESTORE, PUSH, STEP, PROBE], False),
    ],
)
def test_forces_outlast_restored_states_until_the_next_step(calls: list[Call], expected: bool):
    assert is_known(calls, "base.0.0", 0.0, 0.1) == expected


@pytest.mark.parametrize(
    ("file", "flags", "expected"),
    [
        ("TwoJointRobot_wo_fixedJoints.urdf", 131080, True),
        ("TwoJointRobot_wo_fixedJoints.urdf", 8, False),
        ("a1/a1.urdf", 131072, False),
    ],
)
def test_children_come_first_in_the_order_of_some_files(file: str, flags: int, expected: bool):
    calls = [call(0, "loadURDF", file, flags=flags), call(1, "getLinkState", BODY, 0)]
    assert is_known(calls, ".0", 0.0, 0.1) == expected


def test_joints_are_numbered_with_children_after_their_parent():
    body = call(0, "createMultiBody", 1, linkJointTypes=[2, 0, 4, 2], linkParentIndices=[0, 1, 1, 2])
    aims = [call(1, "setJointMotorControl2", BODY, link, 2, targetPosition=1) for link in range(4)]
    known = [is_known([body, aim, PROBE], "positions.0.0", 0.0, 0.1) for aim in aims]
    assert known == [True, False, True, False]
    several = [call(1, "setJointMotorControlArray", BODY, links, 2) for links in ([1, 2], [1, 3])]
    known = [is_known([body, aim, PROBE], "positions.0.0", 0.0, 0.1) for aim in several]
    assert known == [True, False]


@pytest.mark.parametrize(
    ("ours", "expected"), [([-0.5, 0.5, -0.5, -0.5], True), ([-0.5, 0.5, 0.5, -0.5], False)]
)
def test_a_rotation_has_two_quaternions(ours: list[float], expected: bool):
    assert is_known([BOX, call(1, "getLinkState", BODY, 0)], ".1", [0.5, -0.5, 0.5, 0.5], ours) == expected


@pytest.mark.parametrize(("other", "away", "expected"), [(0, 0.0, True), (0, 0.05, False), (1, 0.0, False)])
def test_points_of_one_body_may_be_exchanged(other: int, away: float, expected: bool):
    theirs = [0, 0, other, -1, 0, [0.0] * 3, [0.1, 0.0, 0.0], [1.0, 0.0, 0.0], 0.1]
    ours = [*theirs[:5], [0.1, away, 0.0], [0.0, away, 0.0], [-1.0, 0.0, 0.0], 0.1]
    assert is_known([call(0, "getClosestPoints", BODY, BODY, 1.0)], "normal", theirs, ours) == expected


@pytest.mark.parametrize("function", ["rayTest", "rayTestBatch"])
@pytest.mark.parametrize(
    ("number", "expected"), [({}, False), ({"reportHitNumber": -1}, False), ({"reportHitNumber": 0}, True)]
)
def test_hits_of_rays_are_counted_along_the_ray(function: str, number: dict[str, int], expected: bool):
    ray = call(3, function, [[0, 0, 2]], [[0, 0, -2]], **number)
    assert is_known([BOX, ray], "hit", [0, -1, 0.5], [1, -1, 0.2]) == expected


SAVE, RESTORE, REMOVE = call(4, "saveState"), call(6, "restoreState", {"$": 4}), call(5, "removeBody", BODY)


@pytest.mark.parametrize(
    ("calls", "expected"),
    [
        ([BOX, SAVE, REMOVE, BOX, RESTORE, PROBE], True),
        ([BOX, BOX, REMOVE, SAVE, RESTORE, PROBE], False),
        ([BOX, SAVE, RESTORE, REMOVE, PROBE], False),
    ],
)
def test_states_are_restored_by_order_where_bodies_were_removed(calls: list[Call], expected: bool):
    assert is_known(calls, "base.0.0", 1.0, 2.0) == expected
