"""Screws: joints that go along their axis as they turn."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.linearization.scenes import assert_exact, excite, motors_off, tighten
from tests.patience import until
from tests.viewer.watcher import Watcher

from carom import Body, World, Worlds
from carom.cli.convert import convert
from carom.description import JointType
from carom.errors import DescriptionError
from carom.file_bodies import written_sdf_bodies
from carom.formats.reading.cursor import Cursor
from carom.formats.sdf.reader import read_sdf
from carom.formats.sdf.rules import SDF_RULES
from carom.formats.search import AssetSearch
from carom.formats.urdf_writer import urdf_text
from carom.viewer.viewer import Viewer

CHAIN = Path(__file__).parents[1] / "algorithms" / "screws.sdf"
MASS, MOMENT, GRAVITY = 2.0, 0.04, 9.81
NUT = """<sdf version="1.11"><model name="m"><link name="base"><inertial/></link>
<joint name="held" type="fixed"><parent>world</parent><child>base</child></joint>
<link name="nut"><inertial><mass>2</mass>
<inertia><ixx>0.02</ixx><iyy>0.03</iyy><izz>0.04</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial></link>
<joint name="j" type="screw"><parent>base</parent><child>nut</child>{pitch}
<axis><xyz>0 0 1</xyz>{axis}</axis>{inside}</joint></model></sdf>"""
PITCHES = {
    "<screw_thread_pitch>0.5</screw_thread_pitch>": 0.5,
    "<screw_thread_pitch>-0.2</screw_thread_pitch>": -0.2,
    "<thread_pitch>8</thread_pitch>": -2 * pi / 8,
    "": 1.0,
}


def nut(folder: Path, pitch: str = "<screw_thread_pitch>0.5</screw_thread_pitch>", **inside: str) -> Body:
    """A nut on a thread along z, in a world with gravity."""
    file = folder / "nut.sdf"
    file.write_text(NUT.format(pitch=pitch, axis=inside.get("axis", ""), inside=inside.get("inside", "")))
    world = World()
    world.gravity = (0.0, 0.0, -GRAVITY)
    return world.load(file, strict=True).bodies[0]


def chain(**options) -> Body:
    """A hinge, a screw, a slider and a left-handed screw, one after the other and in motion."""
    world = World(**options)
    world.gravity = (0.4, -0.2, -GRAVITY)
    body = world.load(CHAIN).bodies[0]
    excite(body)
    return body


def energy(body: Body) -> float:
    rates, links = body.joints.velocities, list(body.links)
    fallen = sum(body.dynamics(link.index).mass * np.dot(body.world.gravity, link.com) for link in links)
    return float(0.5 * rates @ body.mass_matrix() @ rates - fallen)


@pytest.mark.parametrize("pitch", PITCHES)
def test_a_nut_under_gravity_turns_by_its_pitch_and_inertia(tmp_path: Path, pitch: str):
    body, lead = nut(tmp_path, pitch), PITCHES[pitch] / (2 * pi)
    joint, world = body.joints["j"], body.world
    assert joint.type is JointType.SCREW
    inertia = MOMENT + MASS * lead * lead
    assert_allclose(body.mass_matrix(), [[inertia]], rtol=1e-14)
    assert_allclose(body.inverse_dynamics()[-1], MASS * GRAVITY * lead, rtol=1e-13)
    world.step()
    expected = -MASS * GRAVITY * lead / inertia
    assert joint.velocity == pytest.approx(expected * world.time_step, rel=1e-13)
    world.step(60)
    assert body.links["nut"].pose.position[2] == pytest.approx(lead * joint.position, rel=1e-13)
    assert_allclose(body.links["nut"].velocity[0], (0, 0, lead * joint.velocity), atol=1e-3)


def test_energy_is_kept():
    body = chain(integrator="rk4", time_step=1e-3)
    motors_off(body)
    before, turned = energy(body), body.joints["thread"].position
    body.world.step(500)
    assert abs(body.joints["thread"].position - turned) > 0.3
    assert energy(body) == pytest.approx(before, abs=1e-6)


def test_its_spring_carries_the_nut(tmp_path: Path):
    axis = "<dynamics><spring_stiffness>3</spring_stiffness><damping>0.5</damping></dynamics>"
    body = nut(tmp_path, axis=axis)
    body.world.step(2000)
    assert body.joints["j"].position == pytest.approx(-MASS * GRAVITY * 0.5 / (2 * pi) / 3, rel=1e-9)


def test_its_motor_and_its_limits_hold(tmp_path: Path):
    body = nut(tmp_path, axis="<limit><lower>-0.4</lower><upper>2</upper></limit>")
    joint = body.joints["j"]
    assert joint.limits == (-0.4, 2.0)
    body.world.step(300)
    assert joint.position == pytest.approx(-0.4, abs=2e-3)
    joint.set_position_target(1.0, max_force=50.0)
    body.world.step(500)
    assert joint.position == pytest.approx(1.0, abs=1e-3)
    assert body.links["nut"].pose.position[2] == pytest.approx(0.5 / (2 * pi), abs=1e-3)


def test_a_sensor_feels_the_weight_and_no_torque(tmp_path: Path):
    way = "<force_torque><measure_direction>parent_to_child</measure_direction></force_torque>"
    body = nut(tmp_path, inside=f'<sensor name="s" type="force_torque">{way}</sensor>')
    body.joints["j"].set_position_target(0.0, max_force=50.0)
    body.world.step(100)
    assert_allclose(body.sensors["s/force"].read(), (0, 0, MASS * GRAVITY), atol=1e-6)
    assert_allclose(body.sensors["s/torque"].read(), (0, 0, 0), atol=1e-6)


def test_jacobian_and_positions_of_links_belong_together():
    body = chain()
    q = body.joints.positions
    linear, angular = body.jacobian("tool", positions=q)
    h = 1e-6
    for dof, step in enumerate(h * np.eye(len(q))):
        ahead, behind = (body.forward_kinematics(it, ["tool"])[0] for it in (q + step, q - step))
        assert_allclose(linear[:, dof], (ahead - behind)[:3] / (2 * h), atol=1e-8)
    assert_allclose(np.linalg.norm(angular, axis=0), (1, 1, 0, 1), atol=1e-12)


def test_inverse_kinematics_uses_them():
    body = chain()
    goal = body.forward_kinematics(body.joints.positions, ["tool"])[0]
    found = body.inverse_kinematics("tool", goal[:3], goal[3:], start=body.joints.positions + 0.2)
    assert_allclose(body.forward_kinematics(found.positions, ["tool"])[0], goal, atol=1e-4)


@pytest.mark.parametrize("integrator", ["discrete", "rk4"])
def test_linearised_steps_are_exact(integrator: str):
    body = chain(contact="bullet", integrator=integrator)
    tighten(body.world)
    motors_off(body)
    for joint in body.joints:
        if joint.type is JointType.SCREW:
            joint.armature, joint.damping, joint.stiffness = 0.02, 0.1, 3.0
    body.joints["thread"].set_torque(0.7)
    assert_exact(body.world, parameters=["masses", "inertias"])


def test_many_worlds_are_as_one():
    body = chain()
    worlds = Worlds(body.world, 3)
    body.world.step(20)
    worlds.step(20)
    joints = worlds.bodies[0].joints
    assert (joints.positions == body.joints.positions).all()
    assert (joints.velocities == body.joints.velocities).all()


def test_a_saved_world_has_them(tmp_path: Path):
    body = chain()
    body.world.step(5)
    body.world.save(tmp_path / "world")
    other = World()
    other.load(tmp_path / "world")
    for world in (body.world, other):
        world.step(5)
    assert (other.position == body.world.position).all()


@pytest.mark.parametrize("suffix", ["urdf", "xml", "usda"])
def test_other_formats_have_a_hinge_and_a_slider_that_follows(tmp_path: Path, suffix: str):
    file = tmp_path / f"chain.{suffix}"
    scene, _ = written_sdf_bodies(CHAIN, AssetSearch(), scale=1.0, cursor=Cursor(SDF_RULES))
    if suffix == "urdf":
        file.write_text(urdf_text(scene.robots[0].robot, tmp_path))
    else:
        convert(CHAIN, file)
    world = World()
    scene = world.load(file, fixed_base=True) if suffix == "urdf" else world.load(file)
    copy, body = scene.bodies[0], chain()
    for joint in body.joints.movable:
        copy.joints[joint.name].reset(joint.position)
    for name in ("arm", "nut", "slide", "tool"):
        assert_allclose(copy.links[name].pose.position, body.links[name].pose.position, atol=1e-6)


def test_pybullets_reading_of_files_has_none(tmp_path: Path):
    file = tmp_path / "screw.sdf"
    ends = "<parent>a</parent><child>b</child>"
    links = f'<link name="a"/><link name="b"/><joint name="j" type="screw">{ends}</joint>'
    file.write_text(f'<sdf version="1.7"><model name="m">{links}</model></sdf>')
    with pytest.raises(DescriptionError, match=r"unknown joint type 'screw'; known are revolute, .*, ball$"):
        read_sdf(file)


def test_a_window_shows_its_limits_and_drives_it(tmp_path: Path):
    body = nut(tmp_path, axis="<limit><lower>-0.4</lower><upper>2</upper></limit>")
    viewer = Viewer(body.world, port=0)
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: ("layout", None) in page.shown)
        link = page.shown["body", body.id]["links"][-1]
        page.tell("drive", body=body.id, joint=body.joints["j"].index, mode="position", target=1.0)
        assert until(lambda: body.world.step(10) is None and abs(body.joints["j"].position - 1.0) < 0.01)
    viewer.close()
    assert (link["joint"], link["kind"], link["limits"]) == ("j", "screw", [-0.4, 2.0])
