"""A step resumed after constraints have come or gone is the same as one that is prepared anew."""

from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

import pybullet as p
import pybullet_data
from carom.engine.engine import Engine
from carom.world.world import World
from pybullet._clients.clients import client_of

_CUBES = 3
_NAMES = ("position", "velocity", "motor_impulse")

change = st.one_of(
    st.tuples(st.just("tie"), st.integers(0, _CUBES - 1), st.integers(-1, _CUBES - 1)),
    st.tuples(st.just("untie"), st.integers(0, 5)),
    st.tuples(st.just("pull"), st.integers(0, 5), st.floats(1.0, 50.0)),
    st.tuples(
        st.just("parameter"), st.sampled_from([{"numSolverIterations": 7}, {"numSubSteps": 2}, {"erp": 0.5}])
    ),
    st.tuples(st.just("gravity"), st.sampled_from([-10.0, -2.0, 3.0])),
    st.sampled_from([("body",), ("look",), ("detect",), ("step",), ("step",), ("step",)]),
)


@pytest.fixture(scope="module", autouse=True)
def clients() -> Iterator[None]:
    """Client 0 resumes steps; client 1 prepares each step anew."""
    assert [p.connect(p.DIRECT), p.connect(p.DIRECT)] == [0, 1]
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    yield
    p.disconnect(1)
    p.disconnect(0)


def scene(client: int) -> list[int]:
    p.resetSimulation(physicsClientId=client)
    p.setPhysicsEngineParameter(numSolverIterations=20, numSubSteps=0, erp=0.2, physicsClientId=client)
    p.setGravity(0, 0, -10, physicsClientId=client)
    p.loadURDF(f"{pybullet_data.getDataPath()}/plane.urdf", physicsClientId=client)
    return [add_cube(client, place) for place in range(_CUBES)]


def add_cube(client: int, place: int) -> int:
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=client)
    return p.createMultiBody(1, shape, basePosition=[0.3 * place, 0, 0.11], physicsClientId=client)


def perform(client: int, cubes: list[int], ties: list[int], step: tuple[Any, ...]) -> None:
    kind, *arguments = step
    if kind == "tie":
        first, second = arguments
        other = -1 if second in (-1, first) else cubes[second]
        frames: tuple[list[float], ...] = ([0, 0, 0], [0.1, 0, 0.1], [0.2, 0.1, 0.3])
        ties.append(
            p.createConstraint(
                cubes[first], -1, other, -1, p.JOINT_POINT2POINT, *frames, physicsClientId=client
            )
        )
    elif kind == "untie" and ties:
        p.removeConstraint(ties.pop(arguments[0] % len(ties)), physicsClientId=client)
    elif kind == "pull" and ties:
        tie = ties[arguments[0] % len(ties)]
        p.changeConstraint(tie, maxForce=arguments[1], physicsClientId=client)
    elif kind == "parameter":
        p.setPhysicsEngineParameter(**arguments[0], physicsClientId=client)
    elif kind == "gravity":
        p.setGravity(0, 0, arguments[0], physicsClientId=client)
    elif kind == "body":
        add_cube(client, p.getNumBodies(physicsClientId=client))
    elif kind == "look":
        p.getContactPoints(cubes[0], physicsClientId=client)
    elif kind == "detect":
        p.performCollisionDetection(physicsClientId=client)
    elif kind == "step":
        if client == 1:
            client_of(1).world.scene_changed()
        p.stepSimulation(physicsClientId=client)


def bits(world: World) -> dict[str, bytes]:
    return {name: getattr(world, name).tobytes() for name in _NAMES}


@given(st.lists(change, min_size=10, max_size=40))
@settings(max_examples=cases(60), deadline=None)
def test_same_bits_as_steps_prepared_anew(changes: list[tuple[Any, ...]]) -> None:
    check_bits(changes, [scene(client) for client in (0, 1)])


_TIE, _STEP, _UNTIE = ("tie", 0, -1), ("step",), ("untie", 0)


@pytest.mark.parametrize("alone", [False, True], ids=["on a plane", "nothing to touch"])
@pytest.mark.parametrize(
    "changes",
    [
        [_TIE, _TIE, _STEP, _UNTIE, _STEP, _UNTIE, _STEP],
        [_STEP, _TIE, _STEP, _UNTIE, _STEP, _TIE, _STEP],
        [_TIE, _STEP, _UNTIE, _TIE, _STEP],
        [_TIE, _STEP, _UNTIE, ("parameter", {"numSubSteps": 2}), _TIE, _STEP],
    ],
)
def test_numbers_of_constraints(changes: list[tuple[Any, ...]], alone: bool) -> None:
    cubes = [[add_lone_cube(client)] if alone else scene(client) for client in (0, 1)]
    check_bits(changes, cubes)


def add_lone_cube(client: int) -> int:
    scene(client)
    p.resetSimulation(physicsClientId=client)
    return add_cube(client, 0)


def check_bits(changes: list[tuple[Any, ...]], cubes: list[list[int]]) -> None:
    ties: list[list[int]] = [[], []]
    for step in [*changes, ("step",)]:
        for client in (0, 1):
            perform(client, cubes[client], ties[client], step)
    assert bits(client_of(0).world) == bits(client_of(1).world)


def test_a_step_after_the_same_number_of_constraints_prepares_nothing() -> None:
    cubes = scene(0)
    world = client_of(0).world
    prepared = []
    prepare = world.engine.prepare

    def count(*, watched: bool = False) -> None:
        prepared.append(watched)
        prepare(watched=watched)

    world.engine.prepare = count  # type: ignore[method-assign]
    for _ in range(3):
        ties: list[int] = []
        perform(0, cubes, ties, ("tie", 0, -1))
        p.stepSimulation()
        perform(0, cubes, ties, ("untie", 0))
    assert len(prepared) == 1


def test_a_step_without_a_constraint_that_has_gone_is_not_prepared_anew(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    cubes, resumed, resume = scene(0), [], Engine.resume
    monkeypatch.setattr(Engine, "resume", lambda *them: resumed.append(resume(*them)) or resumed[-1])
    p.stepSimulation()
    ties: list[int] = []
    for change in (("tie", 0, -1), ("untie", 0), ("tie", 1, -1)):
        perform(0, cubes, ties, change)
        p.stepSimulation()
    # For the first constraint there was no room yet.
    assert resumed[-2:] == [True, True]
