"""What MuJoCo accepts in files as published: infinite ranges, short keyframes, meshes beside includes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom import World
from carom.errors import DescriptionError
from carom.formats.mjcf.compiled import compile_mjcf
from carom.geometry.hull import hull_triangles

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
MESH = '<mujoco>{}<asset><mesh name="x" file="{}"/></asset></mujoco>'
MAIN = (
    '<mujoco>{}<include file="sub/r.xml"/><worldbody><body name="b"><freejoint/><geom type="mesh" mesh="x"/>'
    "</body></worldbody></mujoco>"
)
ASSETS = '<compiler meshdir="assets"/>'


def load(folder, text):
    (folder / "file.xml").write_text(text)
    return World().load(folder / "file.xml")


@pytest.mark.parametrize(
    ("range_text", "end"), [("-inf inf", None), ("-inf 1", 1.0), ("-1 +inf", None), ("inf -inf", None)]
)
def test_ranges_may_be_infinite(tmp_path, range_text, end):
    scene = load(
        tmp_path,
        '<mujoco><option gravity="9 0 0"/><worldbody><body name="b"><joint name="j" type="slide" '
        f'axis="1 0 0" range="{range_text}"/><geom size=".1"/></body></worldbody>'
        '<actuator><motor joint="j" ctrlrange="-inf 2"/></actuator></mujoco>',
    )
    scene.apply_options()
    scene.world.step(600)
    position = scene["b"].joints["j"].position
    assert abs(position - end) < 1e-2 if end else position > 5.0
    with pytest.raises(DescriptionError, match="not a finite number"):
        load(tmp_path, (tmp_path / "file.xml").read_text().replace(f'range="{range_text}"', 'range="nan 1"'))


def test_keyframes_may_be_shorter_than_the_coordinates(tmp_path):
    # MuJoCo 4.0 takes what is missing from qpos0, and 0 for velocities, controls and activations.
    scene = load(
        tmp_path,
        '<mujoco><worldbody><body name="f" pos="7 8 9" euler="90 0 0"><freejoint/><geom size=".1"/></body>'
        '<body name="a"><joint name="j" ref="30"/><geom size=".1"/><body name="b">'
        '<joint name="k" type="ball"/><geom size=".1" pos="1 0 0"/></body></body></worldbody>'
        '<actuator><intvelocity name="i" joint="j" '
        'actrange="-1 1"/><motor name="m" joint="j"/></actuator><keyframe><key name="short" qpos="1 2 3" '
        'qvel="4" ctrl=".5"/></keyframe></mujoco>',
    )
    scene["a"].joints["j"].body.set_joint_state(0, [1.0], [1.0])
    scene.reset("short")
    pose, velocity = scene["f"].links[-1].pose, scene["f"].links[-1].velocity
    assert_allclose(pose.position, (1, 2, 3), atol=1e-12)
    assert_allclose(np.abs(pose.orientation), (0.5**0.5, 0, 0, 0.5**0.5), atol=1e-12)
    assert_allclose(velocity.linear, (4, 0, 0), atol=1e-12)
    assert_allclose(scene["a"].joints["j"].position, np.pi / 6, atol=1e-12)
    assert scene["a"].joints["j"].velocity == 0.0
    assert [it.control for it in scene.actuators.values()] == [0.5, 0.0]
    with pytest.raises(DescriptionError, match="qvel has 11 numbers; the joints of the file have 10"):
        load(tmp_path, (tmp_path / "file.xml").read_text().replace('qvel="4"', f'qvel="{"1 " * 11}"'))


@pytest.mark.parametrize(
    ("main", "included", "place"),
    [
        ("", MESH.format("", "x.obj"), "sub/x.obj"),
        # In the folder of the main file meshdir counts, beside the included one it doesn't.
        ("", MESH.format(ASSETS, "x.obj"), "assets/x.obj"),
        ("", MESH.format(ASSETS, "assets/x.obj"), "sub/assets/x.obj"),
        (ASSETS, MESH.format("", "assets/x.obj"), "sub/assets/x.obj"),
        (ASSETS, MESH.format("", "x.obj"), "sub/x.obj"),
        ("<asset/>", '<mujoco><include file="deep/q.xml"/></mujoco>', "sub/deep/x.obj"),
    ],
)
def test_meshes_are_where_mujoco_finds_them(tmp_path, main, included, place):
    (tmp_path / "sub" / "deep").mkdir(parents=True)
    (tmp_path / "sub" / "r.xml").write_text(included)
    (tmp_path / "sub" / "deep" / "q.xml").write_text(MESH.format("", "x.obj"))
    (tmp_path / place).parent.mkdir(exist_ok=True)
    (tmp_path / place).write_text(TETRAHEDRON)
    mass = load(tmp_path, MAIN.format(main))["b"].spec.base.mass
    assert_allclose(mass, 1000 / 6, rtol=1e-6)


# MuJoCo 4.0: body_invweight0 of translations, and dof_invweight0 of the first joint.
SLIDES = [
    ('<joint type="slide" axis="1 0 0"/><geom size=".1" mass="2"/>', 0.5, 0.5),
    ('<joint type="slide" axis="1 0 0" armature="1"/><geom size=".1" mass="2"/>', 0.5, 0.5),
    (
        '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/><geom size=".1" mass="2"/>',
        0.5,
        0.5,
    ),
    ('<joint type="slide" axis="1 0 0"/><geom type="box" size=".1 .3 .2" mass="2"/>', 0.5, 0.5),
    ('<joint type="slide" axis="1 2 0"/><geom size=".1" mass="2"/>', 1 / 6, 0.5),
    ('<joint type="slide" axis="0 -2 0" pos="1 0 0"/><geom size=".1" mass="2"/>', 1 / 6, 0.5),
    ('<joint type="slide" axis="1 0 0" armature="1"/><geom size=".1" mass="2" pos="1 0 0"/>', 1 / 9, 1 / 3),
    ('<joint type="slide" axis="1 0 0"/><geom size=".1" mass="2" euler="10 20 30"/>', 1 / 6, 0.5),
    ('<joint type="slide" axis="1 0 0"/>' + 2 * '<geom type="box" size=".1 .3 .2" mass="1"/>', 1 / 6, 0.5),
    ('<joint type="slide" axis="1 0 0"/><inertial pos="0 0 0" mass="2" diaginertia="1 1.2 1.1"/>', 0.5, 0.5),
    (
        '<joint type="slide" axis="1 0 0"/><geom size=".1" mass="2"/><body><geom size=".1" mass="3"/></body>',
        1 / 15,
        0.2,
    ),
]


@pytest.mark.parametrize(("inside", "of_body", "of_joint"), SLIDES)
@pytest.mark.parametrize("around", ["{}", '<body pos="1 0 0">{}</body>'])
def test_bodies_that_only_slide_weigh_as_in_mujoco(tmp_path, inside, of_body, of_joint, around):
    body = f'<body name="b" euler="0 0 30">{inside}</body>'
    (tmp_path / "file.xml").write_text(f"<mujoco><worldbody>{around.format(body)}</worldbody></mujoco>")
    model = compile_mjcf(tmp_path / "file.xml", hull=hull_triangles)
    assert_allclose(model.body_weights["b"], (of_body, 0.0), rtol=1e-12, atol=1e-15)
    assert_allclose(next(iter(model.joint_weights.values())), of_joint, rtol=1e-12)


def test_a_body_that_slides_on_one_that_does_or_says_so_weighs_as_others(tmp_path):
    for text in (
        '<body><joint type="slide" axis="0 0 1"/><geom size=".1" mass="5"/><body name="b">{}</body></body>',
        '<body><body><body name="b">{}</body></body></body>',
        '<body name="b" simple="false">{}</body>',
    ):
        body = text.format('<joint type="slide" axis="0 1 0"/><geom size=".1" mass="3"/>')
        (tmp_path / "file.xml").write_text(f"<mujoco><worldbody>{body}</worldbody></mujoco>")
        weights = compile_mjcf(tmp_path / "file.xml", hull=hull_triangles).body_weights
        # 1/9, and 8/72 with what the body below gives way.
        expected = (1 / 3 + 1 / 8) / 3 if "5" in text else 1 / 9
        assert_allclose(weights["b"][0], expected, rtol=1e-12)
