from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import pybullet as p
import pybullet_data
from pybullet_utils.urdfEditor import UrdfEditor


@pytest.fixture
def client() -> Iterator[int]:
    number = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    yield number
    p.disconnect(number)


def editor_of(file: str, client: int) -> UrdfEditor:
    body = p.loadURDF(file, physicsClientId=client)
    editor = UrdfEditor()
    editor.initializeFromBulletBody(body, client)
    p.removeBody(body, client)
    return editor


@pytest.mark.parametrize(
    "file", ["TwoJointRobot_w_fixedJoints.urdf", "r2d2.urdf", "cartpole.urdf", "husky/husky.urdf"]
)
def test_a_written_robot_is_the_robot(file: str, client: int, tmp_path: Path) -> None:
    original = p.loadURDF(file, physicsClientId=client)
    editor = UrdfEditor()
    editor.initializeFromBulletBody(original, client)
    path = tmp_path / "written.urdf"
    editor.saveUrdf(str(path))
    copy = p.loadURDF(str(path), flags=p.URDF_USE_INERTIA_FROM_FILE, physicsClientId=client)
    assert p.getNumJoints(copy) == p.getNumJoints(original)
    assert p.getBodyInfo(copy) == p.getBodyInfo(original)
    for link in range(-1, p.getNumJoints(copy)):
        ours, theirs = p.getDynamicsInfo(copy, link), p.getDynamicsInfo(original, link)
        # A pitch near 90 degrees comes back from roll, pitch and yaw with fewer digits.
        for field in (0, 2, 3, 4):
            assert ours[field] == pytest.approx(theirs[field], abs=1e-4)
        assert len(p.getCollisionShapeData(copy, link)) == len(p.getCollisionShapeData(original, link))
    for joint in range(p.getNumJoints(copy)):
        ours, theirs = p.getJointInfo(copy, joint), p.getJointInfo(original, joint)
        assert (ours[1], ours[2], ours[12], ours[16]) == (theirs[1], theirs[2], theirs[12], theirs[16])
        for field in (8, 9, 10, 11, 13, 14):
            assert ours[field] == pytest.approx(theirs[field], abs=1e-6)
        assert abs(sum(a * b for a, b in zip(ours[15], theirs[15], strict=True))) == pytest.approx(1.0)
    assert len(p.getVisualShapeData(copy)) == len(p.getVisualShapeData(original))


def test_without_looks_nothing_is_seen(client: int, tmp_path: Path) -> None:
    editor = editor_of("cartpole.urdf", client)
    path = tmp_path / "bare.urdf"
    editor.saveUrdf(str(path), saveVisuals=False)
    assert "<visual>" not in path.read_text()


def test_names_may_have_any_characters(client: int, tmp_path: Path) -> None:
    editor = editor_of("cartpole.urdf", client)
    editor.robotName = 'cart & "pole" <1>'
    path = tmp_path / "named.urdf"
    editor.saveUrdf(str(path))
    assert p.getBodyInfo(p.loadURDF(str(path)))[1].decode() == 'cart & "pole" <1>'


def test_joined_robots_are_one_body(client: int) -> None:
    arm, cube = editor_of("TwoJointRobot_w_fixedJoints.urdf", client), editor_of("cube_small.urdf", client)
    joint = arm.joinUrdf(cube, 1, [0.1, 0, 0], [0, 0, 0], [0, 0, 0.1], [0, 0, 0], client, client)
    joint.joint_type = p.JOINT_FIXED
    body = arm.createMultiBody([0, 0, 2], physicsClientId=client)
    assert p.getNumJoints(body) == 7
    info = p.getJointInfo(body, 6)
    assert info[12] == b"baseLink"
    assert info[2] == p.JOINT_FIXED
    # The pivot lies 10 cm above the cube's centre, and 10 cm beside the link's frame.
    link, cube_state = p.getLinkState(body, 0), p.getLinkState(body, 6)
    assert link is not None and cube_state is not None
    assert cube_state[0] == pytest.approx([link[4][0] + 0.1, link[4][1], link[4][2] - 0.1])


def test_robots_are_joined_at_their_frames_unless_told_otherwise(client: int) -> None:
    first, second = editor_of("cube_small.urdf", client), editor_of("cube_small.urdf", client)
    joint = first.joinUrdf(second, parentPhysicsClientId=client, childPhysicsClientId=client)
    assert joint is first.urdfJoints[-1]
    body = first.createMultiBody([0, 0, 2], physicsClientId=client)
    state = p.getLinkState(body, 0)
    assert state is not None
    assert state[0] == pytest.approx([0, 0, 2])


def test_names_that_are_taken_get_a_number(client: int) -> None:
    first, second = editor_of("cartpole.urdf", client), editor_of("cartpole.urdf", client)
    first.joinUrdf(second, 2)
    names = [link.link_name for link in first.urdfLinks]
    assert len(set(names)) == len(names) == 6
    assert p.getNumJoints(first.createMultiBody(physicsClientId=client)) == 5
