"""Functions that the native library tries first do what Python does, bit for bit and error for error."""

from __future__ import annotations

import gc
import re
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import suppress
from math import inf, nan, sqrt
from random import Random
from types import FunctionType
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.fuzz.values import spoiled
from tests.rings import few
from tests.thorough.profiles import cases

import pybullet as p
import pybullet_data
from carom.layouts.dynamics_parameters import OF_BODY, SURFACE
from pybullet._calls import quick
from pybullet._calls.builtin import exports
from pybullet._clients.clients import clients

SEED = 7
numbers = st.floats(-1e3, 1e3)
vectors = st.lists(numbers, min_size=3, max_size=3)
quaternions = st.lists(numbers, min_size=4, max_size=4).filter(lambda q: sum(x * x for x in q) > 1e-3)
# Arguments of each kind that are not spoiled.
ARGUMENTS: dict[str, st.SearchStrategy[Any]] = {
    "3": vectors, "4": quaternions, "q": quaternions, "r": numbers, "i": st.integers(-1, 2),
    "b": st.integers(0, 1), "c": st.just(0), "-": st.just(0),
    "v": st.one_of(st.none(), st.lists(numbers, min_size=3, max_size=3)),
    "s": st.one_of(
        st.lists(st.integers(-1, 7)), st.lists(st.integers(0, 6)).map(tuple), st.just(range(7))
    ),
}  # fmt: skip
MATHS = [name for name, (_, kinds, _) in quick._KERNELS.items() if "c" not in kinds]
READING = [
    *("getBasePositionAndOrientation", "getBaseVelocity", "getLinkState", "getLinkStates"),
    *("getJointState", "getJointStates", "getJointStateMultiDof", "getJointStatesMultiDof"),
    *("getContactPoints", "getClosestPoints", "getOverlappingObjects"),
    *("getAABB", "getNumBodies", "getBodyUniqueId", "getNumJoints", "getBodyInfo"),
    "isConnected",
]
WRITING = [name for name in quick._KERNELS if name not in (*MATHS, *READING)]


def _in_python(name: str) -> Callable[..., Any]:
    return exports[name].function


def _outcome(function: Callable[..., Any], *arguments: Any, **keywords: Any) -> Any:
    try:
        return repr(function(*arguments, **keywords))
    except Exception as problem:
        return type(problem), str(problem)


def _scene(client: int) -> None:
    p.setGravity(0, 0, -10, physicsClientId=client)
    p.loadURDF(f"{pybullet_data.getDataPath()}/kuka_iiwa/model.urdf", physicsClientId=client)
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=client)
    p.createMultiBody(1.0, box, basePosition=[2, 0, 3], physicsClientId=client)
    p.createMultiBody(0.0, box, basePosition=[2, 0, 2.805], physicsClientId=client)
    for _ in range(3):
        p.stepSimulation(client)


def _state(client: int) -> list[bytes]:
    world = clients[client].world
    contacts, count = world.contact_arrays.contacts.numpy, world.contact_arrays.contact_count
    starts = [contacts[name][0, :count].tobytes() for name in ("contact_impulse", "contact_warm_start")]
    return starts + [
        memory.tobytes()
        for memory in (
            world.position_memory,
            world.velocity_memory,
            world.link_force_memory,
            world.link_pose_memory,
            world.motor_memory,
            world.pd_memory,
            world.joint_torque_memory,
        )
    ]


@pytest.fixture
def two() -> Iterator[tuple[int, int]]:
    """Two connections with the same bodies."""
    pair = p.connect(p.DIRECT), p.connect(p.DIRECT)
    for client in pair:
        _scene(client)
    yield pair
    for client in pair:
        p.disconnect(client)


@pytest.fixture
def one() -> Iterator[int]:
    client = p.connect(p.DIRECT)
    _scene(client)
    yield client
    p.disconnect(client)


def _takes_no_python(name: str, *arguments: Any, **keywords: Any) -> bool:
    """Whether a call gets by without the Python function."""
    function: Any = exports[name].function
    called: list[bool] = []
    own = function.__code__

    def instead(*_: Any, **__: Any) -> None:
        raise AssertionError

    assert isinstance(instead, FunctionType)
    function.__code__ = instead.__code__
    try:
        getattr(p, name)(*arguments, **keywords)
    except AssertionError:
        called.append(True)
    finally:
        function.__code__ = own
    return not called


CALLS: dict[str, tuple[Any, ...]] = {
    "getQuaternionFromEuler": ([1, 2.0, 3],),
    "getEulerFromQuaternion": ((0, 0, 0.6, 0.8),),
    "getMatrixFromQuaternion": (np.array([0, 0, 0.6, 0.8]),),
    "multiplyTransforms": ([1, 2, 3], [0, 0, 0.6, 0.8], np.array([1, 2, 3], dtype=np.float32), (0, 0, 0, 1)),
    "invertTransform": ([1, 2, 3], [0, 0, 0.6, 0.8]),
    "rotateVector": ([0, 0, 0.6, 0.8], [1, 2, 3]),
    "getQuaternionFromAxisAngle": ([1, 2, 3], np.float64(0.5)),
    "getAxisAngleFromQuaternion": ([0, 0, 0.6, 0.8],),
    "getQuaternionSlerp": ([0, 0, 0.6, 0.8], [0, 0, 0, 1], 0.25),
    "getDifferenceQuaternion": ([0, 0, 0.6, 0.8], [0, 0, 0, 1]),
    "getAxisDifferenceQuaternion": ([0, 0, 0.6, 0.8], [0, 0, 0, 1]),
    "calculateVelocityQuaternion": ([0, 0, 0.6, 0.8], [0, 0, 0, 1], 0.25),
    "getBasePositionAndOrientation": (1,),
    "getBaseVelocity": (1,),
    "getLinkState": (0, 3, 1, 1),
    "getLinkStates": (0, [3, 1], 1, 1),
    "performCollisionDetection": (),
    "getContactPoints": (1,),
    "getClosestPoints": (0, 1, 10.0),
    "getOverlappingObjects": ([-9, -9, -9], [9, 9, 9]),
    "applyExternalForce": (0, 3, [1, 2, 3], [0, 0, 1], p.LINK_FRAME),
    "applyExternalTorque": (0, -1, [1, 2, 3], p.WORLD_FRAME),
    "resetBasePositionAndOrientation": (1, [1, 2, 3], [0, 0, 0.6, 0.8]),
    "resetBaseVelocity": (1, [1, 2, 3], None),
    "getJointState": (0, 3),
    "getJointStates": (0, range(7)),
    "getJointStateMultiDof": (0, 3),
    "getJointStatesMultiDof": (0, [3, 1]),
    "setJointMotorControl2": (0, 3, p.POSITION_CONTROL, 0.5, 0.25, 5, 0.125, 0.75, 2),
    "setJointMotorControlArray": (0, [3, 1, 2], p.POSITION_CONTROL, [0.5, 0.25, 0.125], None, (5, 6.0, 7)),
    "setJointMotorControlMultiDof": (0, 3, p.POSITION_CONTROL, [0.5], [0.25], (5,), 0.125, [0.75], 2),
    "setJointMotorControlMultiDofArray": (
        0,
        [3, 1],
        p.POSITION_CONTROL,
        [[0.5], (1,)],
        [[0], []],
        [[5], [6]],
    ),
    "changeDynamics": (0, 3, -1, 0.5, 0.25, 0.125, 0.75),
    "resetJointState": (0, 3, 0.5),
    "stepSimulation": (),
    "getAABB": (0, 3),
    "isConnected": (),
    "getNumBodies": (),
    "getBodyUniqueId": (1,),
    "getNumJoints": (0,),
    "getBodyInfo": (0,),
}


@pytest.mark.parametrize("name", quick._KERNELS)
def test_the_usual_case_needs_no_python(name: str, one: int) -> None:
    own = {} if name in MATHS else {"physicsClientId": one}
    getattr(p, name)(*CALLS[name], **own)
    # Where kernels are is known when Python has been asked once.
    _in_python(name)(*CALLS[name], **own)
    assert _takes_no_python(name, *CALLS[name], **own)
    names = exports[name].code.co_varnames
    assert _takes_no_python(name, **dict(zip(names, CALLS[name], strict=False)), **own)


@pytest.mark.parametrize("name", few([*MATHS, *READING], 12))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=cases(20))
@given(data=st.data())
def test_results_are_those_of_python_to_the_last_bit(
    name: str, data: st.DataObject, two: tuple[int, int]
) -> None:
    kinds = quick._KERNELS[name][1]
    arguments = [data.draw(ARGUMENTS[kind]) for kind in kinds]
    assert _outcome(getattr(p, name), *arguments) == _outcome(_in_python(name), *arguments)


@pytest.mark.parametrize("name", WRITING)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=cases(20))
@given(data=st.data())
def test_worlds_are_left_as_python_leaves_them(name: str, data: st.DataObject, two: tuple[int, int]) -> None:
    kinds = quick._KERNELS[name][1]
    arguments = [data.draw(ARGUMENTS[kind]) for kind in kinds[:-1]]
    first, second = two
    ours = _outcome(getattr(p, name), *arguments, physicsClientId=first)
    assert ours == _outcome(_in_python(name), *arguments, physicsClientId=second)
    assert _state(first) == _state(second)


@pytest.mark.parametrize("name", few([name for name in quick._KERNELS if CALLS[name]], 12))
def test_odd_arguments_meet_what_they_meet_in_python(name: str, two: tuple[int, int]) -> None:
    random = Random(SEED)
    first, second = two
    names = exports[name].code.co_varnames
    own = name not in MATHS
    for _ in range(cases(100)):
        usual = [np.array(item).tolist() if isinstance(item, np.ndarray) else item for item in CALLS[name]]
        place, seed = random.randrange(len(usual)), random.random()
        outcomes = []
        for function, client in ((getattr(p, name), first), (_in_python(name), second)):
            arguments = list(usual)
            arguments[place] = spoiled(arguments[place], Random(seed))
            count = int(seed * 100) % (len(arguments) + 1)
            keywords = dict(zip(names[count:], arguments[count:], strict=False))
            keywords |= {"physicsClientId": client} if own else {}
            if seed > 0.95:
                keywords["nothing"] = 1
            if seed < 0.05:
                keywords[names[0]] = arguments[0]
            outcomes.append(_outcome(function, *arguments[:count], **keywords))
        first_outcome, second_outcome = (re.sub(r" at 0x\w+", "", str(outcome)) for outcome in outcomes)
        assert first_outcome == second_outcome
    assert _state(first) == _state(second)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=cases(20))
@given(
    st.integers(-1, 7),
    st.sampled_from([p.POSITION_CONTROL, p.VELOCITY_CONTROL, p.TORQUE_CONTROL, p.PD_CONTROL, 7]),
    st.dictionaries(
        st.sampled_from(["targetPosition", "targetVelocity", "positionGain", "velocityGain", "maxVelocity"]),
        st.floats(-5.0, 5.0),
    ),
    st.sampled_from([0.0, 1e-9, 5, 1e31, inf, nan]),
    st.booleans(),
)
def test_motors_are_set_as_python_sets_them(
    two: tuple[int, int], joint: int, mode: int, targets: dict[str, float], force: float, narrow: bool
) -> None:
    outcomes = []
    for call, client in zip((p.setJointMotorControl2, _in_python("setJointMotorControl2")), two, strict=True):
        if narrow:
            p.changeDynamics(0, 3, jointLowerLimit=-0.5, jointUpperLimit=0.5, physicsClientId=client)
        outcomes.append(_outcome(call, 0, joint, mode, **targets, force=force, physicsClientId=client))
    assert outcomes[0] == outcomes[1]
    assert _state(two[0]) == _state(two[1])


def test_states_of_all_kinds_of_joints_are_those_of_python(one: int) -> None:
    folder = pybullet_data.getDataPath()
    for file in ("humanoid/humanoid.urdf", "r2d2.urdf"):
        body = p.loadURDF(f"{folder}/{file}", [0, 5, 2], physicsClientId=one)
        joints = range(p.getNumJoints(body, one))
        for joint in joints[::2]:
            p.enableJointForceTorqueSensor(body, joint, True, one)
        for _ in range(3):
            p.stepSimulation(one)
        states = _in_python("getJointStates")(body, joints, one)
        assert any(any(wrench) for _, _, wrench, _ in states)
        assert _takes_no_python("getJointStates", body, joints, one)
        assert p.getJointStates(body, joints, one) == states
        for joint in joints:
            assert _takes_no_python("getJointState", body, joint, one)
            assert p.getJointState(body, joint, one) == states[joint]


FRICTION = ["lateralFriction", "spinningFriction", "rollingFriction", "restitution"]
SOFTNESS = ["contactStiffness", "contactDamping", "contactProcessingThreshold"]
DAMPING = ["linearDamping", "angularDamping", "maxJointVelocity"]


def _dynamics(client: int) -> list[Any]:
    world = clients[client].world
    shapes, model = world.contact_arrays.shapes.table.numpy, world.arrays.model.numpy
    surfaces = [shapes[field].tobytes() for field in SURFACE.values()]
    infos = [p.getDynamicsInfo(0, link, client) for link in range(-1, 7)]
    infos += [p.getDynamicsInfo(body, -1, client) for body in (1, 2)]
    return [
        infos,
        surfaces,
        [model[field].tobytes() for field in (*OF_BODY.values(), "link_mass", "link_inertia")],
    ]


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=cases(20))
@given(
    st.integers(-2, 7),
    st.dictionaries(st.sampled_from(FRICTION), st.floats(-1.0, 2.0)),
    st.dictionaries(st.sampled_from(SOFTNESS), st.floats(-1.0, 1e4)),
    st.dictionaries(st.sampled_from(DAMPING), st.floats(-1.0, 1.0)),
    st.dictionaries(st.sampled_from(["jointDamping", "mass", "frictionAnchor"]), st.integers(0, 1)),
    st.fixed_dictionaries({"mass": st.floats(-1.0, 1e3)}, optional={"localInertiaDiagonal": vectors}),
    st.integers(0, 5),
)
def test_dynamics_are_changed_as_python_changes_them(
    two: tuple[int, int],
    link: int,
    friction: dict[str, float],
    softness: dict[str, float],
    damping: dict[str, float],
    others: dict[str, float],
    weight: dict[str, Any],
    which: int,
) -> None:
    changes = [
        *(friction | softness, damping, friction | damping, friction | others),
        *(weight, weight | friction),
    ][which]
    first, second = two
    for body in (0, 1, 2):
        ours = _outcome(p.changeDynamics, body, link, **changes, physicsClientId=first)
        assert ours == _outcome(_in_python("changeDynamics"), body, link, **changes, physicsClientId=second)
    assert _dynamics(first) == _dynamics(second)


def test_friction_and_damping_need_no_python(one: int) -> None:
    p.resetBaseVelocity(1, [0, 0, 0], physicsClientId=one)
    for changes in (
        {"lateralFriction": 0.5, "restitution": 1, "contactProcessingThreshold": 0.1},
        {"linearDamping": 0.0, "angularDamping": 0, "maxJointVelocity": 50},
    ):
        assert _takes_no_python("changeDynamics", 1, -1, **changes, physicsClientId=one)


@pytest.mark.parametrize(
    "shape",
    [
        {"shapeType": p.GEOM_SPHERE, "radius": 0.3},
        {"shapeType": p.GEOM_SPHERE, "radius": 0.3, "collisionFramePosition": [0.1, 0.2, 0.3]},
        {"shapeType": p.GEOM_PLANE},
        {"shapeType": p.GEOM_CAPSULE, "radius": 0.1, "height": 0.5},
    ],
)
def test_boxes_are_those_of_python(one: int, shape: dict[str, Any]) -> None:
    shape_id = p.createCollisionShape(**shape, physicsClientId=one)
    for mass in (0.0, 1.0):
        body = p.createMultiBody(mass, shape_id, basePosition=[0, 0, 5], physicsClientId=one)
        for turn in ([0.1, 0.2, 0.3, 0.4], [0, 0, 0, 1], [1, 0, 0, 0]):
            p.resetBasePositionAndOrientation(body, [0.1, 7.0, 3.0], turn, one)
            seen = _in_python("getAABB")(body, -1, one)
            assert _takes_no_python("getAABB", body, physicsClientId=one)
            assert p.getAABB(body, physicsClientId=one) == seen


def test_bodies_are_told_as_they_come_and_go(one: int) -> None:
    for number in (1, 0, 2):
        p.removeBody(number, one)
        names = ("getNumBodies", "getBodyUniqueId", "getNumJoints", "getBodyInfo")
        for name in names:
            for place in (-1, 0, 1, 2, 3):
                arguments = (one,) if name == "getNumBodies" else (place, one)
                assert _outcome(getattr(p, name), *arguments) == _outcome(_in_python(name), *arguments)
    assert p.getNumBodies(one) == 0


class _Rude(float):
    def __float__(self) -> float:
        raise KeyError("rude")


def test_what_numbers_do_when_asked_is_done() -> None:
    with pytest.raises(KeyError, match="rude"):
        p.getQuaternionFromEuler([0.0, _Rude(1.0), 0.0])


@pytest.mark.parametrize("name", few(quick._KERNELS, 8))
def test_no_call_keeps_or_loses_what_it_is_given(name: str, one: int) -> None:
    call, good = getattr(p, name), list(CALLS[name])
    own = {} if name in MATHS else {"physicsClientId": one}
    bad = [*good[:-1], [1.0, float("nan"), 2.0]]
    calls: list[tuple[list[Any], dict[str, Any]]] = [(good, own), (bad, own), (good, {**own, "nothing": 1})]

    def many(count: int) -> None:
        for _ in range(count):
            for arguments, keywords in calls:
                with suppress(p.error, TypeError):
                    call(*arguments, **keywords)

    many(200)
    # Python keeps freed tuples for new ones; a collection lets go of them.
    gc.collect()
    before = sys.getallocatedblocks(), [sys.getrefcount(item) for item in good], sys.getrefcount(None)
    many(500)
    gc.collect()
    after = sys.getallocatedblocks(), [sys.getrefcount(item) for item in good], sys.getrefcount(None)
    assert after[0] - before[0] < 200
    assert after[1] == before[1]
    assert abs(after[2] - before[2]) < 200


def test_bodies_that_move_in_memory_are_found_again(one: int) -> None:
    for number in range(40):
        p.createMultiBody(1.0, basePosition=[number, 0, 9], physicsClientId=one)
        for body in range(p.getNumBodies(one)):
            for name in READING[:2]:
                assert getattr(p, name)(body, one) == _in_python(name)(body, one)
    for body in (0, 5, 3):
        p.removeBody(body, one)
        with pytest.raises(p.error):
            p.getBasePositionAndOrientation(body, one)
        position = p.getBasePositionAndOrientation(20, one)[0]
        assert position == (17.0, 0.0, 9.0)
    p.resetSimulation(physicsClientId=one)
    with pytest.raises(p.error):
        p.getBasePositionAndOrientation(20, one)
    assert p.createMultiBody(1.0, basePosition=[7, 0, 0], physicsClientId=one) == 0
    assert p.getBasePositionAndOrientation(0, one)[0] == (7.0, 0.0, 0.0)


def test_what_changes_the_world_waits_for_who_else_does(one: int) -> None:
    done = threading.Event()

    def place() -> None:
        p.resetBasePositionAndOrientation(1, [9, 9, 9], [0, 0, 0, 1], one)
        done.set()

    thread = threading.Thread(target=place)
    with clients[one].lock:
        thread.start()
        assert not done.wait(0.1)
        assert p.getBasePositionAndOrientation(1, one)[0] != (9.0, 9.0, 9.0)
    assert done.wait(10.0)
    thread.join()
    assert p.getBasePositionAndOrientation(1, one)[0] == (9.0, 9.0, 9.0)


def test_steps_are_those_of_python(two: tuple[int, int]) -> None:
    first, second = two
    for number in range(200):
        for client in two:
            p.applyExternalForce(1, -1, [0, 0, 5 * (number % 3)], [0, 0, 0], p.LINK_FRAME, client)
        assert p.stepSimulation(first) == _in_python("stepSimulation")(second)
        assert _state(first) == _state(second)
    assert clients[first].world.time == clients[second].world.time > 0.0


def test_steps_that_someone_follows_are_left_to_python(one: int) -> None:
    world = clients[one].world
    log = world.log("position")
    assert not _takes_no_python("stepSimulation", one)
    log.stop()
    assert _takes_no_python("stepSimulation", one)
    for parameter in ({"reportSolverAnalytics": 1}, {"numSubSteps": 2}):
        p.setPhysicsEngineParameter(**parameter, physicsClientId=one)
        assert not _takes_no_python("stepSimulation", one)
        p.setPhysicsEngineParameter(**dict.fromkeys(parameter, 0), physicsClientId=one)
        p.stepSimulation(one)
        assert _takes_no_python("stepSimulation", one)


@pytest.mark.parametrize("apart", [True, False])
def test_steps_that_fail_fail_as_in_python(two: tuple[int, int], apart: bool) -> None:
    outcomes = []
    for client, step in zip(two, (p.stepSimulation, _in_python("stepSimulation")), strict=True):
        for body in (1, 2) if apart else ():
            p.removeBody(body, client)
        p.stepSimulation(client)
        before = _state(client)
        clients[client].world.link_force[7, 3] = np.inf
        outcomes.append([_outcome(step, client), _state(client), before[2:4] == _state(client)[2:4]])
        outcomes[-1] += [step(client), _state(client), clients[client].world.time]
    assert outcomes[0] == outcomes[1]
    (kind, message), _, is_restored, *_ = outcomes[0]
    assert kind is p.error
    assert "not finite" in message
    assert is_restored


def test_steps_for_which_arrays_are_too_short_are_repeated(two: tuple[int, int]) -> None:
    for client, step in zip(two, (p.stepSimulation, _in_python("stepSimulation")), strict=True):
        box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=client)
        for number in range(60):
            p.createMultiBody(1.0, box, basePosition=[0.18 * number, 5, 0.2], physicsClientId=client)
            if number == 2:
                _in_python("stepSimulation")(client)
        for _ in range(5):
            step(client)
    assert _state(two[0]) == _state(two[1])


def test_a_step_lets_other_threads_run_and_keeps_them_out(one: int) -> None:
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=one)
    for number in range(300):
        p.createMultiBody(1.0, box, basePosition=[0.2 * number, 5, 0.2], physicsClientId=one)
    p.stepSimulation(one)
    stepping, seen = threading.Event(), 0

    def step() -> None:
        stepping.set()
        for _ in range(30):
            p.stepSimulation(one)
        stepping.clear()

    thread = threading.Thread(target=step)
    thread.start()
    stepping.wait()
    while stepping.is_set():
        seen += not clients[one].lock.acquire(blocking=False) or bool(clients[one].lock.release())
    thread.join()
    assert seen > 0


def test_calls_are_logged_as_ever(one: int, tmp_path: Any) -> None:
    log = p.startStateLogging(p.STATE_LOGGING_ALL_COMMANDS, str(tmp_path / "log"), physicsClientId=one)
    assert not _takes_no_python("applyExternalForce", *CALLS["applyExternalForce"], physicsClientId=one)
    p.applyExternalForce(*CALLS["applyExternalForce"], physicsClientId=one)
    p.stopStateLogging(log, one)
    assert _takes_no_python("applyExternalForce", *CALLS["applyExternalForce"], physicsClientId=one)


def test_a_closed_connection_is_closed() -> None:
    client = p.connect(p.DIRECT)
    _scene(client)
    p.getBasePositionAndOrientation(0, client)
    p.disconnect(client)
    with pytest.raises(p.error, match="Not connected"):
        p.getBasePositionAndOrientation(0, client)
    with pytest.raises(p.error, match="Not connected"):
        p.applyExternalForce(0, -1, [0, 0, 0], [0, 0, 0], p.WORLD_FRAME, client)


def test_lengths_of_rotations() -> None:
    tiny = [0.0, 0.0, 0.0, 1e-200]
    for name in ("getMatrixFromQuaternion", "getEulerFromQuaternion"):
        assert _outcome(getattr(p, name), tiny) == _outcome(_in_python(name), tiny)
    x, y, z, w = p.getQuaternionFromEuler([1, 2, 3])
    assert sqrt(x * x + y * y + z * z + w * w) == pytest.approx(1.0, abs=1e-15)


LAST_WORDS = """
import pybullet as p
p.connect(p.DIRECT)
p.createMultiBody(1.0)
p.getBasePositionAndOrientation(0)

class Last:
    def __del__(self, get=p.getBasePositionAndOrientation, push=p.applyExternalForce):
        for call in (lambda: get(0), lambda: push(0, -1, [1, 2, 3], [0, 0, 0], 2)):
            try:
                call()
            except BaseException:
                pass

p.last = last = Last()
last.itself = last
"""

TWICE = """
import sys
import pybullet as first
first.connect(first.DIRECT)
first.createMultiBody(1.0, basePosition=[1, 2, 3])
for name in [name for name in sys.modules if name.split(".")[0] == "pybullet"]:
    del sys.modules[name]
import pybullet as second
assert second is not first
second.connect(second.DIRECT)
second.createMultiBody(1.0, basePosition=[4, 5, 6])
for _ in range(3):
    assert first.getBasePositionAndOrientation(0)[0] == (1, 2, 3)
    assert second.getBasePositionAndOrientation(0)[0] == (4, 5, 6)
    assert second.getEulerFromQuaternion([0, 0, 0, 1]) == (0, 0, 0)
"""


@pytest.mark.parametrize("script", [LAST_WORDS, TWICE])
def test_processes_end_well(script: str) -> None:
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
