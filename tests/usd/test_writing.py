"""Robots written as USD: the round trip, what is said beside the schema, and what is not said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.each import each

from carom import World
from carom.algorithms.mass_matrix import mass_matrix
from carom.cli.command_line import main
from carom.cli.convert import convert
from carom.scene.body import Body

pxr = pytest.importorskip("pxr", reason="usd-core writes the stages")

URDF = """<robot name="two parts"><link name="base link"><inertial><origin xyz=".1 .2 .3" rpy=".3 .2 .1"/>
<mass value="1.1"/><inertia ixx=".1" ixy=".01" ixz=".02" iyy=".2" iyz=".03" izz=".25"/></inertial>
<collision><origin rpy=".1 .2 .3"/><geometry><box size=".1 .2 .3"/></geometry></collision></link>
<link name="arm"><inertial><mass value=".7"/>
<inertia ixx=".01" ixy="0" ixz="0" iyy=".02" iyz="0" izz=".025"/></inertial>
<collision><geometry><cylinder radius=".1" length=".3"/></geometry></collision></link>
<link name="finger"><inertial><mass value=".1"/>
<inertia ixx=".001" ixy="0" ixz="0" iyy=".001" iyz="0" izz=".001"/>
</inertial></link><link name="tip"/>
<joint name="shoulder" type="revolute"><parent link="base link"/><child link="arm"/>
<origin xyz=".1 .2 .3" rpy=".4 .5 .6"/><axis xyz="1 2 3"/>
<limit lower="-1.1" upper="1.3" effort="7" velocity="3"/>
<dynamics damping=".3" friction=".2"/></joint>
<joint name="slide" type="prismatic"><parent link="arm"/><child link="finger"/><origin xyz="0 .1 0"/>
<axis xyz="0 1 0"/>

<limit lower="0" upper=".2" effort="1" velocity="1"/>
<mimic joint="shoulder" multiplier=".1" offset=".01"/></joint>
<joint name="end" type="fixed"><parent link="finger"/><child link="tip"/>
<origin xyz="0 0 .1"/></joint></robot>"""


def round_trip(tmp_path: Path, suffix: str = ".usda") -> tuple[Body, Body]:
    """The robot, and what is read of it from USD."""
    source, target = tmp_path / "robot.urdf", tmp_path / f"robot{suffix}"
    source.write_text(URDF)
    convert(source, target)
    return World().load(source)[0], World().load(target, strict=True)[0]


@each("suffix", [".usda", ".usdc", ".usdz"])
def test_a_round_trip_keeps_poses_and_masses(tmp_path: Path, suffix: str):
    robot, again = round_trip(tmp_path, suffix)
    assert [it.name for it in again.links] == [it.name for it in robot.links]
    assert [it.name for it in again.joints] == [it.name for it in robot.joints]
    random = np.random.default_rng(1)
    for _ in range(5):
        positions = random.uniform(-1, 1, 2)
        assert_allclose(mass_matrix(again, positions), mass_matrix(robot, positions), rtol=0, atol=1e-12)
        for it in (robot, again):
            it.joints["shoulder"].reset(positions[0])
        for link in robot.links:
            pose, same = link.pose, again.links[link.name].pose
            assert_allclose(same.position, pose.position, rtol=0, atol=1e-12)
            assert min(abs(same.orientation - pose.orientation).max(),
                       abs(same.orientation + pose.orientation).max()) < 1e-12  # fmt: skip


def test_a_round_trip_keeps_joints_and_shapes(tmp_path: Path):
    robot, again = round_trip(tmp_path)
    for name in ("shoulder", "slide"):
        first, second = robot.joints[name], again.joints[name]
        assert_allclose(second.limits, first.limits, rtol=1e-14)
        assert (second.damping, second.friction_loss) == (first.damping, first.friction_loss)
    assert_allclose(again.joints["slide"].position, 0.01, rtol=1e-12)
    for link, same in zip(
        (robot.spec.base, *robot.spec.links), (again.spec.base, *again.spec.links), strict=True
    ):
        assert [it.geometry for it in same.collisions] == [it.geometry for it in link.collisions]
    # Its drive is the motor of the effort.
    assert_allclose(again.actuators["shoulder"].force_range, (-7, 7))


def test_a_number_that_another_program_changes_counts(tmp_path: Path):
    round_trip(tmp_path)
    file = tmp_path / "robot.usda"
    text = file.read_text()
    assert "carom:physics:mass = 1.1" in text
    file.write_text(text.replace("float physics:mass = 1.1", "float physics:mass = 2.5"))
    assert World().load(file)[0].spec.base.mass == 2.5


def test_a_fixed_base_is_held_and_meshes_are_copied(tmp_path: Path):
    lost = convert(Path("kuka_iiwa/model.urdf"), tmp_path / "arm.usdc")
    assert not lost.that_matter
    (arm,) = World().load(tmp_path / "arm.usdc", strict=True)
    (same,) = World().load("kuka_iiwa/model.urdf")
    assert arm.fixed_base
    assert_allclose(mass_matrix(arm, np.ones(7)), mass_matrix(same, np.ones(7)), rtol=0, atol=1e-12)


def test_what_usd_does_not_say_is_reported(tmp_path: Path):
    source = tmp_path / "model.xml"
    source.write_text(
        '<mujoco><worldbody><body name="b"><joint name="j" type="ball" damping="1"/><geom size=".1"/></body>'
        "</worldbody></mujoco>"
    )
    lost = convert(source, tmp_path / "model.usda")
    assert "joint" in {one.element for one in lost.that_matter}


def test_the_command_says_what_is_lost(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    source = tmp_path / "model.xml"
    source.write_text(
        '<mujoco><worldbody><body name="b"><joint name="j"/><geom size=".1"/></body></worldbody>'
        '<actuator><motor joint="j"/></actuator></mujoco>'
    )
    main(["convert", str(source), str(tmp_path / "model.usda")])
    assert "mujoco/actuator" in capsys.readouterr().out


def test_a_scaled_inertia_is_written_scaled(tmp_path: Path):
    source = tmp_path / "robot.urdf"
    source.write_text(
        '<robot name="r"><link name="a"><contact><inertia_scaling value="3"/></contact><inertial>'
        '<mass value="1"/>'
        '<inertia ixx=".1" ixy="0" ixz="0" iyy=".1" iyz="0" izz=".1"/></inertial></link></robot>'
    )
    assert not convert(source, tmp_path / "robot.usda").that_matter
    assert_allclose(World().load(tmp_path / "robot.usda")[0].spec.base.inertia, [0.3] * 3, rtol=1e-15)


@each("moment", ["0", "-0.1"])
def test_moments_that_no_body_has_are_kept(tmp_path: Path, moment: str):
    source = tmp_path / "robot.urdf"
    source.write_text(
        '<robot name="r"><link name="a"><inertial><mass value="1"/>'
        f'<inertia ixx="{moment}" ixy="0" ixz="0" iyy="{moment}" iyz="0" izz="{moment}"/></inertial>'
        '<collision><geometry><sphere radius="1"/></geometry></collision></link></robot>'
    )
    convert(source, tmp_path / "robot.usda")
    first, second = World().load(source)[0], World().load(tmp_path / "robot.usda")[0]
    assert_allclose(second.spec.base.inertia, first.spec.base.inertia, rtol=1e-15)


def test_a_link_with_inertia_alone_is_kept(tmp_path: Path):
    source = tmp_path / "robot.urdf"
    inertia = '<inertia ixx=".1" ixy="0" ixz="0" iyy=".2" iyz="0" izz=".3"/>'
    source.write_text(
        f'<robot name="r"><link name="a"><inertial><mass value="1"/>{inertia}</inertial></link>'
        f'<link name="b"><inertial><mass value="0"/>{inertia}</inertial></link>'
        '<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint></robot>'
    )
    convert(source, tmp_path / "robot.usda")
    first, second = World().load(source)[0], World().load(tmp_path / "robot.usda")[0]
    assert second.spec.links[0].mass == 0.0
    assert_allclose(mass_matrix(second, [0.3]), mass_matrix(first, [0.3]), rtol=0, atol=1e-15)
