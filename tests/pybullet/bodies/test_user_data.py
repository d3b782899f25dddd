"""User data: what PyBullet 3.2.7 answered is what is expected here."""

from pathlib import Path

import pytest

import pybullet as p
import pybullet_data

INERTIAL = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"
SEEN = "<geometry><sphere radius='1'/></geometry>"


def stated(key: str, value: str) -> str:
    return f"<bullet><user-data key='{key}'>{value}</user-data></bullet>"


@pytest.fixture
def bodies():
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    yield p.loadURDF("r2d2.urdf"), p.loadURDF("cube_small.urdf")
    p.disconnect()


def infos(body: int) -> list[tuple]:
    return [p.getUserDataInfo(body, index) for index in range(p.getNumUserData(body))]


def test_adding_replacing_and_finding(bodies) -> None:
    body, other = bodies
    assert p.getNumUserData(body) == 0
    assert (p.addUserData(body, "k", "v"), p.addUserData(body, "k", "w")) == (0, 0)
    assert p.getUserData(0) == b"w"
    assert p.addUserData(body, "k", "link", linkIndex=2) == 1
    assert p.addUserData(body, "k", "shape", visualShapeIndex=0) == 2
    assert p.addUserData(other, "zz", "vis", -1, 3) == 3
    assert infos(body) == [(0, b"k", 0, -1, -1), (1, b"k", 0, 2, -1), (2, b"k", 0, -1, 0)]
    assert p.getUserDataId(body, "k") == 0
    assert p.getUserDataId(body, "k", 2) == 1
    assert p.getUserDataId(body, "k", -1, 0) == 2
    assert p.getUserDataId(body, "nope") == p.getUserDataId(99, "k") == -1
    assert p.getUserData(99) is None
    assert p.getNumUserData(99) == 0


def test_ids_are_used_again_the_last_removed_first(bodies) -> None:
    body, _ = bodies
    for key in "abcdef":
        p.addUserData(body, key, "v")
    for removed in (0, 3, 1, 4):
        p.removeUserData(removed)
    assert [p.addUserData(body, key, "v") for key in "ghijk"] == [4, 1, 3, 0, 6]


def test_removing_puts_the_last_in_its_place_and_frees_the_id(bodies) -> None:
    body, _ = bodies
    for key in ("k", "q0", "q1", "q2", "q3", "q4"):
        p.addUserData(body, key, "v")
    p.removeUserData(2)
    p.removeUserData(1)
    assert (p.addUserData(body, "a", "x"), p.addUserData(body, "b", "x")) == (1, 2)
    assert [(info[0], info[1]) for info in infos(body)] == [
        (0, b"k"),
        (4, b"q3"),
        (5, b"q4"),
        (3, b"q2"),
        (1, b"a"),
        (2, b"b"),
    ]


def test_data_go_with_their_body(bodies) -> None:
    body, other = bodies
    number = p.addUserData(other, "k", "v")
    p.removeBody(other)
    assert p.getUserData(number) is None
    assert p.getNumUserData(other) == 0
    p.addUserData(body, "k", "v")
    p.resetSimulation()
    assert p.getNumUserData(body) == 0


def test_states_do_not_hold_them(bodies) -> None:
    state = p.saveState()
    p.addUserData(bodies[0], "k", "é")
    p.restoreState(state)
    assert p.getUserData(0) == "é".encode()


def test_what_a_file_states(bodies, tmp_path: Path) -> None:
    file = tmp_path / "stated.urdf"
    file.write_text(
        f"<robot name='u'>{stated('r', 'robot')}{stated('r0', '  robot x ')}<link name='base'>{INERTIAL}"
        f"<visual>{SEEN}{stated('v', 'vis0')}</visual><visual>{SEEN}{stated('v', 'vis1')}</visual>"
        f"{stated('l', 'lbase')}</link><link name='l2'>{INERTIAL}<visual>{SEEN}{stated('v', 'l2vis0')}"
        f"</visual>{stated('l', 'l2')}{stated('z', 'first')}{stated('z', 'second')}</link>"
        "<joint name='j' type='fixed'><parent link='base'/><child link='l2'/></joint></robot>"
    )
    body = p.loadURDF(str(file))
    p.syncUserData()
    assert [(*info[1:], p.getUserData(info[0])) for info in infos(body)] == [
        (b"r", body, -1, -1, b"robot"),
        (b"r0", body, -1, -1, b"  robot x "),
        (b"l", body, -1, -1, b"lbase"),
        (b"v", body, -1, 0, b"vis0"),
        (b"v", body, -1, 1, b"vis1"),
        (b"l", body, 0, -1, b"l2"),
        (b"z", body, 0, -1, b"second"),
        (b"v", body, 0, 0, b"l2vis0"),
    ]


def test_refusals(bodies) -> None:
    body, _ = bodies
    with pytest.raises(p.error, match=r"^Error in addUserData command\."):
        p.addUserData(99, "k", "v")
    with pytest.raises(p.error, match=r"^Could not get user data info\."):
        p.getUserDataInfo(body, 0)
    with pytest.raises(p.error, match=r"^Error in removeUserData command\."):
        p.removeUserData(5)
    with pytest.raises(p.error, match="null character"):
        p.addUserData(body, "a\0b", "c")
    with pytest.raises(TypeError):
        p.addUserData(body, b"k", "v")  # type: ignore[arg-type]


def test_synchronising_checks_the_bodies(bodies) -> None:
    body, other = bodies
    assert p.syncUserData() is p.syncUserData(body) is p.syncUserData(bodyUniqueIds=[body, other]) is None
    for arguments, keywords in (((99,), {}), ((), {"bodyUniqueIds": [body, 99]}), ((), {"bodyUniqueIds": 5})):
        with pytest.raises(p.error, match=r"^Error in syncUserInfo command\."):
            p.syncUserData(*arguments, **keywords)
