"""Several clients at once, and clients wrapped into objects."""

import functools
import inspect
import os
from pathlib import Path

import pytest

import pybullet as p
from pybullet_utils.bullet_client import BulletClient

ARM = str(Path(__file__).parents[1] / "robots" / "arm.urdf")


def test_ids_count_from_zero_and_gaps_are_filled() -> None:
    assert [p.connect(p.DIRECT) for _ in range(3)] == [0, 1, 2]
    p.disconnect(1)
    assert [p.isConnected(client) for client in range(3)] == [1, 0, 1]
    assert p.connect(p.DIRECT) == 1


def test_a_connection_tells_how_it_was_made() -> None:
    client = p.connect(p.DIRECT)
    assert p.getConnectionInfo(client) == {"isConnected": 1, "connectionMethod": p.DIRECT}
    for nobody in (5, -5, 99999):
        assert p.getConnectionInfo(nobody) == {"isConnected": 0, "connectionMethod": 0}
        assert p.isConnected(nobody) == 0


def test_disconnecting_twice_is_an_error(client: int) -> None:
    p.disconnect(client)
    with pytest.raises(p.error, match=r"^Not connected to physics server\."):
        p.disconnect(client)


def test_worlds_are_independent() -> None:
    first, second = p.connect(p.DIRECT), p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.8, physicsClientId=second)
    bodies = [p.loadURDF(ARM, [0, 0, 1], physicsClientId=client) for client in (first, second)]
    assert bodies == [0, 0]
    p.loadURDF(ARM, physicsClientId=second)
    for _ in range(10):
        p.stepSimulation(first)
        p.stepSimulation(second)
    assert p.getNumBodies(first) == 1
    assert p.getNumBodies(second) == 2
    assert p.getBasePositionAndOrientation(0, first)[0][2] == 1.0
    assert p.getBasePositionAndOrientation(0, second)[0][2] < 1.0
    p.resetSimulation(physicsClientId=second)
    assert (p.getNumBodies(first), p.getNumBodies(second)) == (1, 0)


def test_a_step_from_a_thousand_worlds_down() -> None:
    assert p.connect(p.DIRECT) == 0
    from pybullet._clients import clients as registry

    taken = dict.fromkeys(range(1, registry.MAX_CLIENTS), registry.clients[0])
    registry.clients.update(taken)
    try:
        with pytest.raises(p.error, match=r"^Exceeding maximum number of physics connections\."):
            p.connect(p.DIRECT)
    finally:
        for slot in taken:
            del registry.clients[slot]


@pytest.mark.parametrize(
    "arguments",
    [
        {"key": 5},
        {"options": "--x"},
        {"hostName": "localhost"},
        {"hostName": "localhost", "port": 5, "options": "--x"},
    ],
)
def test_connect_takes_both_forms_by_name(arguments: dict[str, object]) -> None:
    assert p.connect(p.DIRECT, **arguments) == 0  # pyright: ignore[reportArgumentType, reportCallIssue]


def test_connect_takes_both_forms_by_position() -> None:
    assert p.connect(p.DIRECT, 5, "--x") == 0
    assert p.connect(p.DIRECT, "localhost", 5, "--x") == 1


@pytest.mark.parametrize(
    ("arguments", "keywords"),
    [
        ((), {}),
        (("a",), {}),
        ((p.DIRECT, 1.5), {}),
        ((p.DIRECT, 5, "", 5), {}),
        ((p.DIRECT,), {"foo": 1}),
        ((p.DIRECT, 5), {"key": 5}),
        ((p.DIRECT,), {"hostName": 5}),
        ((p.DIRECT,), {"hostName": "a", "key": 5}),
    ],
)
def test_connect_with_arguments_it_does_not_have(
    arguments: tuple[object, ...], keywords: dict[str, object]
) -> None:
    with pytest.raises(TypeError):
        p.connect(*arguments, **keywords)  # pyright: ignore


@pytest.mark.parametrize("method", [-1, 0, 6, 10, 13, 18, 99])
def test_methods_that_do_not_exist(method: int) -> None:
    with pytest.raises(p.error, match=r"^connectPhysicsServer unexpected argument"):
        p.connect(method)


def test_a_client_object_talks_to_its_own_world() -> None:
    p.connect(p.DIRECT)
    with BulletClient(p.DIRECT) as first, BulletClient() as second:
        first.loadURDF(ARM)
        assert first.getNumBodies() == 1
        assert second.getNumBodies() == 0
        assert p.getNumBodies() == 0
        assert first.POSITION_CONTROL == p.POSITION_CONTROL
        assert first.error is p.error
        assert first.getQuaternionFromEuler([0, 0, 0]) == (0.0, 0.0, 0.0, 1.0)
        first.setJointMotorControl2(bodyIndex=0, jointIndex=0, controlMode=p.POSITION_CONTROL)
        first.disconnect()
        first.disconnect()
        with pytest.raises(p.error, match=r"Not connected"):
            first.getNumBodies()
    assert [p.isConnected(client) for client in range(3)] == [1, 0, 0]


def test_a_client_object_closes_when_it_is_garbage() -> None:
    wrapped = BulletClient(p.DIRECT)
    assert p.isConnected(0)
    del wrapped
    assert not p.isConnected(0)


class VendoredClient:
    """What projects carry with them: adds the client to a call if, and only if, the function is a builtin."""

    def __init__(self) -> None:
        self._client = p.connect(p.DIRECT)
        self._process = os.getpid()

    def __getattr__(self, name: str) -> object:
        attribute = getattr(p, name)
        if inspect.isbuiltin(attribute):
            attribute = functools.partial(attribute, physicsClientId=self._client)
        return attribute


def test_vendored_client_objects_talk_to_their_own_worlds() -> None:
    worlds = [VendoredClient() for _ in range(3)]
    for number, world in enumerate(worlds):
        for _ in range(number):
            world.loadURDF(ARM)  # pyright: ignore[reportCallIssue]
    assert [p.getNumBodies(client) for client in range(3)] == [0, 1, 2]
    assert [world.getNumBodies() for world in worlds] == [0, 1, 2]  # pyright: ignore[reportCallIssue]


def test_all_connections_search_what_one_was_told_but_their_own_directory_first(tmp_path: Path) -> None:
    for folder, shapes in (("first", 1), ("second", 2)):
        directory = tmp_path / folder
        directory.mkdir()
        collision = '<collision><geometry><sphere radius="1"/></geometry></collision>'
        robot = f'<robot name="{folder}"><link name="ball">{collision * shapes}</link></robot>'
        (directory / f"{folder}.urdf").write_text(robot)
        (directory / "both.urdf").write_text(robot)
    told, other = p.connect(p.DIRECT), p.connect(p.DIRECT)
    p.setAdditionalSearchPath(str(tmp_path / "first"), physicsClientId=told)
    assert p.loadURDF("first.urdf", physicsClientId=other) == 0
    p.setAdditionalSearchPath(str(tmp_path / "second"), physicsClientId=other)
    assert p.loadURDF("second.urdf", physicsClientId=told) == 0
    for client, name in ((told, b"first"), (other, b"second")):
        body = p.loadURDF("both.urdf", physicsClientId=client)
        assert p.getBodyInfo(body, physicsClientId=client)[1] == name
        p.disconnect(client)
    late = p.connect(p.DIRECT)
    assert p.loadURDF("second.urdf", physicsClientId=late) == 0
    with pytest.raises(p.error, match=r"Cannot load URDF file\."):
        p.loadURDF("first.urdf", physicsClientId=late)


def test_versions() -> None:
    assert p.getAPIVersion() == 202010061
    assert p.isNumpyEnabled() == 1
