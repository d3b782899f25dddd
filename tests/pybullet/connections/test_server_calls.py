"""What a server makes of calls that no client of ours would send."""

import gc
import inspect
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

import pybullet as p
from carom.remote.connection import Connection
from carom.remote.errors import ServerGone
from carom.remote.frames import Frame
from carom.remote.rendezvous import find
from carom.remote.values import pack, unpack
from pybullet._calls.detours import functions
from pybullet._clients.clients import clients
from pybullet._connections.remote import ERROR, EXCEPTIONS, PROBLEM, RESULT
from pybullet._connections.served import Served

ARM = str(Path(__file__).parents[1] / "robots" / "arm.urdf")

# What they do depends on the machine they run on, or takes its time.
NOT_AT_RANDOM = {"setRealTimeSimulation", "stepSimulation", "setPhysicsEngineParameter", "loadPlugin"}
# Those write or read files of any name.
OF_FILES = {
    name
    for name, function in functions().items()
    if {"fileName", "textureFilename", "bulletFileName"} & set(inspect.signature(function.plain).parameters)
}
NAMES = sorted(functions().keys() - NOT_AT_RANDOM - OF_FILES)

scalars = (
    st.none()
    | st.booleans()
    | st.integers(-2, 4)
    | st.integers()
    | st.floats()
    | st.sampled_from(["", "x", b"", [], {}, [[]], np.zeros(3), np.array(1.0), object()])
)
values = (
    scalars | st.lists(scalars, max_size=4) | st.lists(st.lists(st.floats(-9, 9), max_size=4), max_size=3)
)


@pytest.fixture
def connection(key: int) -> Iterator[Connection]:
    server = p.connect(p.SHARED_MEMORY_SERVER, key)
    p.loadURDF(ARM, physicsClientId=server)
    note = find(f"shared-memory-{key}")
    assert note is not None
    connection = Connection(note.host, note.port, note.key, 60.0)
    yield connection
    connection.close()


def works(connection: Connection) -> bool:
    return connection.call(("getAPIVersion", [], {}))[0] == PROBLEM and connection.call(
        ("getNumJoints", [0], {})
    ) in ((RESULT, 3), (RESULT, 0))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=cases(400))
@given(
    st.sampled_from(NAMES),
    st.lists(values, max_size=6),
    st.dictionaries(st.sampled_from(["bodyUniqueId", "jointIndex", "physicsClientId", "flags", "x"]), values),
)
def test_functions_with_any_arguments(
    connection: Connection, name: str, arguments: list[Any], keywords: dict[str, Any]
) -> None:
    kind, *answer = connection.call((name, arguments, keywords))
    if kind == PROBLEM:
        exception, text = answer
        assert exception == ERROR or exception in EXCEPTIONS
        assert "has failed in the server" not in text
    assert works(connection)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=cases(100))
@given(values | st.lists(values, max_size=4))
def test_messages_that_are_no_calls(connection: Connection, key: int, request_: Any) -> None:
    note = find(f"shared-memory-{key}")
    assert note is not None
    own = Connection(note.host, note.port, note.key, 60.0)
    try:
        with pytest.raises(ServerGone):
            own.call(request_)
    finally:
        own.close()
    assert works(connection)


@pytest.mark.parametrize(
    "name",
    [
        "connect",
        "disconnect",
        "isConnected",
        "setTimeOut",
        "vhacd",
        "error",
        "__import__",
        "exec",
        "",
        "os.system",
    ],
)
def test_only_functions_that_need_a_world_can_be_called(connection: Connection, name: str) -> None:
    kind, exception, text = connection.call((name, [0], {}))
    assert (kind, exception) == (PROBLEM, ERROR)
    assert text.startswith("A server has no function")


def test_clients_reach_no_other_world_of_the_process(connection: Connection) -> None:
    other = p.connect(p.DIRECT)
    assert p.getNumBodies(other) == 0
    for arguments, keywords in (([other], {}), ([], {"physicsClientId": other})):
        assert connection.call(("getNumBodies", arguments, keywords)) == (RESULT, 1)
    assert connection.call(("resetSimulation", [0, other], {})) == (RESULT, None)
    assert [p.getNumBodies(client) for client in (other, 0)] == [0, 0]


def test_mistakes_of_ours_are_told_and_logged(
    connection: Connection, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def fail() -> None:
        raise ZeroDivisionError("nothing left")

    monkeypatch.setattr(clients[0].world, "step", fail, raising=False)
    kind, exception, text = connection.call(("stepSimulation", [], {}))
    assert (kind, exception) == (PROBLEM, ERROR)
    assert "nothing left" in text
    assert "ZeroDivisionError" in caplog.text


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=cases(100))
@given(st.data())
def test_damaged_calls(connection: Connection, key: int, data: st.DataObject) -> None:
    message = bytearray(pack(("resetJointState", [0, 1, 0.5], {"targetVelocity": 1.5}))[0])
    for _ in range(data.draw(st.integers(1, 3))):
        message[data.draw(st.integers(0, len(message) - 1))] = data.draw(st.integers(0, 255))
    note = find(f"shared-memory-{key}")
    assert note is not None
    own = Connection(note.host, note.port, note.key, 60.0)
    with own._socket as peer:
        peer.sendall(struct.pack("<IIQ", 1, len(message), 0) + message + bytes(-len(message) % 16))
        peer.shutdown(1)
        peer.settimeout(10.0)
        while peer.recv(65536):
            pass
    assert works(connection)


def test_a_call_that_comes_when_the_server_has_gone_is_told_so(key: int) -> None:
    number = p.connect(p.SHARED_MEMORY_SERVER, key)
    server = clients[number].server
    assert isinstance(server, Served)
    answer = server._listener._answer
    p.disconnect(number)
    del server
    gc.collect()
    message, arrays = answer(Frame(1, memoryview(b""), memoryview(b"")))
    assert not arrays
    told = "Not connected to physics server. The server is closing."
    assert unpack(message, memoryview(b""), lists=False) == (PROBLEM, ERROR, told)
