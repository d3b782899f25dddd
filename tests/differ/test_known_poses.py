"""Which differences in what is seen or reached from a pose the fuzzer takes for known."""

from __future__ import annotations

import math

import pytest
from tests.differ.test_known import PROBE, STEP, is_known
from tests.differ.test_programs import call
from tools.differ.causes.known import statement
from tools.differ.compare import Difference
from tools.differ.programs import Call
from tools.differ.values import Place

HALF = 0.7071067811865476
ROUND_LINK = {
    "linkOrientations": [[0, 0, HALF, HALF], [0, 0, HALF, HALF]],
    "linkInertialFrameOrientations": [[0, 0, 0, 1], [0, 0, 0, 1]],
    "linkParentIndices": [0, 1],
    "linkJointTypes": [0, 0],
}
ARM = call(0, "createMultiBody", 1, **ROUND_LINK)
RESET = call(1, "resetJointState", {"$": 0}, 0, 0.5)


@pytest.mark.parametrize(
    ("before", "target", "expected"),
    [
        ([ARM], [HALF, 0, 0, HALF], True),
        ([ARM], [0, 0, 0, 1], True),
        ([ARM], [0, 0, 0.6, 0.8], False),
        ([ARM, RESET], [HALF, 0, 0, HALF], False),
        ([call(0, "loadURDF", "cube_small.urdf")], [HALF, 0, 0, HALF], False),
    ],
)
def test_a_link_may_turn_either_way_to_what_is_half_a_turn_away(
    before: list[Call], target: list[float], expected: bool
):
    ask = call(2, "calculateInverseKinematics", {"$": 0}, 1, [5, 0, 0], targetOrientation=target)
    reach = call(3, "@reach", {"$": 0}, [1], {"whole": 2}, [[5, 0, 0]], target)
    assert is_known([*before, ask, reach], "worse", [5.2, 1.5, []], [5.3, 1.9, []]) == expected


@pytest.mark.parametrize(
    ("apart", "turned", "expected"), [(0.0, 1.7e-4, True), (1e-6, 1.7e-4, False), (0.0, 1e-3, False)]
)
def test_normals_of_rays_may_be_off_their_faces(apart: float, turned: float, expected: bool):
    hits = [[0, 6, 0.5, [0.0, 0.0, z], [x, 0.0, 1.0]] for x, z in ((0.0, 0.0), (turned, apart))]
    assert is_known([call(51, "rayTest", [0] * 3, [1] * 3)], "normal", *hits) == expected


@pytest.mark.parametrize(
    ("function", "matrix", "text", "expected"),
    [
        ("computeViewMatrix", [math.nan, 0.0], "The camera looks straight along cameraUpVector.", True),
        ("computeViewMatrix", [1.0, 0.0], "The camera looks straight along cameraUpVector.", False),
        ("computeViewMatrix", [math.nan, 0.0], "It needs 3 numbers.", False),
        ("computeProjectionMatrix", [math.nan, 0.0], "It looks straight along.", False),
    ],
)
def test_cameras_that_look_nowhere_are_refused(function: str, matrix: list[float], text: str, expected: bool):
    assert is_known([call(0, function)], "ok/error", [matrix], ["error", text]) == expected


CYLINDER = call(0, "createCollisionShape", 4)


@pytest.mark.parametrize(
    ("breaking", "function", "phase", "expected"),
    [
        ([0], "@probe", "contact", True),
        ([0], "getContactPoints", "contact", True),
        ([0], "getAABB", "contact", False),
        ([0], "@probe", "free", False),
        ([0.02, 0], "@probe", "contact", True),
        ([0, 0.02], "@probe", "contact", False),
        ([1e-9], "@probe", "contact", False),
        ([], "@probe", "contact", False),
    ],
)
def test_contacts_that_break_at_once_are_left_to_rounding(
    breaking: list[float], function: str, phase: str, expected: bool
):
    set_to = [
        call(n, "setPhysicsEngineParameter", contactBreakingThreshold=it) for n, it in enumerate(breaking)
    ]
    other = call(7, "setPhysicsEngineParameter", erp=0.2)
    calls = [*set_to, other, STEP, call(9, function)]
    difference = Difference(len(calls) - 1, function, Place("base.0.1", 1.0, 1.1, 1e-2), phase)
    assert (statement(calls, difference) is not None) == expected


@pytest.mark.parametrize(
    ("shape", "mass", "deepest", "error", "phase", "bodies", "expected"),
    [
        (CYLINDER, 1, -0.0038, 8e-6, "contact", (0,), True),
        (CYLINDER, 1, -0.0038, 8e-6, "contact", (1, 0), True),
        (call(0, "createCollisionShapeArray", shapeTypes=[2, 4]), 1, -0.0038, 8e-6, "contact", (0,), True),
        (CYLINDER, 1, -0.0015, 8e-6, "contact", (0,), False),
        (CYLINDER, 1, -0.0038, 1e-3, "contact", (0,), False),
        (CYLINDER, 1, -0.0038, 8e-6, "free", (0,), False),
        (CYLINDER, 1, -0.0038, 8e-6, "contact", (1,), False),
        (CYLINDER, 0, -0.0038, 8e-6, "contact", (1,), True),
        (call(0, "createCollisionShape", 3), 1, -0.0038, 8e-6, "contact", (0,), False),
    ],
)
def test_normals_at_edges_of_cylinders_are_of_another_search(
    shape: Call,
    mass: float,
    deepest: float,
    error: float,
    phase: str,
    bodies: tuple[int, ...],
    expected: bool,
):
    made = [call(1, "createMultiBody", mass, {"$": 0}), call(2, "createMultiBody", 1)]
    calls = [shape, *made, STEP, PROBE]
    difference = Difference(4, "@probe", Place("base.0.2", 0.0, error, error), phase, deepest, bodies)
    assert (statement(calls, difference) is not None) == expected


@pytest.mark.parametrize(
    ("calls", "theirs", "ours", "expected"),
    [
        (["removeBody"], 1, 0, True),
        (["removeBody"], 0, 1, False),
        (["removeBody"], 0, -1, False),
        (["resetSimulation"], 1, 0, False),
    ],
)
def test_textures_of_bodies_that_are_gone_may_not_be_counted(
    calls: list[str], theirs: int, ours: int, expected: bool
):
    before = [call(0, "loadURDF", "duck_vhacd.urdf"), *(call(1, name, {"$": 0}) for name in calls)]
    ask = call(3, "getVisualShapeData", {"$": 2}, flags=1)
    calls_made = [*before, call(2, "loadURDF", "domino/domino.urdf"), ask]
    assert is_known(calls_made, ".0.8", theirs, ours) == expected
