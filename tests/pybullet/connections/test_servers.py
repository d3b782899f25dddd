"""Several processes on one world."""

import math
import os
import signal
import sys
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest
from tests.conformance.catalogue import select
from tests.patience import until
from tests.pybullet.conftest import keys
from tests.servers import Process, Servers

import pybullet as p
from pybullet._clients.clients import clients
from pybullet._connections.served import Served
from pybullet_utils.bullet_client import BulletClient

ROBOTS = Path(__file__).parents[1] / "robots"
ARM = str(ROBOTS / "arm.urdf")

# Joins a server and does as it is told; expressions, one a line.
CLIENT = """
import sys
import pybullet as p
client = p.connect(p.SHARED_MEMORY, key=int(sys.argv[1]))
print(client, flush=True)
for line in sys.stdin:
    try:
        answer = eval(line)
    except Exception as problem:
        answer = problem
    print(repr(answer), flush=True)
"""


@pytest.fixture
def joined(servers: Servers, key: int) -> Any:
    """A connection to a new world in another process."""
    servers.open(key)
    yield p.connect(p.SHARED_MEMORY, key)
    servers.close(key)


@pytest.fixture
def server(key: int) -> int:
    """A server in this process."""
    return p.connect(p.SHARED_MEMORY_SERVER, key)


def another(key: int) -> Process:
    """Another process, which has joined a server."""
    process = Process(CLIENT, [str(key)])
    assert process.hear() == "0"
    return process


def clients_of_server(number: int) -> int:
    served = clients[number].server
    assert isinstance(served, Served)
    return served.client_count


def test_no_server_is_minus_one(key: int, caplog: pytest.LogCaptureFixture) -> None:
    assert p.connect(p.SHARED_MEMORY) == -1
    assert p.connect(p.SHARED_MEMORY, key) == -1
    assert not caplog.records
    for method in (p.TCP, p.UDP):
        assert p.connect(method) == -1
        assert p.connect(method, "localhost", 7) == -1
    assert "No physics server" in caplog.text


def test_a_connection_tells_how_it_was_made(joined: int) -> None:
    assert p.getConnectionInfo(joined) == {"isConnected": 1, "connectionMethod": p.SHARED_MEMORY}
    assert p.isConnected(joined) == 1
    p.disconnect(joined)
    assert p.getConnectionInfo(joined) == {"isConnected": 0, "connectionMethod": 0}
    with pytest.raises(p.error, match=r"^Not connected to physics server\."):
        p.stepSimulation(joined)
    with pytest.raises(p.error, match=r"^Not connected to physics server\."):
        p.disconnect(joined)


def test_worlds_here_and_elsewhere_side_by_side(joined: int) -> None:
    here = p.connect(p.DIRECT)
    p.loadURDF(ARM, physicsClientId=joined)
    p.loadURDF(ARM, [0, 0, 1], physicsClientId=here)
    p.loadURDF(ARM, physicsClientId=here)
    assert [p.getNumBodies(client) for client in (joined, here)] == [1, 2]
    assert p.getNumBodies(np.int64(here)) == 2  # pyright: ignore[reportArgumentType]
    with BulletClient(p.DIRECT) as wrapped:
        assert wrapped.getNumBodies() == 0
    with pytest.raises(p.error, match=r"^Not connected to physics server\."):
        p.getNumBodies(7)
    with pytest.raises(TypeError):
        p.getNumBodies([])  # pyright: ignore[reportArgumentType]


def test_functions_ask_only_while_there_is_somebody_to_ask(servers: Servers, key: int) -> None:
    code = p.stepSimulation.__self__.__code__  # pyright: ignore
    servers.open(key)
    first, second = p.connect(p.SHARED_MEMORY, key), p.connect(p.SHARED_MEMORY, key)
    assert p.stepSimulation.__self__.__code__ is not code  # pyright: ignore
    p.disconnect(first)
    assert p.stepSimulation.__self__.__code__ is not code  # pyright: ignore
    p.disconnect(second)
    assert p.stepSimulation.__self__.__code__ is code  # pyright: ignore
    servers.close(key)


@pytest.mark.parametrize(
    "call",
    [
        lambda: p.loadURDF("nowhere.urdf"),
        lambda: p.loadURDF(ARM, 1, 2, 3, physicsClientId=0),  # pyright: ignore
        lambda: p.setGravity("x", 0, 0),  # pyright: ignore
        lambda: p.setGravity(object(), 0, 0),  # pyright: ignore
        lambda: p.setGravity(math.nan, 0, 0),
        lambda: p.setGravity(1, 2, 3, 4, 5),  # pyright: ignore
        lambda: p.setGravity(1, 2),  # pyright: ignore
        lambda: p.setGravity(1, 2, 3, gravity=4),  # pyright: ignore
        lambda: p.getJointState(0, 7),
        lambda: p.getJointState(-1, 0),
        lambda: p.getJointState(2**40, 0),
        lambda: p.getJointState(10**400, 0),
        lambda: p.getBasePositionAndOrientation(3),
        lambda: p.resetBasePositionAndOrientation(0, [1, 2], [0, 0, 0, 1]),
        lambda: p.setJointMotorControlArray(0, [0, 1], p.POSITION_CONTROL, targetPositions=[0]),
        lambda: p.loadSoftBody("nowhere.obj"),
        lambda: p.renderImage(1, 2, 3),
        lambda: p.getCameraImage(0, 0),
    ],
)
def test_errors_are_those_of_a_world_in_the_same_process(servers: Servers, key: int, call: Any) -> None:
    problems = []
    servers.open(key)
    for connect in (lambda: p.connect(p.SHARED_MEMORY, key), lambda: p.connect(p.DIRECT)):
        assert connect() == 0
        p.loadURDF(ARM)
        with pytest.raises((p.error, TypeError, OverflowError)) as problem:
            call()
        # Where else a file could be found depends on what each process has searched before.
        problems.append((type(problem.value), str(problem.value).partition("; did you mean")[0]))
        p.disconnect()
    servers.close(key)
    elsewhere, here = problems
    # Repr of objects and of types differ by addresses and modules only.
    assert elsewhere == here


@pytest.mark.parametrize("name", ["three_robots", "three_boxes_stacked", "robot_removed_midway"])
def test_a_trajectory_has_the_same_bits(
    servers: Servers, monkeypatch: pytest.MonkeyPatch, key: int, name: str
) -> None:
    (scenario,) = select([name])
    here = scenario.series(p)
    connect = p.connect
    servers.open(key)
    with monkeypatch.context() as patched:
        patched.setattr(p, "connect", lambda *_, **__: connect(p.SHARED_MEMORY, key))
        elsewhere = scenario.series(p)
    servers.close(key)
    assert here.keys() == elsewhere.keys()
    for series, values in here.items():
        assert elsewhere[series].tobytes() == values.tobytes(), series


def test_everybody_sees_what_others_do(joined: int, key: int) -> None:
    with another(key) as first, another(key) as second:
        assert first.ask(f"p.loadURDF({ARM!r})") == "0"
        assert second.ask(f"p.loadURDF({ARM!r}, [1, 0, 0])") == "1"
        assert p.loadURDF(ARM, [2, 0, 0]) == 2
        p.syncBodyInfo()
        assert p.getNumBodies() == 3
        assert first.ask("p.getNumBodies()") == second.ask("p.getNumBodies()") == "3"
        assert first.ask("p.getBasePositionAndOrientation(2)[0]") == "(2.0, 0.0, 0.0)"
        assert first.ask("p.getBodyInfo(2)") == repr(p.getBodyInfo(2))
        second.ask("p.removeBody(0)")
        assert p.getNumBodies() == 2
        with pytest.raises(p.error):
            p.getBasePositionAndOrientation(0)
        assert first.ask("p.resetSimulation()") == "None"
        assert p.getNumBodies() == 0
        second.ask("p.disconnect()")
        assert p.isConnected(joined) == 1
        assert first.end() == 0


def test_all_at_once(joined: int, key: int) -> None:
    p.setGravity(0, 0, -10)
    # Apart from each other, so that nothing is pushed upwards.
    work = "[(p.loadURDF({!r}, [{}, 3 * k, 5]), p.stepSimulation()) for k in range(20)][-1]"
    with another(key) as first, another(key) as second, another(key) as third:
        crowd = (first, second, third)
        for number, process in enumerate(crowd):
            process.tell(work.format(ARM, 3 * number))
        states = [p.getBasePositionAndOrientation(0)[0][2] for _ in range(50) if p.getNumBodies()]
        for process in crowd:
            assert process.hear().endswith("())")
        assert p.getNumBodies() == 60
        assert states == sorted(states, reverse=True)
        heights = {process.ask("[p.getLinkState(b, 0)[0] for b in range(60)]") for process in crowd}
        assert len(heights) == 1


def test_threads_of_one_client(joined: int) -> None:
    arm = p.loadURDF(ARM)
    wrong = []

    def look() -> None:
        for _ in range(100):
            if len(p.getJointStates(arm, [0, 1, 2]) or ()) != 3 or p.getNumJoints(arm) != 3:
                wrong.append(1)

    threads = [Thread(target=look) for _ in range(4)]
    for thread in threads:
        thread.start()
    for _ in range(50):
        p.stepSimulation()
    for thread in threads:
        thread.join()
    assert not wrong


def test_the_server_itself_is_a_client(server: int, key: int) -> None:
    assert p.getConnectionInfo(server) == {"isConnected": 1, "connectionMethod": p.SHARED_MEMORY_SERVER}
    with another(key) as process:
        process.ask(f"p.loadURDF({ARM!r})")
        assert p.getNumBodies(server) == 1
        # While others step, load and remove, everything here stays in order.
        process.tell(
            f"[(p.removeBody(p.loadURDF({ARM!r}, [0, 9, 0])), p.stepSimulation()) for _ in range(50)] and 0"
        )
        while process.process.poll() is None and p.getNumBodies() in (1, 2):
            states = p.getJointStates(0, [0, 1, 2])
            assert states and all(math.isfinite(state[0]) for state in states)
            p.stepSimulation()
            p.getContactPoints()
            if p.getPhysicsEngineParameters()["numSubSteps"] == 0 and clients[server].world.time > 0.4:
                break
        assert process.hear() == "0"
        p.disconnect(server)
        assert "Not connected to physics server." in process.ask("p.stepSimulation()")
        assert process.ask("p.isConnected()") == "0"
        assert process.ask(f"p.connect(p.SHARED_MEMORY, {key})") == "-1"


def test_a_client_is_killed(server: int, key: int) -> None:
    with another(key) as victim, another(key) as witness:
        victim.tell("[p.stepSimulation() for _ in range(10**9)]")
        assert until(lambda: clients[server].world.time > 0.1)
        victim.process.kill()
        assert until(lambda: clients_of_server(server) == 1)
        assert witness.ask(f"p.loadURDF({ARM!r})") == "0"
        assert p.stepSimulation(server) == ()


@pytest.mark.skipif(sys.platform == "win32", reason="processes cannot be stopped there")
def test_a_client_hangs(server: int, key: int) -> None:
    with another(key) as hung, another(key) as witness:
        hung.tell("[p.stepSimulation() for _ in range(10**9)]")
        assert until(lambda: clients[server].world.time > 0.1)
        os.kill(hung.process.pid, signal.SIGSTOP)
        assert witness.ask(f"p.loadURDF({ARM!r})") == "0"
        assert p.stepSimulation(server) == ()
        p.disconnect(server)
        assert witness.ask("p.isConnected()") == "0"


def test_a_server_is_killed(key: int) -> None:
    with Servers() as victim:
        victim.open(key)
        client = p.connect(p.SHARED_MEMORY, key)
        p.stepSimulation()
        victim.process.kill()
        victim.process.wait()
        with pytest.raises(p.error, match=r"^Not connected to physics server\."):
            p.stepSimulation()
    assert p.isConnected(client) == 0
    # What it has left behind is no obstacle.
    assert p.connect(p.SHARED_MEMORY, key) == -1
    assert p.connect(p.SHARED_MEMORY_SERVER, key) == client


@pytest.mark.skipif(sys.platform == "win32", reason="processes cannot be stopped there")
def test_a_server_hangs(key: int) -> None:
    with Servers() as hung:
        hung.open(key)
        p.connect(p.SHARED_MEMORY, key)
        assert p.stepSimulation() == ()
        p.setTimeOut(0.3)
        os.kill(hung.process.pid, signal.SIGSTOP)
        with pytest.raises(p.error, match=r"^Not connected to physics server\. .* within 0\.3 s"):
            # It may stop a little later.
            while True:
                p.stepSimulation()
        assert p.isConnected() == 0


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork there")
@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
def test_a_forked_process_has_neither_connection_nor_server(joined: int) -> None:
    server = p.connect(p.SHARED_MEMORY_SERVER, next(keys))
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        report = (p.isConnected(joined), p.isConnected(server), p.getNumBodies(server))
        os.write(writer, repr(report).encode())
        p.disconnect(server)
        os._exit(0)
    os.waitpid(child, 0)
    assert os.read(reader, 100) == b"(0, 1, 0)"
    os.close(reader)
    os.close(writer)
    assert p.getNumBodies(joined) == p.getNumBodies(server) == 0


def test_one_key_one_server(server: int, key: int) -> None:
    with pytest.raises(p.error, match=r"^Cannot start the physics server: there is one already"):
        p.connect(p.SHARED_MEMORY_SERVER, key)
    p.disconnect(server)
    assert p.connect(p.SHARED_MEMORY_SERVER, key) == server


def test_real_time_in_a_server(joined: int) -> None:
    arm = p.loadURDF(ARM, [0, 0, 1])
    p.setGravity(0, 0, -10)
    p.setRealTimeSimulation(1)
    assert until(lambda: p.getBasePositionAndOrientation(arm)[0][2] < 1.0)
    p.setRealTimeSimulation(0)


def test_images_are_arrays_of_ones_own(joined: int) -> None:
    p.loadURDF(ARM)
    width, height, colours, depths, labels = p.getCameraImage(64, 48)
    assert (width, height) == (64, 48)
    assert (colours.shape, colours.dtype) == ((48, 64, 4), np.uint8)
    assert (depths.shape, depths.dtype) == ((48, 64), np.float32)
    assert (labels.shape, labels.dtype) == ((48, 64), np.int32)
    colours[:] = 0
    assert p.getCameraImage(64, 48)[2].any()
