"""Logs of commands: what they hold, that they are replayed to the last bit, and what is made of rubbish."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.patience import until
from tests.thorough.profiles import cases

import pybullet as p
import pybullet_data
from carom.remote.values import pack
from pybullet._calls.detours import functions
from pybullet._logs import command_log
from pybullet._logs.command_log import COMMANDS, Command

ROBOT = "r2d2.urdf"

# Functions that log nothing because they change nothing, ...
QUESTIONS = ("get", "calculate", "compute", "ray", "read", "sync")
# ... because they are about the window, files or the log itself, or because their effect is logged.
OTHERS = {
    "removeAllUserParameters",
    "saveBullet",
    "saveWorld",
    "setRealTimeSimulation",
    "setVRCameraState",
    "startStateLogging",
    "stopStateLogging",
    "submitProfileTiming",
}


def start(path: Path, client: int = 0) -> Any:
    return p.startStateLogging(p.STATE_LOGGING_ALL_COMMANDS, str(path), physicsClientId=client)


def replay(path: Path, client: int = 0) -> Any:
    return p.startStateLogging(p.STATE_REPLAY_ALL_COMMANDS, str(path), physicsClientId=client)


@pytest.fixture
def world():
    p.connect(p.DIRECT)
    yield
    for client in range(4):
        if p.isConnected(client):
            p.disconnect(client)


def state(client: int = 0) -> Any:
    found: list[Any] = []
    for place in range(p.getNumBodies(client)):
        body = p.getBodyUniqueId(place, physicsClientId=client)
        found.append((body, p.getBodyInfo(body, physicsClientId=client)))
        found.append(p.getBasePositionAndOrientation(body, physicsClientId=client))
        found.append(p.getBaseVelocity(body, physicsClientId=client))
        joints = range(p.getNumJoints(body, client))
        found.append(p.getJointStates(body, joints, physicsClientId=client))
    found.append(p.getContactPoints(physicsClientId=client))
    found.append(p.getPhysicsEngineParameters(client))
    return found


def session(client: int = 0) -> None:
    """Calls in every form there is, with questions between them."""
    of_client: Any = {"physicsClientId": client}
    p.setAdditionalSearchPath(pybullet_data.getDataPath(), client)
    p.setGravity(0, 0, -9.81, client)
    p.loadURDF("plane.urdf", **of_client)
    robot = p.loadURDF(ROBOT, [0, 0, 0.6], physicsClientId=client)
    for _ in range(20):
        p.stepSimulation(client)
    p.setJointMotorControl2(robot, 2, p.VELOCITY_CONTROL, targetVelocity=4, force=8, **of_client)
    p.setJointMotorControl(robot, 3, p.VELOCITY_CONTROL, 2, 5, **of_client)
    p.setJointMotorControlArray(
        robot, np.array([6, 7]), p.VELOCITY_CONTROL, targetVelocities=np.full(2, 3.0), **of_client
    )
    vertices = np.array([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2]], dtype=float)
    hull = p.createCollisionShape(p.GEOM_MESH, vertices=vertices.tolist(), **of_client)
    falling = p.createMultiBody(0.5, hull, basePosition=np.array([1.0, 0, 1]), **of_client)
    held = p.createMultiBody(1, hull, basePosition=(2, 0, 1), **of_client)
    tie = p.createConstraint(
        held, -1, -1, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0, 0, 0], [2, 0, 1], **of_client
    )
    p.rayTest([0, 0, 3], [0, 0, -1], **of_client)
    for _ in range(10):
        p.applyExternalForce(falling, -1, (5, 0, 0), (0, 0, 0), p.LINK_FRAME, **of_client)
        p.stepSimulation(**of_client)
        p.getLinkState(robot, 2, computeForwardKinematics=True, **of_client)
    kept = p.saveState(client)
    p.changeDynamics(falling, -1, lateralFriction=0.1, **of_client)
    with pytest.raises(p.error):
        p.loadURDF("nowhere.urdf", **of_client)
    for _ in range(10):
        p.stepSimulation(**of_client)
    p.restoreState(kept, **of_client)
    p.removeConstraint(tie, client)
    p.removeBody(falling, client)
    p.resetJointState(robot, 2, 0.5, **of_client)
    for _ in range(30):
        p.stepSimulation(**of_client)


def test_every_function_is_logged_or_has_a_reason_not_to_be() -> None:
    others = set(functions()) - COMMANDS
    left = {name for name in others if not name.startswith(QUESTIONS) and "Debug" not in name}
    assert left == OTHERS
    assert set(functions()) >= COMMANDS
    assert not any(name.startswith(QUESTIONS) for name in COMMANDS)


def test_a_session_is_replayed_to_the_last_bit(world: None, tmp_path: Path) -> None:
    session()
    unlogged = state()
    p.resetSimulation()
    p.disconnect()

    p.connect(p.DIRECT)
    usual = functions()["setGravity"].asked.__code__
    log = start(tmp_path / "log")
    assert functions()["setGravity"].asked.__code__ is not usual
    session()
    p.stopStateLogging(log)
    assert functions()["setGravity"].asked.__code__ is usual
    p.setGravity(1, 2, 3)
    p.setGravity(0, 0, -9.81)
    expected = state()
    assert expected == unlogged

    other = p.connect(p.DIRECT)
    assert replay(tmp_path / "log", other) == 0
    assert state(other) == expected
    for _ in range(50):
        p.stepSimulation()
        p.stepSimulation(other)
    assert state(other) == state()
    assert (
        p.startStateLogging(p.STATE_LOGGING_CONTACT_POINTS, str(tmp_path / "x"), physicsClientId=other) == 1
    )


def test_a_replay_is_logged_as_well(world: None, tmp_path: Path) -> None:
    log = start(tmp_path / "first")
    session()
    p.stopStateLogging(log)
    middle, last = p.connect(p.DIRECT), p.connect(p.DIRECT)
    start(tmp_path / "second", middle)
    replay(tmp_path / "first", middle)
    p.disconnect(middle)
    assert (tmp_path / "second").read_bytes() == (tmp_path / "first").read_bytes()
    replay(tmp_path / "second", last)
    assert state(last) == state()


def test_one_log_of_a_world_at_a_time(world: None, tmp_path: Path) -> None:
    other = p.connect(p.DIRECT)
    first = start(tmp_path / "one")
    assert start(tmp_path / "two") is None
    assert not (tmp_path / "two").exists()
    theirs = start(tmp_path / "theirs", other)
    p.setGravity(0, 0, -1)
    p.setGravity(0, 0, -2, other)
    p.stopStateLogging(first)
    p.setGravity(0, 0, -3, other)
    assert start(tmp_path / "two") == first + 1
    p.stopStateLogging(theirs, other)
    assert (tmp_path / "theirs").stat().st_size > (tmp_path / "one").stat().st_size > 16
    assert (tmp_path / "two").stat().st_size == 16


def test_a_log_ends_with_the_connection(world: None, tmp_path: Path) -> None:
    usual = functions()["setGravity"].asked.__code__
    start(tmp_path / "log")
    p.setGravity(0, 0, -5)
    p.stepSimulation()
    p.disconnect()
    assert functions()["setGravity"].asked.__code__ is usual
    p.connect(p.DIRECT)
    replay(tmp_path / "log")
    assert p.getPhysicsEngineParameters()["gravityAccelerationZ"] == -5


def test_a_log_can_be_replayed_while_it_is_written(world: None, tmp_path: Path) -> None:
    start(tmp_path / "log")
    p.createMultiBody()
    with pytest.raises(p.error, match="it gives 1 and gave 0; the world has to be"):
        replay(tmp_path / "log")


def test_steps_of_the_clock_are_logged(world: None, tmp_path: Path) -> None:
    # In `DIRECT` mode there is no real-time simulation.
    server = p.connect(p.SHARED_MEMORY_SERVER, os.getpid() + 90_000)
    log = start(tmp_path / "log", server)
    body = p.createMultiBody(1, physicsClientId=server)
    p.setGravity(0, 0, -1, server)
    p.setRealTimeSimulation(1, server)
    until(lambda: p.getBaseVelocity(body, server)[0][2])
    p.setRealTimeSimulation(0, server)
    p.stopStateLogging(log, server)
    there = p.getBasePositionAndOrientation(body, physicsClientId=server)
    assert there[0][2] < 0
    replay(tmp_path / "log")
    assert p.getBasePositionAndOrientation(body) == there


def test_a_server_logs_the_calls_of_all(world: None, tmp_path: Path) -> None:
    key = os.getpid() + 70_000
    server = p.connect(p.SHARED_MEMORY_SERVER, key)
    joined = p.connect(p.SHARED_MEMORY, key)
    log = start(tmp_path / "log", joined)
    body = p.createMultiBody(1, physicsClientId=joined)
    p.setGravity(0, 0, -1, server)
    p.stepSimulation(joined)
    p.stopStateLogging(log, server)
    p.setGravity(0, 0, -2, joined)
    replay(tmp_path / "log")
    assert p.getPhysicsEngineParameters()["gravityAccelerationZ"] == -1
    there = p.getBasePositionAndOrientation(body, physicsClientId=joined)
    assert p.getBasePositionAndOrientation(body) == there
    p.disconnect(joined)
    p.disconnect(server)


def test_the_log_of_a_process_that_was_killed_is_whole(world: None, tmp_path: Path) -> None:
    script = (
        "import os, sys, pybullet as p\n"
        "p.connect(p.DIRECT)\n"
        "p.startStateLogging(p.STATE_LOGGING_ALL_COMMANDS, sys.argv[1])\n"
        "p.createMultiBody(1)\n"
        "os._exit(9)\n"
    )
    ended = subprocess.run([sys.executable, "-c", script, str(tmp_path / "log")], check=False)
    assert ended.returncode == 9
    replay(tmp_path / "log")
    assert p.getNumBodies() == 1


def file_of(*commands: Any) -> bytes:
    """A log that was made up."""
    return command_log._HEADER.pack(command_log._MAGIC, 1, 0) + b"".join(map(command_log._record, commands))


GRAVITY = Command("setGravity", [0, 0, -7], {"physicsClientId": 5}, None)


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"", "this is no log of commands"),
        (b"BT3CMDd-v326" * 9, "this is no log of commands"),
        (command_log._HEADER.pack(command_log._MAGIC, 2, 0), "has version 2 of the format"),
        (file_of(GRAVITY, GRAVITY)[:-1], "the log is cut off in command 2"),
        (file_of(GRAVITY) + b"123", "the log is cut off in command 2"),
        (file_of(GRAVITY, GRAVITY)[:-1] + b"x", "command 2 is damaged"),
        (
            file_of(GRAVITY, Command("saveWorld", ["x"], {}, None)),
            "command 2 is 'saveWorld', which logs do not",
        ),
        (file_of(GRAVITY, ("setGravity", 5, {}, None)), "command 2 is no call"),
        (file_of(GRAVITY, ("setGravity", [], {5: 5}, None)), "command 2 is no call"),
        (file_of(GRAVITY, ()), "command 2 is no call"),
    ],
)
def test_nothing_of_a_bad_file_is_performed(
    world: None, tmp_path: Path, content: bytes, problem: str
) -> None:
    (tmp_path / "log").write_bytes(content)
    with pytest.raises(p.error, match=f"^startStateLogging failed.*{problem}"):
        replay(tmp_path / "log")
    assert p.getPhysicsEngineParameters()["gravityAccelerationZ"] == 0


def test_commands_that_fail_say_which_they_are(world: None, tmp_path: Path) -> None:
    for command in (
        Command("loadURDF", ["nowhere.urdf"], {}, 0),
        Command("setGravity", [1], {}, None),
        Command("setGravity", [], {"nothing": 1}, None),
        Command("createMultiBody", [1], {}, 4),
    ):
        (tmp_path / "log").write_bytes(file_of(GRAVITY, command))
        with pytest.raises(p.error, match=rf"command 2, {command.name}, cannot be repeated; the 1 before it"):
            replay(tmp_path / "log")
        assert p.getPhysicsEngineParameters()["gravityAccelerationZ"] == -7


def test_files_that_cannot_be_opened(world: None, tmp_path: Path) -> None:
    for path in (tmp_path / "missing", tmp_path, tmp_path / "a\0b"):
        with pytest.raises(p.error, match=r"^startStateLogging failed\."):
            replay(path)
    with pytest.raises(p.error, match=r"^startStateLogging failed\."):
        start(tmp_path / "nowhere" / "log")
    p.setGravity(0, 0, 1)


VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-3, 3)
    | st.floats()
    | st.text(max_size=5)
    | st.binary(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)
NUMBERS = sorted(COMMANDS - {"executePluginCommand", "loadPlugin"})
fuzz = settings(
    deadline=None, max_examples=cases(100), suppress_health_check=[HealthCheck.function_scoped_fixture]
)


@fuzz
@given(data=st.data())
def test_damaged_files_are_refused(world: None, tmp_path: Path, data: st.DataObject) -> None:
    content = bytearray(file_of(GRAVITY, Command("stepSimulation", [], {}, None), GRAVITY))
    place = data.draw(st.integers(0, len(content) - 1))
    # The last four bytes of the header mean nothing.
    content[place] ^= data.draw(st.integers(1, 255)) if not 12 <= place < 16 else 0
    cut = data.draw(st.integers(0, len(content)))
    (tmp_path / "log").write_bytes(content[:cut])
    try:
        replay(tmp_path / "log")
    except p.error as problem:
        assert str(problem).startswith("startStateLogging failed.")
        assert p.getPhysicsEngineParameters()["gravityAccelerationZ"] == 0
    p.resetSimulation()


@fuzz
@given(
    name=st.sampled_from(NUMBERS) | st.text(max_size=5),
    arguments=st.lists(VALUES, max_size=6),
    keywords=st.dictionaries(st.sampled_from(["physicsClientId", "bodyUniqueId", "x"]), VALUES, max_size=2),
)
def test_files_made_up_raise_nothing_but_errors(
    world: None, tmp_path: Path, name: str, arguments: list[Any], keywords: dict[str, Any]
) -> None:
    p.createMultiBody(1)
    (tmp_path / "log").write_bytes(file_of(Command(name, arguments, keywords, None)))
    try:
        replay(tmp_path / "log")
    except p.error as problem:
        assert str(problem).startswith("startStateLogging failed.")
    assert p.isConnected()
    p.resetSimulation()


def test_messages_that_are_no_values(world: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command_log, "pack", lambda value: (b"\xc1" + pack(value)[0], []))
    content = file_of(GRAVITY)
    monkeypatch.undo()
    (tmp_path / "log").write_bytes(content)
    with pytest.raises(p.error, match=r"startStateLogging failed.*cannot be read"):
        replay(tmp_path / "log")
