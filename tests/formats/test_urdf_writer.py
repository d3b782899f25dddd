"""Robots written as URDF and read again are the same."""

from __future__ import annotations

from math import pi
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from pybullet_view import dynamics_infos, joint_infos, with_plain_capsules
from scene_cases import DATA
from test_scenes_against_oracle import differences

from carom import World
from carom.cli.command_line import main
from carom.cli.convert import convert
from carom.description import Link, Pose, Robot, Visual
from carom.description.transform import quaternion_from_rpy, rotation_matrix
from carom.errors import DescriptionError
from carom.formats.mjcf import read_mjcf
from carom.formats.sdf import read_sdf
from carom.formats.urdf import read_urdf
from carom.formats.urdf_writer import roll_pitch_yaw, urdf_text
from carom.layouts.flags import LoadFlags
from carom.model.assemble import assemble

URDFS = sorted(DATA.glob("*.urdf"))
ROBOTS = [
    *(read_urdf(file) for file in URDFS),
    *(
        placed.robot
        for name in ("world", "arm", "sloppy")
        for placed in read_sdf(DATA / "sdf" / f"{name}.sdf")
    ),
    *(
        placed.robot
        for name in ("walker", "scene")
        for placed in read_mjcf(DATA / "mjcf" / f"{name}.xml", colours=True)
    ),
]


@pytest.mark.parametrize(
    "robot", ROBOTS, ids=lambda robot: f"{robot.source.name} {robot.links[robot.root].name}"
)
def test_what_is_written_is_read_again(robot: Robot, tmp_path: Path) -> None:
    file = tmp_path / "robot.urdf"
    file.write_text(urdf_text(robot, tmp_path), encoding="utf-8")
    again = read_urdf(file)
    assert again.name == robot.name
    assert again.user_data == robot.user_data
    for flags in (LoadFlags.NONE, LoadFlags.USE_INERTIA_FROM_FILE):
        before = assemble(with_plain_capsules(robot), flags=flags)
        after = assemble(again, flags=flags)
        assert differences(joint_infos(after), joint_infos(before)) == []
        assert differences(dynamics_infos(after), dynamics_infos(before)) == []
    for old, new in zip(robot.links, again.links, strict=True):
        assert (new.name, new.contact, new.user_data) == (old.name, old.contact, old.user_data)
        assert_same_shapes(old, new)


def assert_same_shapes(old: Link, new: Link) -> None:
    for first, second in zip((*old.collisions, *old.visuals), (*new.collisions, *new.visuals), strict=True):
        assert type(first.geometry) is type(second.geometry)
        assert first.name == second.name
        assert_allclose(first.frame.position, second.frame.position, rtol=0, atol=1e-12)
        assert_allclose(
            rotation_matrix(first.frame.orientation),
            rotation_matrix(second.frame.orientation),
            rtol=0,
            atol=1e-9,
        )
        if isinstance(first, Visual) and isinstance(second, Visual):
            assert (first.material is None) == (second.material is None)
            if first.material and second.material:
                assert first.material.rgba == second.material.rgba
                assert first.material.specular == second.material.specular


@given(st.tuples(*[st.floats(-pi, pi)] * 3))
def test_angles_turn_as_the_quaternion_does(angles: tuple[float, float, float]) -> None:
    quaternion = quaternion_from_rpy(*angles)
    again = quaternion_from_rpy(*roll_pitch_yaw(quaternion))
    # Near the gimbal lock the angles are known to half of the digits.
    assert_allclose(rotation_matrix(again), rotation_matrix(quaternion), rtol=0, atol=1e-5)


def test_names_are_escaped(tmp_path: Path) -> None:
    robot = Robot('a "b" <c> & d', (Link("x > y & 'z'", user_data={"<k>": "<v> & w"}),), ())
    file = tmp_path / "robot.urdf"
    file.write_text(urdf_text(robot, tmp_path), encoding="utf-8")
    again = read_urdf(file)
    assert again.name == robot.name
    assert again.links[0].name == robot.links[0].name
    assert again.links[0].user_data == robot.links[0].user_data


def test_a_shape_urdf_cannot_say_is_named(tmp_path: Path) -> None:
    source = tmp_path / "egg.xml"
    source.write_text(
        '<mujoco><worldbody><body name="egg"><geom type="ellipsoid" size="1 1 2"/></body>'
        "</worldbody></mujoco>"
    )
    with pytest.raises(DescriptionError, match="link 'egg' has a shape that URDF does not have: ConvexHull"):
        urdf_text(read_mjcf(source)[0].robot, tmp_path)


def test_the_command_converts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "arm.urdf"
    assert main(["convert", str(DATA / "sdf" / "arm.sdf"), str(target)]) == 0
    assert [joint.name for joint in read_urdf(target).joints] == [
        "shoulder",
        "lift",
        "wrist",
        "mount",
        "root_of_tail",
    ]

    world = str(DATA / "sdf" / "world.sdf")
    assert main(["convert", world, str(target)]) == 1
    assert "several robots fit; it holds 0 ground (floor), 1 crate (box)" in capsys.readouterr().err
    assert main(["convert", world, str(target), "--model", "pillar"]) == 0
    assert read_urdf(target).links[0].inertial.mass == 0.0
    assert main(["convert", world, str(target), "--model", "nobody"]) == 1
    assert "there is no robot 'nobody'" in capsys.readouterr().err
    assert main(["convert", str(DATA / "mjcf" / "walker.xml"), str(target), "--model", "torso"]) == 0
    assert main(["convert", "nowhere.sdf", str(target)]) == 1
    (tmp_path / "robot.step").write_text("ISO-10303-21;")
    assert main(["convert", str(tmp_path / "robot.step"), str(target)]) == 1
    assert "a robot file begins with <robot>" in capsys.readouterr().err


def test_links_of_mjcf_files_keep_the_moments_of_their_geoms(tmp_path: Path) -> None:
    source, target = DATA / "mjcf" / "walker.xml", tmp_path / "walker.urdf"
    convert(source, target, "torso")
    walker = World().load(source)["torso"].spec
    (written,) = World().load(target)
    # Bodies without names get others there; links that joints make have no mass.
    expected, given = (
        [sorted(link.inertia) for link in (spec.base, *spec.links) if "@" not in link.name]
        for spec in (walker, written.spec)
    )
    assert any(sum(moments) > 0.0 for moments in expected)
    assert_allclose(given, expected, rtol=1e-12)


def test_meshes_are_named_as_seen_from_the_file(tmp_path: Path) -> None:
    target = DATA / "sdf" / "rock_by_test.urdf"
    (rock,) = [placed.robot for placed in read_sdf(DATA / "sdf" / "world.sdf") if placed.robot.name == "rock"]
    assert 'filename="../meshes/two_boxes.obj"' in urdf_text(rock, target.parent)
    assert Pose() == rock.links[0].inertial.frame
