import os
from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from tests.servers import Servers

import pybullet as p
from pybullet._clients.clients import Client

ROBOTS = Path(__file__).parent / "robots"

# Tests in these files run twice: with their worlds in this process, and in another.
EVERYWHERE = {
    "test_bare_shapes",
    "test_camera_images",
    "test_camera_legacy",
    "test_constraints",
    "test_contact_dynamics",
    "test_contacts",
    "test_drops",
    "test_queries",
    "test_removed_bodies",
    "test_saved_states",
    "test_scene_script",
    "test_shapes",
    "test_soft_bodies",
    "test_states",
    "test_user_data",
    "test_worlds",
}
HERE, ELSEWHERE = "here", "elsewhere"

keys = count(1000)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    sees_insides = metafunc.definition.get_closest_marker("insides") or "caplog" in metafunc.fixturenames
    if metafunc.definition.path.stem in EVERYWHERE and not sees_insides:
        metafunc.parametrize("_place", [HERE, ELSEWHERE], indirect=True)


@pytest.fixture(autouse=True)
def _search_path(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where earlier tests had files searched, which outlives their connections, this one does not look."""
    monkeypatch.setattr(Client, "latest_search_path", None)


@pytest.fixture(autouse=True)
def _place(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Where worlds are that are asked for as `DIRECT`."""
    if getattr(request, "param", HERE) == HERE:
        yield
        return
    servers: Servers = request.getfixturevalue("servers")
    connect, mine = p.connect, []

    def connect_elsewhere(method: int, *arguments: Any, **keywords: Any) -> int:
        if method != p.DIRECT:
            return connect(method, *arguments, **keywords)
        mine.append(next(keys))
        servers.open(mine[-1])
        return connect(p.SHARED_MEMORY, mine[-1])

    monkeypatch.setattr(p, "connect", connect_elsewhere)
    yield
    for key in mine:
        servers.close(key)


@pytest.fixture(scope="session", autouse=True)
def _meeting_place(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Servers of tests are found by tests only."""
    with pytest.MonkeyPatch.context() as patch:
        folder = tmp_path_factory.mktemp("servers")
        patch.setenv("LOCALAPPDATA" if os.name == "nt" else "XDG_RUNTIME_DIR", str(folder))
        patch.delenv("CAROM_SERVER_KEY", raising=False)
        yield


@pytest.fixture(scope="session")
def servers(_meeting_place: None) -> Iterator[Servers]:
    """A process with servers."""
    with Servers() as running:
        yield running


@pytest.fixture
def key() -> int:
    """A key that no server has."""
    return next(keys)


@pytest.fixture(autouse=True)
def _no_connection_left() -> Iterator[None]:
    yield
    for client in range(8):
        if p.isConnected(client):
            p.disconnect(client)


@pytest.fixture
def client() -> int:
    return p.connect(p.DIRECT)


@pytest.fixture
def zoo(client: int) -> int:
    """Joints: 0 turning, 1 sliding, 2 fixed, 3 ball, 4 turning without end. The base is fixed."""
    return p.loadURDF(str(ROBOTS / "zoo.urdf"), useFixedBase=1, flags=p.URDF_USE_INERTIA_FROM_FILE)


@pytest.fixture
def arm(client: int) -> int:
    """Joints: 0 and 1 turning, 2 sliding. The base is fixed."""
    return p.loadURDF(str(ROBOTS / "arm.urdf"), useFixedBase=1, flags=p.URDF_USE_INERTIA_FROM_FILE)


@pytest.fixture
def floating_arm(client: int) -> int:
    """The arm on a base that floats, without gravity."""
    return p.loadURDF(str(ROBOTS / "arm.urdf"), [0.1, 0.2, 0.3], flags=p.URDF_USE_INERTIA_FROM_FILE)


@pytest.fixture
def arm_path() -> str:
    return str(ROBOTS / "arm.urdf")
