"""Which differences of what is drawn, touched and hit the fuzzer takes for known."""

from __future__ import annotations

from typing import Any

import pytest
from tests.differ.test_known import BODY, BOX, CUBE, PROBE, REMOVE, RESTORE, SAVE, STEP, is_known
from tests.differ.test_programs import call
from tools.differ.causes.known import statement
from tools.differ.compare import Difference
from tools.differ.programs import Call
from tools.differ.values import Place

GIVEN = {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}


@pytest.mark.parametrize(
    ("shape", "visuals", "nearer", "label", "expected"),
    [
        (GIVEN, [-1], 90, 1, True),
        (GIVEN, [-1], 90, 1 + (1 << 24), True),
        (GIVEN, [{"$": 2}], 90, 1, False),
        (GIVEN, [-1], 70, 1, False),
        (GIVEN, [-1], 90, 0, False),
        (GIVEN, [-1], 90, -1, False),
        ({"fileName": "cube.obj"}, [-1], 90, 1, False),
    ],
)
def test_vertices_of_collision_shapes_are_drawn(
    shape: dict[str, Any], visuals: list[Any], nearer: int, label: int, expected: bool
):
    made = [call(1, "createCollisionShape", 5, **shape), call(2, "createVisualShape", 3)]
    links = {"linkCollisionShapeIndices": [{"$": 1}], "linkVisualShapeIndices": visuals}
    body = call(3, "createMultiBody", 1, -1, -1, **links)
    calls = [BOX, *made, body, call(4, "getCameraImage")]
    assert is_known(calls, "segments", f"90 of 768 differ, {nearer} are nearer: -1", label) == expected


def test_vertices_of_a_base_are_drawn():
    made = [call(1, "createCollisionShape", 5, **GIVEN), call(3, "createMultiBody", 1, {"$": 1}, -1)]
    calls = [*made, call(4, "getCameraImage")]
    assert is_known(calls, "segments", "90 of 768 differ, 90 are nearer: -1", 0)


REACHER, PENDULUM = call(1, "loadMJCF", "mjcf/reacher.xml"), call(2, "loadMJCF", "mjcf/inverted_pendulum.xml")
CUBES = [call(3, "createMultiBody", 1), call(4, "createMultiBody", 1)]
BARE_ARM = call(5, "createMultiBody", 1, linkCollisionShapeIndices=[-1], linkJointTypes=[0])


@pytest.mark.parametrize(
    ("calls", "difference", "expected"),
    [
        ([REACHER, STEP, PROBE], 1e-7, True),
        ([REACHER, STEP, PROBE], 1e-3, False),
        ([PENDULUM, STEP, PROBE], 1e-7, False),
        ([PENDULUM, CUBES[0], STEP, PROBE], 1e-7, True),
        ([*CUBES, STEP, PROBE], 1e-7, False),
        ([BARE_ARM, CUBES[0], STEP, PROBE], 1e-7, True),
        ([BARE_ARM, STEP, PROBE], 1e-7, False),
    ],
)
def test_links_without_shapes_make_islands_of_bodies(calls: list[Call], difference: float, expected: bool):
    place = Place("positions.1.2", [0.0], [difference], difference)
    found = Difference(len(calls) - 1, "@probe", place, "free")
    assert bool(statement(calls, found)) == expected
    later = Difference(len(calls) - 1, "@probe", place, "contact")
    assert not statement(calls, later)


@pytest.mark.parametrize(
    ("fraction", "x", "normal", "length", "expected"),
    [
        (0.503, 0.9, [0.28, -0.96, 0.0], 1.0, True),
        (0.497, 0.9, [0.28, -0.96, 0.0], 1.0, False),
        (0.503, 1.1, [0.28, -0.96, 0.0], 1.0, False),
        (0.503, 0.9, [0.22, -0.9755, 0.0], 1.0, True),
        (0.503, 0.9, [0.0, -1.0, 0.0], 1.0, False),
        # The place is not where the fraction says.
        (0.503, 0.9, [0.28, -0.96, 0.0], 1.01, False),
    ],
)
def test_rays_end_within_the_margin_before_a_face(
    fraction: float, x: float, normal: list[float], length: float, expected: bool
):
    face, further = [0.28, -0.96, 0.0], x * 1e-3 / 0.28
    hits = [[0, -1, 0.5, [0.0, 0.0, 0.0], face], [0, -1, fraction, [further, 0.0, 0.0], normal]]
    ray = call(51, "rayTest", [0.0] * 3, [length * further / 0.003, 0.0, 0.0])
    assert is_known([BOX, STEP, ray], "fraction", *hits) == expected


SORTED = call(1, "setPhysicsEngineParameter", deterministicOverlappingPairs=1)
CONTACT, OTHER = ([0, body, 0, -1, -1, [0.0] * 3, [0.0] * 3, [0.0, 0.0, 1.0], 0.0] for body in (1, 2))


@pytest.mark.parametrize(
    ("before", "ours", "expected"),
    [
        ([SORTED], [OTHER, CONTACT], True),
        ([], [OTHER, CONTACT], False),
        ([SORTED], [OTHER, [*CONTACT[:8], 0.1]], False),
    ],
)
def test_contacts_may_be_in_another_order_where_pairs_are_sorted(
    before: list[Call], ours: list[Any], expected: bool
):
    calls = [BOX, *before, call(2, "getContactPoints")]
    whole = ([CONTACT, OTHER], ours)
    found = Difference(len(calls) - 1, "getContactPoints", Place(".0.1", 1, 2), "free", whole=whole)
    assert bool(statement(calls, found)) == expected


LIMITED = [
    call(0, "createMultiBody", 1, linkJointTypes=[4], linkParentIndices=[0]),
    call(1, "createMultiBody", 1),
    call(2, "changeDynamics", {"$": 0}, 0, jointLowerLimit=0, jointUpperLimit=1),
]
TIED_TO_IT = call(3, "createConstraint", {"$": 0}, -1, {"$": 1}, -1, 4)


@pytest.mark.parametrize(
    ("calls", "bodies", "expected"),
    [(LIMITED, (0,), True), (LIMITED, (0, 1), False), ([*LIMITED, TIED_TO_IT], (0, 1), True)],
)
def test_only_bodies_that_a_cause_reaches_may_differ(
    calls: list[Call], bodies: tuple[int, ...], expected: bool
):
    place = Place("base.0.0", 1.0, 2.0)
    found = Difference(len(calls), "@probe", place, "free", bodies=bodies)
    assert bool(statement([*calls, PROBE], found)) == expected


SENSOR = call(1, "loadURDF", "a1/a1.urdf")


@pytest.mark.parametrize(
    ("calls", "error", "expected"),
    [
        ([SENSOR], 1e-3, True),
        ([SENSOR], 3e-3, False),
        ([call(1, "loadURDF", "quadruped/minitaur_v1.urdf")], 1e-3, False),
        (
            [
                call(1, "loadURDF", "quadruped/minitaur_v1.urdf"),
                call(2, "changeDynamics", {"$": 1}, 7, collisionMargin=0.02),
            ],
            1e-2,
            True,
        ),
        ([call(1, "loadURDF", CUBE)], 1e-3, False),
        ([call(1, "loadURDF", "a1/a1.urdf", globalScaling=3.0)], 1e-3, False),
    ],
)
def test_boxes_thinner_than_their_margins_are_anywhere(calls: list[Call], error: float, expected: bool):
    said = [[0, 0, 1, -1, -1, [0.0] * 3, [0.0] * 3, [1.0, 0.0, 0.0], gap] for gap in (0.3, 0.3 - error)]
    asked = [BOX, *calls, call(9, "getClosestPoints", {"$": 1}, BODY, 1.0)]
    assert is_known(asked, "distance", *said) == expected


@pytest.mark.parametrize(
    ("file", "flags", "other", "expected"),
    [
        ("quadruped/minitaur_fixed_all.urdf", 8, 1, True),
        ("quadruped/minitaur_fixed_all.urdf", 0, 1, False),
        ("quadruped/minitaur_fixed_all.urdf", 8, 0, False),
        ("quadruped/minitaur.urdf", 8, 1, False),
    ],
)
def test_what_fixed_joints_tie_does_not_touch_itself(file: str, flags: int, other: int, expected: bool):
    calls = [BOX, call(1, "loadURDF", file, flags=flags), call(2, "getContactPoints")]
    touching = [((other, -1), (1, 4))]
    assert is_known(calls, "links", touching, []) == expected
    assert not is_known(calls, "links", [], touching)
    points = [[0, other, 1, -1, 4], [0, 0, 1, -1, -1]]
    assert is_known(calls, ".len", points, points[1:]) == expected
    assert not is_known(calls, ".len", points, [])


@pytest.mark.parametrize(
    ("links", "flags", "expected"),
    [
        ((0, 2), 8, True),
        ((3, 5), 8192 | 8, True),
        ((2, 3), 8, False),
        ((-1, 2), 8, False),
        ((0, 2), 0, False),
        ((0, 6), 8, False),
    ],
)
def test_what_fixed_joints_tie_in_a_robot_does_not_touch(links: tuple[int, int], flags: int, expected: bool):
    robot = call(1, "loadURDF", "TwoJointRobot_w_fixedJoints.urdf", flags=flags)
    calls = [BOX, robot, call(2, "getContactPoints")]
    assert is_known(calls, "links", [((1, links[0]), (1, links[1]))], []) == expected
    points = [[0, 1, 1, *links], [0, 0, 1, -1, -1]]
    assert is_known(calls, ".len", points, points[1:]) == expected


@pytest.mark.parametrize(
    ("calls", "text", "expected"),
    [
        (
            [BOX, SAVE, REMOVE, BOX, RESTORE],
            "Couldn't restore state. Body 0 has 1 joints; it had 2 joints.",
            True,
        ),
        ([BOX, SAVE, BOX, RESTORE], "Couldn't restore state. Body 0 has 1 joints; it had 2 joints.", False),
        ([BOX, SAVE, REMOVE, BOX, RESTORE], "Couldn't restore state. No such state.", False),
    ],
)
def test_states_that_fit_no_body_are_refused(calls: list[Call], text: str, expected: bool):
    assert is_known(calls, "ok/error", [None], ["error", text]) == expected


@pytest.mark.parametrize(
    ("joint", "target", "expected"),
    [(0, [1, 0, 0, 0], True), (0, [0.6, 0, 0, 0.8], False), (1, [1, 0, 0, 0], False)],
)
def test_motors_of_ball_joints_turn_half_a_turn_either_way(joint: int, target: list[float], expected: bool):
    arm = call(0, "createMultiBody", 0, linkJointTypes=[2, 0], linkParentIndices=[0, 1])
    aim = call(1, "setJointMotorControlMultiDof", BODY, joint, 2, targetPosition=target)
    assert is_known([arm, aim, STEP, PROBE], "velocities.0.2", 149.0, -149.0) == expected


@pytest.mark.parametrize(
    ("function", "file", "ours", "expected"),
    [
        ("loadMJCF", "mjcf/ant.xml", [70, 70, 70, 255], True),
        ("loadMJCF", "mjcf/ant.xml", [70, 120, 70, 255], False),
        ("loadMJCF", "mjcf/sphere.xml", [70, 70, 70, 255], False),
        ("loadURDF", "r2d2.urdf", [70, 70, 70, 255], False),
    ],
)
def test_capsules_by_two_points_are_shaded_otherwise(
    function: str, file: str, ours: list[int], expected: bool
):
    calls = [call(0, function, file), call(1, "getCameraImage", shadow=0)]
    assert is_known(calls, "colour", "9 of 16 differ: [90, 90, 90, 255] of 0", ours) == expected


@pytest.mark.parametrize("kind", [2, 4, 7])
@pytest.mark.parametrize(
    ("field", "said", "ours"),
    [
        ("depth", "9 of 16 differ: 0.9 of 0", 0.8),
        ("segments", "90 of 768 differ, 85 are nearer: 1", 0),
        ("colour", "9 of 16 differ: [90, 90, 90, 255] of 0", [70, 70, 70, 255]),
    ],
)
def test_round_shapes_that_scripts_make_are_as_in_pybullet(kind: int, field: str, said: str, ours: Any):
    made = [call(0, "createVisualShape", kind), call(1, "createMultiBody", 1, -1, {"$": 0})]
    assert not is_known([*made, call(3, "getCameraImage", shadow=0)], field, said, ours)
