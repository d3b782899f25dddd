"""Which differences in the rows of the solver the fuzzer takes for known."""

from __future__ import annotations

from typing import Any

import pytest
from tests.differ.test_known import PROBE, STEP, is_known
from tests.differ.test_programs import call
from tools.differ.causes.known import statement
from tools.differ.compare import Difference
from tools.differ.programs import Call
from tools.differ.values import Place

ARM, OTHER = (
    call(number, "createMultiBody", 0, linkJointTypes=[0, 0], linkParentIndices=[0, 1]) for number in (0, 1)
)
FIX = call(4, "changeDynamics", {"$": 0}, 1, mass=0, activationState=32)
BOX, GRIPPER = call(2, "createMultiBody", 1), call(3, "loadURDF", "pr2_gripper.urdf")
SAVE, RESTORE = call(5, "saveState"), call(6, "restoreState", {"whole": 5})
DRIVE = call(8, "setJointMotorControl2", {"$": 0}, 0, 0)
REMOVE = call(4, "removeBody", {"$": 2})


def is_stated(calls: list[Call], field: str, error: float, phase: str = "free", deepest: float = 0.0) -> bool:
    """Whether a difference so large, and in this phase, is one that docs/differences states."""
    calls = [*calls, STEP, PROBE]
    place = Place(field, 0.0, error, error)
    return statement(calls, Difference(len(calls) - 1, "@probe", place, phase, deepest)) is not None


@pytest.mark.parametrize(
    ("calls", "field", "expected"),
    [
        ([GRIPPER], "reactions.0.2.1", True),
        ([GRIPPER], "velocities.0.2", False),
        ([ARM], "reactions.0.2.1", False),
    ],
)
def test_limits_share_with_motors(calls: list[Call], field: str, expected: bool):
    assert is_stated(calls, field, 1e-2) == expected


@pytest.mark.parametrize(
    ("calls", "error", "phase", "expected"),
    [
        ([ARM, OTHER, BOX, REMOVE], 1e-8, "free", True),
        ([ARM, OTHER, BOX, REMOVE], 1e-3, "free", False),
        ([ARM, OTHER, BOX, REMOVE], 1e-8, "contact", False),
        ([ARM, BOX, REMOVE], 1e-8, "free", False),
        ([ARM, OTHER], 1e-8, "free", False),
        ([ARM, OTHER, call(4, "changeDynamics", {"$": 0}, -1, mass=1)], 1e-8, "free", True),
        ([ARM, OTHER, FIX], 1e-8, "free", True),
        ([ARM, OTHER, call(4, "changeDynamics", {"$": 0}, 1, mass=0)], 1e-8, "free", False),
        ([ARM, OTHER, call(4, "changeDynamics", {"$": 0}, -1, restitution=0)], 1e-8, "free", False),
    ],
)
def test_islands_of_robots_are_renumbered(calls: list[Call], error: float, phase: str, expected: bool):
    assert is_stated(calls, "positions.0.1", error, phase) == expected


@pytest.mark.parametrize(
    ("mass", "types", "link", "other", "expected"),
    [
        (0, [2, 4, 4], 2, {"$": 2}, True),
        (0, [2, 4, 4], 1, {"$": 2}, True),
        (0, [2, 4, 4], 0, {"$": 2}, False),
        (0, [2, 4, 0], 2, {"$": 2}, False),
        (0, [4, 4, 4], 2, {"$": 2}, False),
        (1, [2, 4, 4], 2, {"$": 2}, False),
        (0, [2, 4, 4], 2, -1, False),
        (0, [2, 4, 4], 2, {"$": 0}, False),
    ],
)
def test_links_taken_for_still_are_tied(mass: float, types: list[int], link: int, other: Any, expected: bool):
    arm = call(0, "createMultiBody", mass, linkJointTypes=types, linkParentIndices=[0, 1, 2])
    for ends in ([{"$": 0}, link, other, -1], [other, -1, {"$": 0}, link]):
        tie = call(4, "createConstraint", *ends, 5, [0, 0, 1], [0, 0, 0], [0, 0, 0])
        assert is_stated([arm, BOX, tie], "base.1.0", 1e-2) == expected


@pytest.mark.parametrize(
    ("flags", "mass", "phase", "expected"),
    [(8200, 0, "contact", True), (0, 0, "contact", False), (8, 1, "contact", False), (8, 0, "free", False)],
)
def test_fixed_robots_that_touch_themselves(flags: int, mass: float, phase: str, expected: bool):
    robot = call(0, "loadURDF", "quadruped/minitaur.urdf", flags=flags)
    fix = call(1, "changeDynamics", {"$": 0}, 1, mass=mass, maxJointVelocity=13.0)
    assert is_stated([robot, fix], "positions.0.1", 1e-2, phase) == expected


@pytest.mark.parametrize(
    ("types", "turn", "expected"),
    [
        ([2], [0.33, -0.22, -0.9, -0.18], True),
        ([2], [0, 0, 0, 1], False),
        ([0], [0.33, -0.22, -0.9, 0], False),
    ],
)
def test_ball_joints_are_held_where_a_long_rotation_puts_them(
    types: list[int], turn: list[float], expected: bool
):
    arm = call(0, "createMultiBody", 0, linkJointTypes=types, linkParentIndices=[0])
    place = call(1, "resetBasePositionAndOrientation", {"$": 0}, [0, 0, 0], turn)
    assert is_stated([arm, place], "positions.0.0", 1e-2) == expected


@pytest.mark.parametrize(
    ("function", "field", "ours", "expected"),
    [
        ("getJointInfo", ".15", [-0.5, 0.5, 0.5, 0.5], True),
        ("getJointInfo", ".15", [0.5, 0.5, 0.5, 0.5], False),
        ("getJointInfo", ".14", [-0.5, 0.5, 0.5, 0.5], False),
        ("getLinkState", ".1", [-0.5, 0.5, 0.5, 0.5], True),
    ],
)
def test_rotations_may_have_the_other_sign(function: str, field: str, ours: list[float], expected: bool):
    calls = [ARM, call(1, function, {"$": 0}, 0)]
    assert (
        is_known(calls, field if field[0] == "." else f".{field}", [0.5, -0.5, -0.5, -0.5], ours) == expected
    )


@pytest.mark.parametrize(
    ("calls", "expected"),
    [
        ([ARM, SAVE, DRIVE, RESTORE], True),
        ([ARM, DRIVE, SAVE, RESTORE], False),
        ([ARM, SAVE, DRIVE], False),
        ([ARM, SAVE, RESTORE, DRIVE], False),
    ],
)
def test_motors_keep_targets_of_after_a_state_was_saved(calls: list[Call], expected: bool):
    assert is_stated(calls, "base.0.0", 1e-2) == expected


@pytest.mark.parametrize(
    ("name", "flags", "field", "error", "phase", "tied", "expected"),
    [
        ("racecar/racecar_differential.urdf", 0, "velocities.0.10", 6e-9, "free", True, True),
        ("racecar/racecar_differential.urdf", 0, "positions.0.10", 6e-9, "free", True, True),
        ("racecar/racecar_differential.urdf", 0, "velocities.0.10", 2e-8, "free", True, False),
        ("racecar/racecar_differential.urdf", 0, "velocities.0.10", 6e-9, "contact", True, False),
        ("racecar/racecar_differential.urdf", 0, "velocities.0.10", 6e-9, "free", False, False),
        ("racecar/racecar_differential.urdf", 0, "base.0.1", 6e-9, "free", True, False),
        ("racecar/racecar_differential.urdf", 2, "velocities.0.10", 6e-9, "free", True, False),
        ("racecar/racecar.urdf", 0, "velocities.0.10", 6e-9, "free", True, False),
    ],
)
def test_rounding_shows_where_links_turn_next_to_nothing(
    name: str, flags: int, field: str, error: float, phase: str, tied: bool, expected: bool
):
    robot = call(7, "loadURDF", name, flags=flags)
    tie = call(8, "createConstraint", {"$": 7}, 10, -1, -1, 5, [0, 0, 1], [0, 0, 0], [0, 0, 0])
    assert is_stated([robot, tie] if tied else [robot], field, error, phase) == expected


@pytest.mark.parametrize(
    ("name", "flags", "expected"), [("pusher", 2, True), ("pusher", 0, False), ("ant", 2, False)]
)
def test_joints_of_mjcf_files_may_turn_no_inertia(name: str, flags: int, expected: bool):
    assert is_stated([call(0, "loadMJCF", f"mjcf/{name}.xml", flags=flags)], "positions.1", 1e-2) == expected


@pytest.mark.parametrize(
    ("made", "driven", "values", "field", "expected"),
    [
        ("r2d2.urdf", [2, 3], (0.0, 0.004), "positions.0.2.0", True),
        ("r2d2.urdf", 2, (0.004, -1e-20), "positions.0.2.0", True),
        ("r2d2.urdf", 2, (0.003, 0.004), "positions.0.2.0", False),
        ("r2d2.urdf", 3, (0.0, 0.004), "positions.0.2.0", False),
        ("r2d2.urdf", 2, (0.0, 0.004), "base.0.2", False),
        ("a1/a1.urdf", 2, (0.0, 0.004), "positions.0.2.0", False),
    ],
)
def test_motors_drive_against_limits_that_are_hardly_reached(
    made: str, driven: int | list[int], values: tuple[float, float], field: str, expected: bool
):
    calls = [call(0, "loadURDF", made), call(1, "setJointMotorControl2", {"$": 0}, driven, 0), STEP, PROBE]
    difference = Difference(3, "@probe", Place(field, *values, 4e-3), "free")
    assert (statement(calls, difference) is not None) == expected


@pytest.mark.parametrize(
    ("flags", "fixed", "field", "phase", "expected"),
    [
        (8192 + 8, 1, "positions.0.2", "contact", True),
        (8192 + 8, 1, "positions.0.2", "free", False),
        (8192 + 8, 1, "positions.1.2", "contact", False),
        (8192 + 8, 0, "positions.0.2", "contact", False),
        (8192, 1, "positions.0.2", "contact", False),
        (8, 1, "positions.0.2", "contact", False),
    ],
)
def test_links_press_on_parents(flags: int, fixed: int, field: str, phase: str, expected: bool):
    robot = call(0, "loadURDF", "quadruped/minitaur.urdf", useFixedBase=fixed, flags=flags)
    assert is_stated([robot, BOX], field, 0.5, phase) == expected


@pytest.mark.parametrize(
    ("mass", "joint", "turn", "expected"),
    [
        (0, 2, [-0.11, -0.94, 0.25, 0.18], True),
        (1, 2, [-0.11, -0.94, 0.25, 0.18], False),
        (0, 0, [-0.11, -0.94, 0.25, 0.18], False),
        (0, 2, [0.0, 0.0, 0.6, 0.8], False),
    ],
)
def test_fixed_bases_stay_turned_by_no_rotation(mass: int, joint: int, turn: list[float], expected: bool):
    body = call(0, "createMultiBody", mass, linkJointTypes=[0, joint], linkParentIndices=[0, 1])
    reset = call(1, "resetBasePositionAndOrientation", {"$": 0}, [0, 0, 0], turn)
    assert is_stated([body, reset, STEP, STEP], "positions.0.0", 1e-7) == expected


SLEEP = call(5, "changeDynamics", {"$": 2}, -1, activationState=8)
HEAVIER = call(6, "changeDynamics", {"$": 2}, -1, mass=2)
SUBSTEPS = call(7, "setPhysicsEngineParameter", numSubSteps=2)


@pytest.mark.parametrize(
    ("calls", "phase", "expected"),
    [
        ([SUBSTEPS, BOX, SLEEP, STEP, HEAVIER], "free", True),
        ([SUBSTEPS, BOX, SLEEP, STEP, HEAVIER], "contact", False),
        ([SUBSTEPS, BOX, HEAVIER, SLEEP, STEP], "free", False),
        ([SUBSTEPS, BOX, STEP, HEAVIER], "free", False),
        ([BOX, SLEEP, STEP, HEAVIER], "free", False),
    ],
)
def test_what_sleeps_keeps_its_weight(calls: list[Call], phase: str, expected: bool):
    assert is_stated(calls, "base.0.0", 1e-6, phase) == expected


TREE = {"linkJointTypes": [0, 4, 4, 4], "linkParentIndices": [0, 1, 0, 3]}


@pytest.mark.parametrize(
    ("robot", "links", "expected"),
    [
        # Links with joints of their own are numbered as they are given here, and after their parents there.
        (call(1, "createMultiBody", 0, flags=8, **TREE), (0, 1), True),
        (call(1, "createMultiBody", 0, flags=8, **TREE), (-1, 3), True),
        (call(1, "createMultiBody", 0, flags=8, **TREE), (1, 2), False),
        (call(1, "createMultiBody", 0, flags=0, **TREE), (0, 1), False),
        (
            call(1, "createMultiBody", 0, flags=8, linkJointTypes=[0, 0, 4], linkParentIndices=[0, 0, 1]),
            (0, 1),
            True,
        ),
        (
            call(1, "createMultiBody", 0, flags=8, linkJointTypes=[0, 0, 4], linkParentIndices=[0, 0, 1]),
            (0, 2),
            False,
        ),
        (
            call(
                1,
                "createMultiBody",
                0,
                flags=8 | 131072,
                linkJointTypes=[0, 0, 4],
                linkParentIndices=[0, 0, 1],
            ),
            (0, 2),
            True,
        ),
        (call(1, "loadURDF", "quadruped/spirit40.urdf", flags=8 | 131072), (2, 3), True),
        (call(1, "loadURDF", "quadruped/spirit40.urdf", flags=8 | 524288), (2, 3), False),
        (call(1, "loadURDF", "quadruped/minitaur.urdf", flags=8 | 131072), (2, 10), True),
        (call(1, "loadURDF", "quadruped/minitaur.urdf", flags=8 | 131072), (1, 2), False),
        (call(1, "loadURDF", "quadruped/minitaur.urdf", flags=8), (1, 2), True),
    ],
)
def test_fixed_joints_tie_links_however_they_are_numbered(
    robot: Call, links: tuple[int, int], expected: bool
):
    calls = [BOX, robot, call(2, "getContactPoints")]
    assert is_known(calls, "links", [((1, links[0]), (1, links[1]))], []) == expected


@pytest.mark.parametrize(
    ("asked", "missing", "expected"),
    [
        ({"linkIndexA": 13}, [((0, 12), (0, 13))], True),
        ({"linkIndexA": 12}, [((0, 12), (0, 13))], True),
        ({"linkIndexA": 11}, [((0, 12), (0, 13))], False),
        ({}, [((0, 12), (0, 13))], False),
        ({"linkIndexA": 13}, [((0, 12), (1, 13))], False),
    ],
)
def test_contacts_of_a_body_with_itself_are_asked_for_by_either_link(
    asked: dict[str, int], missing: list[Any], expected: bool
):
    calls = [ARM, call(2, "getContactPoints", bodyA={"$": 0}, **asked)]
    assert is_known(calls, "links", [], missing) == expected
    assert not is_known(calls, "links", missing, [])
    (a, b) = missing[0]
    points = [[0, a[0], b[0], a[1], b[1]], [0, 0, 1, 13, 2]]
    second = expected and asked["linkIndexA"] == b[1]
    assert is_known(calls, ".len", points[1:], points) == second
    assert not is_known(calls, ".len", points, points[1:])


@pytest.mark.parametrize(
    ("name", "field", "error", "phase", "expected"),
    [
        ("reacher", "velocities.1.0", 2e-6, "contact", True),
        ("reacher", "velocities.0.0", 2e-6, "contact", False),
        ("reacher", "base.1.0", 2e-6, "contact", False),
        ("reacher", "velocities.1.0", 2e-3, "contact", False),
        ("swimmer", "velocities.1.0", 2e-6, "contact", False),
    ],
)
def test_arm_and_target_of_a_file_are_one_island(
    name: str, field: str, error: float, phase: str, expected: bool
):
    robot = call(3, "loadMJCF", f"mjcf/{name}.xml")
    assert is_stated([BOX, robot], field, error, phase) == expected
    assert not is_stated([robot], field, error, phase)


@pytest.mark.parametrize(
    ("calls", "field", "error", "deepest", "expected"),
    [
        ([ARM, OTHER, FIX], "base.0.3", 1e-6, 0.0, True),
        ([ARM, OTHER, FIX], "base.1.3", 1e-6, 0.0, False),
        ([ARM, OTHER, FIX], "base.0.3", 1e-3, 0.0, False),
        ([ARM, OTHER, FIX], "base.0.3", 1e-6, -1e-4, False),
        ([ARM, OTHER], "base.0.3", 1e-6, 0.0, False),
        ([ARM, FIX], "base.0.3", 1e-6, 0.0, False),
        ([ARM, OTHER, call(4, "changeDynamics", {"$": 0}, -1, restitution=0)], "base.0.3", 1e-6, 0.0, False),
    ],
)
def test_islands_of_a_robot_that_was_freed_are_renumbered_after_a_contact(
    calls: list[Call], field: str, error: float, deepest: float, expected: bool
):
    assert is_stated(calls, field, error, "contact", deepest) == expected


@pytest.mark.parametrize(
    ("cone", "rolling", "field", "expected"),
    [(0, 0.1, ".0.10", True), (0, 0.1, ".0.9", False), (1, 0.1, ".0.10", False), (0, 0.0, ".0.12", False)],
)
def test_rolling_friction_is_reported_as_friction(cone: int, rolling: float, field: str, expected: bool):
    calls = [
        call(0, "createMultiBody", 1),
        call(1, "setPhysicsEngineParameter", enableConeFriction=cone),
        call(2, "changeDynamics", {"$": 0}, -1, rollingFriction=rolling),
        call(3, "getContactPoints"),
    ]
    point = [0, 0, 1, -1, -1, [0.0] * 3, [0.0] * 3, [0.0, 0.0, 1.0], 0.0, 10.0, 2.5]
    place = Place(field, 0.5, 2.5)
    found = Difference(3, "getContactPoints", place, "contact", whole=([point], [point]))
    assert bool(statement(calls, found)) == expected
