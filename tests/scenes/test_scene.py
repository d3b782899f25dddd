"""`World.load`: formats by content, what a scene has, and what it says it leaves out."""

import logging
from pathlib import Path

import pytest

from carom import JointCoupling, Scene, World
from carom.errors import DescriptionError

URDF = """<?xml version="1.0"?>
<!-- <sdf> is no root in a comment -->
<robot name="gripper">
  <link name="palm"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="left"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="right"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="one" type="continuous"><parent link="palm"/><child link="left"/><axis xyz="0 0 1"/>
    <calibration rising="0"/></joint>
  <joint name="two" type="continuous"><parent link="palm"/><child link="right"/><axis xyz="0 0 1"/>
    <mimic joint="one" multiplier="-2" offset="0.5"/><safety_controller k_velocity="1"/></joint>
  <transmission name="a"/>
  <transmission name="b"/>
  <colour rgb="0"/>
</robot>"""
SDF = """<sdf version="1.6"><model name="box"><plugin name="p" filename="f"/><link name="body">
  <inertial><mass>2</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link></model></sdf>"""
MJCF_OPTIONS = {
    "timestep": 0.01, "gravity": (0.0, 0.0, -9.81), "solver_residual_threshold": 1e-11,
    "o_margin": 0.0, "o_solref": (0.02, 1.0), "o_solimp": (0.9, 0.95, 0.001, 0.5, 2.0),
    "o_friction": (1.0, 1.0, 0.005, 0.0001, 0.0001),
}  # fmt: skip
MJCF = """<mujoco model="m"><option timestep="0.01"/>
  <default><geom friction="1"/><default class="used"><geom adhesion="1"/></default></default>
  <worldbody><body name="arm"><joint name="j" armature="0.1"/><geom class="used" size="0.1"/>
    <site name="tip"/></body></worldbody><actuator><motor joint="j"/></actuator></mujoco>"""


@pytest.fixture
def write(tmp_path: Path):
    def write(text: str, name: str = "file.txt") -> Path:
        (tmp_path / name).write_text(text)
        return tmp_path / name

    return write


@pytest.mark.parametrize(("text", "kind"), [(URDF, "URDF"), (SDF, "SDF"), (MJCF, "MJCF")])
def test_the_content_of_a_file_is_its_format(write, text, kind):
    with World() as world:
        scene = world.load(write(text))
        assert isinstance(scene, Scene)
        assert scene.format == kind
        assert len(scene) == 1
        assert list(scene) == scene.bodies == list(world.bodies.values())
        assert scene[scene[0].name] is scene[0]
        assert list(scene.actuators) == ([] if kind != "MJCF" else ["actuator0_0"])
        assert scene.sensors == scene.keyframes == scene.cameras == {}
        assert scene.options == (MJCF_OPTIONS if kind == "MJCF" else {})


def test_a_saved_world_is_a_scene_too(write, tmp_path):
    with World() as world, World() as other:
        world.load(write(URDF))
        world.save(tmp_path / "world.carom")
        # Its name does not matter.
        (tmp_path / "world.carom").rename(tmp_path / "world.xml")
        scene = other.load(tmp_path / "world.xml")
        assert [body.name for body in scene] == ["gripper"]
        assert scene.constraints["two"].coefficients == (0.5, -2.0, 0.0, 0.0, 0.0)
        assert not scene.ignored


def test_names_that_no_body_has_are_named(write):
    with World() as world:
        scene = world.load(write(URDF))
        with pytest.raises(KeyError, match=r"no body has the name 'hand'.*'gripper'"):
            scene["hand"]


@pytest.mark.parametrize(
    ("text", "name", "complaint"),
    [
        ("<html/>", "page", "its first element is <html>; a robot file begins with <robot>"),
        (
            '<robot name="r" xmlns:xacro="x"><xacro:leg/></robot>',
            "r.xacro",
            ":1: <xacro:leg>: there is no macro 'leg'",
        ),
    ],
)
def test_what_is_not_read_is_refused(write, text, name, complaint):
    with World() as world:
        with pytest.raises(DescriptionError, match=complaint):
            world.load(write(text, name))
        assert not world.bodies


def test_what_is_ignored_has_file_line_consequence_and_reason(write):
    with World() as world:
        path = write(URDF)
        scene = world.load(path)
        found = {one.element: one for one in scene.ignored}
        assert set(found) == {
            "joint/calibration",
            "joint/safety_controller",
            "robot/transmission",
            "robot/colour",
        }
        transmission = found["robot/transmission"]
        assert (transmission.file, transmission.line, transmission.count) == (path, 14, 2)
        assert "no element of URDF that Carom knows" in found["robot/colour"].reason
        assert not found["joint/calibration"].matters
        lines = str(scene.ignored).splitlines()
        assert lines[0].split() == [
            "element",
            "attributes",
            "count",
            "where",
            "touches",
            "consequence",
            "reason",
        ]
        assert any("file.txt:14" in line and " 2 " in line for line in lines)
        assert lines[-1].startswith("4 more without effect: 2 robot/transmission, 1 joint/calibration")


def test_one_warning_counts_what_is_ignored(write, caplog):
    with World() as world, caplog.at_level(logging.WARNING, "carom"):
        world.load(write(URDF))
    (message,) = [record.getMessage() for record in caplog.records]
    assert "3 things in it are not simulated" in message
    assert "2 robot/transmission" in message


def test_strict_refuses_what_would_be_ignored(write):
    with World() as world:
        with pytest.raises(DescriptionError, match="robot/transmission"):
            world.load(write(URDF), strict=True)
        assert not world.bodies
        plain = URDF.replace('<safety_controller k_velocity="1"/>', "").replace('<colour rgb="0"/>', "")
        plain = plain.replace('<transmission name="a"/>', "").replace('<transmission name="b"/>', "")
        assert world.load(write(plain), strict=True)


def test_attributes_of_mjcf_are_followed_to_their_defaults(write):
    with World() as world:
        found = {(one.element, one.attributes) for one in world.load(write(MJCF)).ignored}
    # The friction of the class above is used, though no geom states it; `adhesion` is not.
    assert ("default/geom", ("adhesion",)) in found
    assert ("default/geom", ("friction",)) not in found
    assert ("joint", ("armature",)) not in found
    assert not {"body/joint", "body/site", "mujoco/option"} & {element for element, _ in found}


def test_elements_of_included_files_are_reported_there(write):
    part = write('<mujoco><worldbody><body name="b"><geom size="1" gap="3"/></body></worldbody></mujoco>')
    with World() as world:
        scene = world.load(write('<mujoco><include file="file.txt"/></mujoco>', "main.xml"))
        assert [(one.element, one.attributes, one.file) for one in scene.ignored] == [
            ("body/geom", ("gap",), part)
        ]


def test_couplings_have_the_names_of_their_joints(write):
    with World() as world:
        coupling = world.load(write(URDF)).constraints["two"]
        assert coupling.leader is not None
        assert isinstance(coupling, JointCoupling)
        assert (coupling.follower.name, coupling.leader.name) == ("two", "one")
        assert coupling.coefficients == (0.5, -2.0, 0.0, 0.0, 0.0)
        assert coupling.enabled
        assert coupling.error == 0.0
        assert coupling.follower.position == 0.5


@pytest.mark.parametrize(
    ("joint", "reason"), [("three", "there is no joint 'three'"), ("two", "it follows itself")]
)
def test_joints_that_cannot_be_followed_are_reported(write, joint, reason):
    with World() as world:
        scene = world.load(write(URDF.replace('mimic joint="one"', f'mimic joint="{joint}"')))
        (one,) = [one for one in scene.ignored if one.element == "joint/mimic"]
        assert (one.consequence, one.reason, one.line) == ("the joint moves freely", reason, 13)
        assert not scene.constraints


def test_a_scene_is_placed_as_a_whole(write):
    with World() as world:
        text = SDF.replace("<link", "<pose>1 0 0 0 0 0</pose><link")
        scene = world.load(write(text), (0, 0, 2), (0, 0, 1, 0))
        assert scene[0].links[-1].pose.position == pytest.approx((-1.0, 0.0, 2.0))


@pytest.mark.parametrize(
    ("text", "arguments", "complaint"),
    [
        (SDF, {"fixed_base": True}, "fixed_base is for URDF"),
        (MJCF, {"scale": 2.0}, "scale is for URDF and SDF"),
        (URDF, {"missing_meshes": "ignore"}, "missing_meshes is 'ignore'"),
        (URDF, {"default_mass": -1.0}, "default_mass is -1.0"),
    ],
)
def test_arguments_that_fit_no_format_are_refused(write, text, arguments, complaint):
    with World() as world, pytest.raises(ValueError, match=complaint):
        world.load(write(text), **arguments)


def test_what_is_ignored_is_sorted_by_what_it_touches(write):
    text = """<mujoco><asset><texture name="t" type="2d" builtin="flat" width="4" height="4" rgb1="1 0 0"/>
    <material name="m" texture="t" shininess="0.3"/></asset><worldbody><geom size="1" user="1"/>
    <body name="b"><joint name="j"/><geom size="1" material="m"/><site name="s"/></body></worldbody>
    <sensor><plugin plugin="p"/><gyro site="s"/></sensor>
    <actuator><plugin plugin="p" joint="j"/></actuator></mujoco>"""
    with World() as world:
        ignored = world.load(write(text)).ignored
    effects = [one.effect for one in ignored]
    assert effects == sorted(effects, key=["motion", "sensing", "looks", "nothing"].index)
    assert {one.element: one.effect for one in ignored} == {
        "actuator/plugin": "motion",
        "sensor/plugin": "sensing",
        "asset/material": "looks",
        "worldbody/geom": "nothing",
    }
    assert {one.element for one in ignored.that_matter} == {"actuator/plugin", "sensor/plugin"}
    assert str(ignored).splitlines()[-1] == "1 more without effect: 1 worldbody/geom"


def test_robots_that_come_with_carom_load_without_a_warning(caplog):
    with World() as world, caplog.at_level(logging.WARNING, "carom"):
        for path in ("franka_panda/panda.urdf", "kuka_iiwa/model.urdf", "r2d2.urdf", "laikago/laikago.urdf"):
            world.load(path)
    assert not caplog.records
