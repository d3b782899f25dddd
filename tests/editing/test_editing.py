"""Descriptions are changed before they are compiled: attached, merged, scaled, renamed, cut."""

from pathlib import Path
from typing import Any, cast
from xml.etree import ElementTree

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.editing.examples import ARM, GRIPPER
from tests.editing.motion import assert_same_dynamics

import carom
from carom import World, algorithms
from carom.errors import DescriptionError

CUBE = Path(__file__).parents[2] / "src" / "pybullet_data" / "cube.obj"


@pytest.fixture
def read(tmp_path):
    def read(text, name="file"):
        (tmp_path / f"{name}.xml").write_text(text)
        return carom.read(tmp_path / f"{name}.xml")

    return read


def test_an_unchanged_description_is_the_file(read, tmp_path):
    description = read(ARM)
    scene = World().load(description)
    loaded = World().load(tmp_path / "file.xml")
    assert_same_dynamics(loaded.bodies, scene.bodies)
    for what in ("sensors", "actuators", "tendons", "sites", "keyframes"):
        assert list(getattr(scene, what)) == list(getattr(loaded, what))
    assert scene.actuators["lift"].spec == loaded.actuators["lift"].spec
    assert scene["upper"].joints["shoulder"].limits == loaded["upper"].joints["shoulder"].limits
    assert description.joints["shoulder"]["damping"] == ".5"
    assert_allclose(float(description.joints["elbow"]["ref"]), np.pi / 6)


def test_a_gripper_is_attached_to_an_arm(read):
    arm, gripper = read(ARM), read(GRIPPER, "gripper")
    lost = arm.attach(gripper, at="tip", prefix="left_", position=(0, 0, 0.01))
    assert {it.element for it in lost} == {"body/freejoint", "option"}
    assert "left_finger" in arm.bodies
    assert "palm" in gripper.bodies
    assert "free" in gripper.joints
    scene = World().load(arm)
    assert list(scene.actuators) == ["lift", "pull", "left_grip"]
    assert list(scene.sensors) == ["angle", "end", "left_opening", "left_drift"]
    body = scene["upper"]
    # The site is turned by 90 degrees about y, so the z axis of the gripper is the x axis of the arm.
    palm, lower = body.links["left_palm"].pose, body.links["lower"].pose
    assert_allclose(np.linalg.norm(palm.position - lower.position), 0.4 + 0.01 + 0.05, rtol=1e-12)
    # Twice on the same arm, with another prefix.
    arm.attach(gripper, at="upper", prefix="right_")
    assert len(World().load(arm).actuators) == 4


def test_keyframes_keep_what_they_say_of_each_joint(read):
    arm, gripper = read(ARM), read(GRIPPER, "gripper")
    arm.attach(gripper, at="tip")
    # Both are called `home`: they become one. The free joint of the gripper is gone.
    assert list(arm.keyframes) == ["home"]
    assert [float(word) for word in arm.keyframes["home"]["qpos"].split()] == [0.1, 0.2, 0.01]
    assert [float(word) for word in arm.keyframes["home"]["ctrl"].split()] == [0.3, 0.4, 0.02]
    arm.remove("elbow")
    assert [float(word) for word in arm.keyframes["home"]["qpos"].split()] == [0.1, 0.01]
    # The motor pulled the tendon over the elbow, which went as well.
    assert [float(word) for word in arm.keyframes["home"]["ctrl"].split()] == [0.3, 0.02]
    other = read(GRIPPER, "gripper")
    arm.merge(other, prefix="b_", position=(1.0, 2.0, 3.0), orientation=(0, 0, 1, 1))
    numbers = [float(word) for word in arm.keyframes["b_home"]["qpos"].split()]
    # The arm is at its reference there, and the free gripper where the pose puts it.
    assert_allclose(numbers, [0.0, 0.0, 1.0, 2.0, 3.05, 0.5**0.5, 0.0, 0.0, 0.5**0.5, 0.01], atol=1e-15)
    scene = World().load(arm)
    scene.reset("b_home")
    assert_allclose(scene["b_palm"].pose.position, [1.0, 2.0, 3.05], atol=1e-15)


def test_what_a_keyframe_does_not_state_is_that_of_the_start(read):
    """MuJoCo takes keys with fewer controls than there are actuators."""
    arm = read(ARM.replace('ctrl=".3 .4"', 'ctrl=".3"'))
    arm.attach(read(GRIPPER, "gripper"), at="tip")
    assert [float(word) for word in arm.keyframes["home"]["ctrl"].split()] == [0.3, 0.0, 0.02]


def test_merged_robots_are_beside_each_other(read, tmp_path):
    arm = read(ARM)
    arm.merge(read(ARM), prefix="b_", position=(0.0, 2.0, 0.0))
    scene = World().load(arm)
    assert [body.name for body in scene] == ["upper", "b_upper"]
    assert_allclose(scene["b_upper"].links["b_lower"].pose.position, [0.5, 2.0, 1.0], atol=1e-12)
    assert scene.actuators["b_lift"].spec.gain == scene.actuators["lift"].spec.gain
    one = World().load(tmp_path / "file.xml")
    matrix = algorithms.mass_matrix(one["upper"], [0.3, 0.4])
    for body in scene:
        assert_allclose(algorithms.mass_matrix(body, [0.3, 0.4]), matrix, rtol=1e-12)


def test_equal_names_are_refused_with_the_cure(read):
    arm = read(ARM)
    before = arm.text()
    with pytest.raises(DescriptionError, match=r"file.xml:4.*both descriptions have body 'upper'.*prefix="):
        arm.merge(read(ARM))
    arm.merge(read(ARM), prefix="b_")
    with pytest.raises(DescriptionError, match="with another prefix than 'b_'"):
        arm.merge(read(ARM), prefix="b_")
    assert before != arm.text()
    assert arm.text().count('name="b_upper"') == 1


def test_what_is_not_there_is_named(read):
    arm = read(ARM)
    with pytest.raises(KeyError, match=r"arm has no site or body 'tipp'; did you mean 'tip'\?"):
        arm.attach(read(GRIPPER), at="tipp")
    with pytest.raises(KeyError, match=r"arm has no joint 'elbo'; did you mean 'elbow'\? it has 'shoulder'"):
        arm.joints["elbo"]
    with pytest.raises(KeyError, match="arm has no part 'nothing'"):
        arm.remove("nothing")
    with pytest.raises(
        ValueError, match=r"<joint> of MJCF has no attribute 'dampin'; did you mean 'damping'"
    ):
        arm.joints["elbow"]["dampin"] = 1.0
    with pytest.raises(ValueError, match="there is a joint 'elbow' already"):
        arm.rename("shoulder", "elbow")
    with pytest.raises(ValueError, match="there is a site 'tip' already"):
        arm.bodies["lower"].add("site", name="tip")
    with pytest.raises(ValueError, match="a body has no <motor>"):
        arm.bodies["lower"].add("motor", name="m")
    with pytest.raises(ValueError, match="site 'tip' holds no other elements"):
        arm.sites["tip"].add("geom", size=0.1)
    with pytest.raises(ValueError, match="there is no section 'actuators'"):
        arm.add("actuators", "motor", name="m")
    with pytest.raises(ValueError, match="a name must not be empty"):
        arm.rename("elbow", "")
    with pytest.raises(ValueError, match="expected a positive number"):
        arm.scale(0.0)
    with pytest.raises(ValueError, match="orientation has no length"):
        arm.merge(read(GRIPPER), orientation=(0, 0, 0, 0))
    with pytest.raises(AttributeError, match="no attribute 'nam'; did you mean 'name'"):
        arm.nam = "x"


def test_errors_of_changed_descriptions_name_the_file_of_the_part(read, tmp_path):
    arm = read(ARM)
    arm.merge(read(GRIPPER, "gripper"), prefix="g_")
    arm.joints["g_slide"]["axis"] = (0, 0, 0)
    with pytest.raises(DescriptionError, match=r"gripper.xml:3.*g_slide.*the axis has no length"):
        World().load(arm)


def test_one_name_of_several_kinds_needs_a_kind(read):
    text = ARM.replace('name="elbow"', 'name="lower"').replace('"elbow"', '"lower"')
    arm = read(text)
    with pytest.raises(ValueError, match=r"'lower' is the name of a body, a joint; say which by kind="):
        arm.rename("lower", "forearm")
    arm.rename("lower", "forearm", kind="body")
    assert "lower" in arm.joints
    scene = World().load(arm)
    assert list(scene.sensors) == ["angle", "end"]


def test_a_name_changes_wherever_it_is_used(read):
    arm = read(ARM)
    for old, new in (
        ("shoulder", "s"),
        ("cord", "rope"),
        ("tip", "end_point"),
        ("lower", "forearm"),
        ("drive", "d"),
    ):
        arm.rename(old, new)
    arm.joints["elbow"].rename("e")
    scene = World().load(arm)
    assert set(scene.tendons) == {"rope"}
    assert set(scene["upper"].joints.names) >= {"s", "e"}
    assert scene.actuators["lift"].spec.joint == "s"
    assert not scene.ignored.that_matter


def test_what_needs_a_removed_body_goes_with_it(read):
    arm = read(ARM)
    gone = arm.bodies["lower"].remove()
    assert set(gone) >= {
        "joint 'elbow'", "site 'tip'", "sensor 'angle'", "sensor 'end'", "tendon 'cord'", "actuator 'pull'"
    }  # fmt: skip
    assert "exclude" not in arm.text()
    scene = World().load(arm)
    assert list(scene.actuators) == ["lift"]
    assert list(scene.sensors) == []
    assert scene["upper"].joints.names == ["shoulder"]


def test_a_material_goes_and_its_shapes_stay(read):
    text = ARM.replace("<worldbody>", '<asset><material name="m" rgba="0 1 0 1"/></asset><worldbody>', 1)
    arm = read(text.replace('<geom name="bone"', '<geom name="bone" material="m"'))
    assert arm.remove("m") == []
    assert arm.geoms["bone"]["material"] is None


def test_lengths_scale_and_densities_stay(read):
    arm = read(ARM)
    before = World().load(arm)["upper"]
    arm.scale(2.0)
    after = World().load(arm)["upper"]
    assert_allclose(after.spec.links[0].mass, 8.0 * before.spec.links[0].mass, rtol=1e-12)
    assert_allclose(after.spec.links[0].inertia, np.multiply(32.0, before.spec.links[0].inertia), rtol=1e-12)
    assert_allclose(after.links["lower"].pose.position, [1.0, 0.0, 2.0], atol=1e-12)
    assert after.joints["shoulder"].limits == before.joints["shoulder"].limits
    sensor = '<sensor><distance name="d" body1="upper" body2="lower" cutoff="3"/></sensor></mujoco>'
    arm = read(ARM.replace("</mujoco>", sensor))
    arm.scale(2.0)
    assert arm.sensors["d"]["cutoff"] == "6"
    gripper = read(GRIPPER)
    gripper.scale(3.0)
    scene = World().load(gripper)
    assert_allclose(scene["palm"].joints["slide"].limits, (0.0, 0.12), rtol=1e-12)
    assert_allclose(scene["palm"].spec.base.mass, 0.3 * 27.0, rtol=1e-12)
    assert [float(word) for word in gripper.keyframes["home"]["qpos"].split()][2] == pytest.approx(0.15)


def test_all_places_scale_alike_and_masses_and_moments_with_them(read):
    text = """<mujoco><compiler angle="radian"/><worldbody><light name="l" pos="1 2 3"/>
     <camera name="c" pos="1 2 3"/>
     <geom name="g" type="box" pos="1 2 3" size="1 2 3" mass="2" margin=".5" gap=".25"/>
     <body name="b" pos="1 2 3"><joint name="j" pos="1 2 3" range="-1 1"/>
      <inertial pos="1 2 3" mass="2" diaginertia="1 1 1"/>
      <site name="s" pos="1 2 3" size="1 2 3"/></body></worldbody></mujoco>"""
    part = read(text)
    part.scale(2.0)
    scaled = ElementTree.fromstring(part.text())
    for tag in ("light", "camera", "geom", "body", "joint", "inertial", "site"):
        (found,) = scaled.iter(tag)
        assert_allclose([float(word) for word in found.attrib["pos"].split()], [2, 4, 6], err_msg=tag)
        mass = found.get("mass")
        assert mass is None or float(mass) == 16.0, tag
    assert [part.geoms["g"][each] for each in ("size", "margin", "gap")] == ["2 4 6", "1", "0.5"]
    assert part.joints["j"]["range"] == "-1 1"
    (found,) = scaled.iter("inertial")
    assert [float(word) for word in found.attrib["diaginertia"].split()] == [32.0] * 3


def test_balls_of_which_a_key_says_nothing_are_not_turned(read):
    arm = read(ARM)
    balls = GRIPPER.replace('type="slide" axis="0 1 0" range="0 .04"', 'type="ball"')
    arm.attach(read(balls[: balls.index("<actuator>")] + "</mujoco>"), at="tip")
    assert [float(word) for word in arm.keyframes["home"]["qpos"].split()] == [0.1, 0.2, 1, 0, 0, 0]


def test_a_mesh_is_replaced(read, tmp_path):
    text = (
        f'<mujoco><asset><mesh name="m" file="{CUBE}" scale="2 1 1"/></asset><worldbody><body name="b">'
        '<freejoint/><geom type="mesh" mesh="m"/></body></worldbody></mujoco>'
    )
    description = read(text)
    first = World().load(description)["b"].spec.base.mass
    (tmp_path / "half.obj").write_text(CUBE.read_text().replace("v ", "v 0.5 0 0\nv ", 0))
    description.replace_mesh("m", tmp_path / "half.obj", scale=0.5)
    assert_allclose(World().load(description)["b"].spec.base.mass, first * 0.125 / 2.0, rtol=1e-9)
    description.replace_mesh("m", CUBE, scale=(4.0, 1.0, 1.0))
    assert_allclose(World().load(description)["b"].spec.base.mass, first * 2.0, rtol=1e-9)
    with pytest.raises(DescriptionError, match="there is no such file"):
        description.replace_mesh("m", "missing.obj")
    with pytest.raises(KeyError, match="has no mesh 'n'"):
        description.replace_mesh("n", CUBE)


def test_parts_are_added_and_changed(read):
    arm = read(ARM)
    part = arm.bodies["lower"].add("site", name="grasp", pos=(0.2, 0.0, 0.0))
    assert part is not None
    assert part.attributes == {"name": "grasp", "pos": "0.2 0 0"}
    assert arm.bodies["lower"].add("geom", size=0.02, mass=1) is None
    arm.add("actuator", "motor", name="extra", joint="elbow", ctrllimited=True, ctrlrange=(-1, 1))
    arm.joints["elbow"]["damping"] = 2
    del arm.joints["shoulder"]["range"]
    scene = World().load(arm)
    assert "grasp" in scene.sites
    assert scene.actuators["extra"].spec.control_range == (-1.0, 1.0)
    assert scene["upper"].joints["elbow"].damping == 2.0
    # The keyframe has a control for it.
    assert len(arm.keyframes["home"]["ctrl"].split()) == 3
    assert repr(part) == "<site 'grasp' of the description 'arm'>"
    assert repr(arm) == "<Description 'arm': 2 bodies, 2 joints>"


def test_a_scene_has_its_description(read, tmp_path):
    read(ARM)
    world = World()
    scene = world.load(tmp_path / "file.xml")
    description = scene.description
    description.rename("upper", "u")
    again = world.load(description, position=(0.0, 3.0, 0.0))
    assert again.bodies[0].name == "u"
    assert_allclose(again.bodies[0].links["u"].pose.position, [0.0, 3.0, 1.0], atol=1e-12)
    other = again.description
    other.rename("u", "v")
    assert "u" in again.description.bodies
    with pytest.raises(ValueError, match=r"are for carom\.read"):
        world.load(description, fixed_base=True)
    with pytest.raises(TypeError):
        world.load(cast("Any", 5))


def test_mocap_bodies_stay_in_the_world(read):
    arm = read(ARM)
    hand = read(
        '<mujoco><worldbody><body name="h" mocap="true"><geom size=".1"/></body></worldbody></mujoco>', "h"
    )
    with pytest.raises(DescriptionError, match="only bodies of the world are; merge it"):
        arm.attach(hand, at="tip")
    arm.merge(hand)
    assert World().load(arm).bodies[-1].name == "h"


def test_options_of_mass_are_stated_by_the_bodies(read, tmp_path):
    text = ARM.replace('angle="degree"', 'angle="degree" settotalmass="5" inertiafromgeom="true"')
    description = read(text)
    loaded = World().load(tmp_path / "file.xml")
    assert "settotalmass" not in description.text()
    description.merge(read(ARM, "other"), prefix="b_")
    scene = World().load(description)
    assert_same_dynamics(loaded.bodies, [scene["upper"]])
    assert sum(link.mass for link in scene["b_upper"].spec.links) != pytest.approx(5.0)
