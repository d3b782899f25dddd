"""What is rare in files: it is kept in descriptions, or reported."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.editing.motion import assert_same_dynamics

import carom
from carom import World
from carom.errors import DescriptionError


@pytest.fixture
def read(tmp_path):
    def read(text, name="file.xml"):
        (tmp_path / name).write_text(text)
        return carom.read(tmp_path / name)

    return read


LINK = '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'


def robot(joints, shapes=""):
    links = "".join(f'<link name="{name}">{LINK}{shapes if name == "b" else ""}</link>' for name in "abc")
    return f'<robot name="r">{links}{joints}</robot>'


def joint(kind, child, inside="", parent="a"):
    axis = '<axis xyz="0 0.6 0.8"/>' if kind not in ("fixed", "floating") else ""
    return (
        f'<joint name="{child}_joint" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{axis}'
        f"{inside}</joint>"
    )


def said(description):
    return {(it.element, it.attributes) for it in description.ignored}


def test_planar_joints_are_three(read):
    description = read(robot(joint("planar", "b") + joint("fixed", "c")), "r.urdf")
    assert list(description.joints) == ["a_free", "b_joint_x", "b_joint_y", "b_joint_turn"]
    axes = [np.array(description.joints[f"b_joint_{it}"]["axis"].split(), float) for it in ("x", "y", "turn")]
    assert_allclose(np.array(axes) @ np.transpose(axes), np.eye(3), atol=1e-15)
    assert_allclose(axes[2], [0.0, 0.6, 0.8], atol=1e-15)
    assert ("joint", ("type",)) in said(description)
    World().load(description)


def test_balls_and_couplings_to_what_is_fixed(read):
    limit = '<limit lower="-1" upper="1" effort="0" velocity="0" twist="1"/>'
    mimic = '<mimic joint="c_joint" multiplier="3" offset=".25"/>'
    text = robot(joint("spherical", "b", limit) + joint("fixed", "c"))
    description = read(text, "r.urdf")
    assert description.joints["b_joint"]["type"] == "ball"
    assert ("joint/limit", ("lower", "upper")) in said(description)
    description = read(robot(joint("continuous", "b", mimic) + joint("fixed", "c")), "r.urdf")
    assert description.equalities["b_joint"].attributes == {
        "name": "b_joint", "joint1": "b_joint", "polycoef": "0.25 0 0 0 0"
    }  # fmt: skip


def test_shapes_of_urdf_files(read, tmp_path):
    (tmp_path / "two.obj").write_text(
        "o p\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
        "o q\nv 2 0 0\nv 3 0 0\nv 2 1 0\nv 2 0 1\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n"
    )
    (tmp_path / "solid.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"
    )
    shapes = "".join(
        f"<collision><geometry>{it}</geometry></collision>"
        for it in (
            '<mesh filename="two.obj" scale="1 2 1"/>',
            '<sphere radius="0"/>',
            '<capsule radius="1" length="2"/>',
        )
    )
    shapes += (
        '<visual><geometry><mesh filename="solid.ply"/></geometry><material name="m"><color rgba="1 0 0 1"/>'
        '</material></visual><collision group="2" mask="4"><geometry>'
        '<box size="1 2 3"/></geometry></collision>'
    )
    description = read(robot(joint("fixed", "b") + joint("fixed", "c"), shapes), "r.urdf")
    assert {("collision", ()), ("shape", ("size",)), ("collision", ("group", "mask"))} <= said(description)
    assert description.meshes["two"].attributes == {
        "name": "two", "inertia": "shell", "file": str(tmp_path / "two.obj"), "scale": "1 2 1"
    }  # fmt: skip
    # MuJoCo reads no PLY files, so the triangles are in the description.
    assert len(description.meshes["solid"]["vertex"].split()) == 12
    assert len(description.meshes["solid"]["face"].split()) == 12
    text = description.text()
    assert 'rgba="1 0 0 1"' in text
    assert 'contype="2" conaffinity="4"' in text
    assert 'size="0.5 1 1.5"' in text
    assert 'size="1 1"' in text
    description.write(tmp_path / "again.xml")
    assert 'file="two.obj"' in (tmp_path / "again.xml").read_text()
    assert_same_dynamics(World().load(description).bodies, World().load(tmp_path / "again.xml").bodies)


def test_links_without_mass_and_soft_bodies(read, tmp_path):
    text = robot(joint("continuous", "b") + joint("fixed", "c")).replace(
        f'<link name="b">{LINK}', '<link name="b">'
    )
    description = read(text, "r.urdf")
    (found,) = [it for it in description.ignored if it.element == "link/inertial"]
    assert found.consequence == "none here; MuJoCo refuses 'b'"
    with pytest.raises(DescriptionError, match="soft bodies are not part of descriptions"):
        carom.read("torus_deform.urdf")
    with pytest.raises(ValueError, match="fixed_base is for URDF"):
        carom.read("kiva_shelf/model.sdf", fixed_base=True)


def test_robots_of_equal_links_have_prefixes(read):
    model = (
        '<model name="{}"><pose>{} 0 0 0 0 0</pose><link name="base"><inertial><mass>2</mass></inertial>'
        '</link><link name="arm"/><joint name="j" type="revolute"><parent>base</parent><child>arm</child>'
        "<axis><xyz>0 1 0</xyz></axis></joint></model>"
    )
    text = (
        f'<sdf version="1.7"><world name="w">{model.format("one", 0)}{model.format("two", 3)}</world></sdf>'
    )
    description = read(text, "w.sdf")
    assert list(description.bodies) == ["one/base", "one/arm", "two/base", "two/arm"]
    assert "two/j" in description.joints
    assert_allclose(World().load(description)["two/base"].pose.position, [3.0, 0.0, 0.0], atol=1e-15)


PARTS = """<mujoco><compiler angle="degree" eulerseq="zyx"/><default><geom friction=".7 .1 .1"/></default>
<asset><texture name="t" type="2d" builtin="flat" width="2" height="2"/><material name="m" texture="t"/>
</asset><worldbody><light name="l" pos="1 0 0" dir="0 0 -1"/><frame pos="0 0 1" euler="90 0 0">
 <light pos="1 0 0"/>
 <geom name="bar" type="box" size=".1" fromto="0 0 0 1 0 0" material="m"/><camera name="cam" mode="targetbody"
 target="b"/><body name="b"><inertial pos="0 0 0" mass="1" fullinertia="1 2 2.5 .1 0 0" euler="30 0 0"/>
 <joint name="j" type="slide" axis="1 0 0" ref=".5" springref=".1"/><geom name="g" size=".1" friction="1"/>
 <site name="s" type="capsule" size=".1" fromto="0 0 0 0 0 1"/></body></frame>
<body name="c" pos="0 0 2"><freejoint/><geom size=".1"/></body></worldbody>
<equality><weld name="w" body1="b" body2="c" relpose="0 0 1 1 0 0 0"/></equality>
<actuator><position name="p" joint="j" timeconst=".1"/><general name="q" joint="j" dyntype="filter"/>
</actuator>
<keyframe><key name="k" qpos=".5 0 0 2 1 0 0 0" qvel="1 2 3 4 5 6 7" act=".1 .2"/></keyframe></mujoco>"""


def test_frames_turn_what_is_in_them(read, tmp_path):
    description = read(PARTS)
    scene, loaded = World().load(description), World().load(tmp_path / "file.xml")
    assert_same_dynamics(loaded.bodies, scene.bodies)
    assert description.geoms["g"]["friction"] == "1 .1 .1"
    assert "fromto" not in description.geoms["bar"].attributes
    box = scene["world"].spec.base.collisions[0], loaded["world"].spec.base.collisions[0]
    assert_allclose(box[0].frame.position, box[1].frame.position, atol=1e-15)
    assert box[0].geometry == box[1].geometry
    assert "quat" not in description.bodies["b"].attributes or "fullinertia" in description.text()
    light = next(it for it in description.text().split("\n") if "<light pos" in it)
    assert_allclose([float(it) for it in light.split('"')[1].split()], [0.0, 1.0, 1.0], atol=1e-15)


def test_a_merged_description_is_turned_with_its_world(read):
    base = read("<mujoco/>", "empty.xml")
    lost = base.merge(read(PARTS), position=(0, 0, 1), orientation=(0, 0, 1, 0))
    assert [it.element for it in lost] == []
    assert base.cameras["cam"]["target"] == "b"
    numbers = [float(it) for it in base.keyframes["k"]["qpos"].split()]
    assert_allclose(numbers, [0.5, 0, 0, 3, 0, 0, 0, 1], atol=1e-15)
    rates = [float(it) for it in base.keyframes["k"]["qvel"].split()]
    assert_allclose(rates, [1, -2, -3, 4, 5, 6, 7], atol=1e-15)
    scene = World().load(base)
    assert_allclose(scene["b"].links["b"].pose.position, [0.0, 0.0, 2.0], atol=1e-12)
    # Without the actuator that has the first activation, the second stays.
    base.remove("p")
    assert base.keyframes["k"]["act"] == "0.2"
    base.remove("q")
    assert base.keyframes["k"]["act"] is None
    base.scale(2.0)
    assert base.equalities["w"]["relpose"] == "0 0 2 1 0 0 0"
    assert base.keyframes["k"]["qpos"].split()[0] == "1"
    assert base.joints["j"]["springref"] == "0.2"


def test_a_site_between_two_points_has_a_frame(read):
    host = read(PARTS)
    guest = read('<mujoco><worldbody><body name="x"><geom size=".1"/></body></worldbody></mujoco>', "x.xml")
    host.attach(guest, at="s")
    assert [float(it) for it in host.bodies["x"]["pos"].split()] == [0.0, 0.0, 0.5]


def test_shapes_fitted_to_meshes_by_another_rule_are_refused(read):
    mesh = '<asset><mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset>'
    fitted = '<worldbody><body name="{}"><freejoint/><geom type="box" mesh="m"/></body></worldbody>'
    host = read(f'<mujoco><compiler fitaabb="true"/>{mesh}{fitted.format("a")}</mujoco>')
    guest = read(f"<mujoco>{mesh}{fitted.format('b')}</mujoco>", "guest.xml")
    with pytest.raises(DescriptionError, match="it is fitted to a mesh by fitaabb of its file"):
        host.merge(guest)
    same = read(f'<mujoco><compiler fitaabb="true"/>{mesh}{fitted.format("b")}</mujoco>', "same.xml")
    host.merge(same)
    assert list(host.meshes) == ["m"], "equal assets are there once"


def test_defaults_of_actuators_stay_apart(read):
    text = (
        '<mujoco><default><position kp="{}"/></default><worldbody><body name="b"><joint name="j"/>'
        '<geom size=".1"/></body></worldbody><actuator><position name="p" joint="j"/></actuator></mujoco>'
    )
    host, guest = read(text.format(7)), read(text.format(8), "guest.xml")
    host.merge(guest, prefix="x_")
    scene = World().load(host)
    assert (scene.actuators["p"].spec.gain[0], scene.actuators["x_p"].spec.gain[0]) == (7.0, 8.0)


def test_too_many_numbers_of_a_key_are_an_error(read):
    description = read(PARTS.replace('qpos=".5 0', 'qpos=".5 0 0 0 0'))
    with pytest.raises(
        DescriptionError, match=r"file.xml:\d+: <key name='k'>: qpos has 11 numbers; .* needs 8"
    ):
        description.remove("p")
