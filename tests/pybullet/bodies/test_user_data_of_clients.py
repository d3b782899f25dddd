"""User data of several clients: each has a copy of its own, which `syncUserData` renews."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from tests.servers import Servers

import pybullet as p
import pybullet_data


@pytest.fixture
def clients(servers: Servers, key: int) -> Iterator[tuple[int, int]]:
    servers.open(key)
    pair = p.connect(p.SHARED_MEMORY, key), p.connect(p.SHARED_MEMORY, key)
    p.setAdditionalSearchPath(pybullet_data.getDataPath(), physicsClientId=pair[0])
    p.loadURDF("plane.urdf", physicsClientId=pair[0])
    p.loadURDF("cube_small.urdf", physicsClientId=pair[0])
    yield pair
    for client in pair:
        if p.isConnected(client):
            p.disconnect(client)
    servers.close(key)


def values(client: int, count: int = 3) -> list[bytes | None]:
    return [p.getUserData(number, physicsClientId=client) for number in range(count)]


def test_changes_of_others_appear_after_synchronising(clients: tuple[int, int]) -> None:
    one, two = clients
    p.addUserData(0, "k", "v", physicsClientId=one)
    assert (values(one, 1), values(two, 1)) == ([b"v"], [None])
    assert p.getNumUserData(0, physicsClientId=two) == 0
    assert p.getUserDataId(0, "k", physicsClientId=two) == -1
    p.syncUserData(physicsClientId=two)
    assert values(two, 1) == [b"v"]
    # Replaced by the second, which the first does not know yet.
    assert p.addUserData(0, "k", "w", physicsClientId=two) == 0
    assert (values(one, 1), values(two, 1)) == ([b"v"], [b"w"])
    p.syncUserData(0, physicsClientId=one)
    assert values(one, 1) == [b"w"]
    # Removed by the first.
    p.removeUserData(0, physicsClientId=one)
    assert (values(one, 1), values(two, 1)) == ([None], [b"w"])
    p.syncUserData(bodyUniqueIds=[0], physicsClientId=two)
    assert values(two, 1) == [None]


def test_who_connects_knows_all_there_are(clients: tuple[int, int], key: int) -> None:
    one, two = clients
    p.addUserData(0, "k", "é", 2, 3, physicsClientId=one)
    p.addUserData(1, "l", "w", physicsClientId=two)
    p.disconnect(one)
    again = p.connect(p.SHARED_MEMORY, key)
    assert values(again) == ["é".encode(), b"w", None]
    assert p.getUserDataInfo(0, 0, physicsClientId=again) == (0, b"k", 0, 2, 3)
    p.disconnect(again)


def test_they_go_with_their_bodies(clients: tuple[int, int]) -> None:
    one, two = clients
    p.addUserData(0, "k", "v", physicsClientId=one)
    p.addUserData(1, "l", "w", physicsClientId=one)
    p.syncUserData(physicsClientId=two)
    p.removeBody(0, physicsClientId=one)
    assert (values(one), values(two)) == ([None, b"w", None], [b"v", b"w", None])
    p.resetSimulation(physicsClientId=one)
    assert values(one) == [None] * 3
    p.syncUserData(physicsClientId=two)
    assert values(two) == [None] * 3


def test_errors_are_those_of_one_world(clients: tuple[int, int]) -> None:
    one, _ = clients
    with pytest.raises(p.error, match=r"Error in syncUserInfo command"):
        p.syncUserData(7, physicsClientId=one)
    with pytest.raises(p.error, match=r"Could not get user data info"):
        p.getUserDataInfo(0, 0, physicsClientId=one)
    with pytest.raises(TypeError):
        p.getUserDataId(0, physicsClientId=one)  # type: ignore[call-arg]
    with pytest.raises(p.error, match="null character"):
        p.addUserData(0, "k\0", "v", physicsClientId=one)


def test_the_server_itself_is_one_of_the_clients(key: int) -> None:
    server = p.connect(p.SHARED_MEMORY_SERVER, key)
    client = p.connect(p.SHARED_MEMORY, key)
    p.setAdditionalSearchPath(pybullet_data.getDataPath(), physicsClientId=client)
    p.loadURDF("plane.urdf", physicsClientId=client)
    p.addUserData(0, "k", "v", physicsClientId=client)
    assert values(server, 1) == [None]
    p.addUserData(0, "l", "w", physicsClientId=server)
    assert (values(server, 2), values(client, 2)) == ([None, b"w"], [b"v", None])
    for one in (server, client):
        p.syncUserData(physicsClientId=one)
    assert values(server, 2) == values(client, 2) == [b"v", b"w"]
    p.disconnect(client)
    p.disconnect(server)
