"""Servers with a window, and worlds that are shown in another process."""

from threading import Thread

import pytest
from tests.pybullet.connections.test_servers import ARM, another, until

import pybullet as p
from pybullet._clients.clients import clients
from pybullet._connections.served import Served
from pybullet._window.page_window import PageWindow


@pytest.mark.parametrize("method", [p.GUI_SERVER, p.GRAPHICS_SERVER, p.GRAPHICS_SERVER_MAIN_THREAD])
def test_there_is_one_window_only(method: int, key: int) -> None:
    assert p.connect(method, key, "--port=0") == 0
    assert p.getConnectionInfo() == {"isConnected": 1, "connectionMethod": method}
    with pytest.raises(p.error, match="Only one local in-process GUI"):
        p.connect(p.GUI)


def test_what_others_draw_is_in_the_window(key: int) -> None:
    p.connect(p.GUI_SERVER, key, "--port=0")
    window = clients[0].window
    assert isinstance(window, PageWindow)
    with another(key) as process:
        assert process.ask("p.addUserDebugLine([0, 0, 0], [1, 0, 0])") == "0"
        assert list(window.items) == [0]
        assert process.ask("p.getConnectionInfo()['connectionMethod']") == str(p.SHARED_MEMORY)


def test_closing_the_window_ends_the_server(key: int) -> None:
    p.connect(p.GUI_SERVER, key, "--port=0")
    with another(key) as process:
        clients[0].window.close()
        assert "Not connected to physics server." in process.ask("p.stepSimulation()")
        assert until(lambda: not p.isConnected(0))
        assert process.ask("p.isConnected()") == "0"


def test_a_paused_window_holds_steps_and_nothing_else(key: int) -> None:
    p.connect(p.GUI_SERVER, key, "--port=0")
    viewer = clients[0].window.viewer  # pyright: ignore[reportAttributeAccessIssue]
    viewer.pause_control.close()
    viewer.on_hold(True)
    with another(key) as stepping, another(key) as looking:
        stepping.tell("p.stepSimulation()")
        assert looking.ask(f"p.loadURDF({ARM!r})") == "0"
        assert p.getNumBodies() == 1
        own = Thread(target=p.stepSimulation)
        own.start()
        assert looking.ask("p.getNumBodies()") == "1"
        assert clients[0].world.time == 0.0
        viewer.on_hold(False)
        viewer.pause_control.open()
        assert stepping.hear() == "()"
        own.join(10.0)
        assert clients[0].world.time == pytest.approx(2 / 240)


def test_a_world_in_a_graphics_server(key: int) -> None:
    p.connect(p.GRAPHICS_SERVER, key, "--port=0 --tcp=0")
    server = clients[0].server
    assert isinstance(server, Served)
    _, (_, port) = server.addresses
    assert p.connect(p.SHARED_MEMORY, key) == -1
    over_memory = p.connect(p.GRAPHICS_CLIENT, key)
    over_tcp = p.connect(p.GRAPHICS_SERVER_TCP, "localhost", port)
    assert p.GRAPHICS_CLIENT == p.SHARED_MEMORY_GUI
    assert p.getConnectionInfo(over_memory)["connectionMethod"] == p.GRAPHICS_CLIENT
    assert p.getConnectionInfo(over_tcp)["connectionMethod"] == p.GRAPHICS_SERVER_TCP
    p.loadURDF(ARM, physicsClientId=over_memory)
    assert [p.getNumBodies(client) for client in (0, over_memory, over_tcp)] == [1, 1, 1]


def test_without_a_graphics_server_nobody_sees_the_world(key: int) -> None:
    # Measured: PyBullet connects, too, and says that it shows nothing.
    client = p.connect(p.GRAPHICS_CLIENT, key)
    assert p.getConnectionInfo(client) == {"isConnected": 1, "connectionMethod": p.GRAPHICS_CLIENT}
    assert p.loadURDF(ARM, physicsClientId=client) == 0
    assert clients[client].server is None
    assert p.connect(p.GRAPHICS_SERVER_TCP, "localhost", 7) == client + 1
