"""Tendons between free bodies and others: they hang from the world then, and move as in MuJoCo."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom import World

FILE = """<mujoco><worldbody>
<body name="a" pos="0 0 1" euler="30 20 10"><freejoint name="fa"/><geom type="box" size=".1 .2 .3"
 pos=".1 .05 .02"/><site name="a" pos=".1 .2 .3"/></body>
<body name="h" pos="1 0 1"><joint name="h" axis="0 1 0" pos="0 0 .2"/><geom type="capsule" size=".05 .2"/>
<site name="h" pos="0 0 -.2"/></body>
<body name="b" pos="0 1 1.5"><freejoint name="fb"/><geom type="box" size=".1 .1 .3" pos=".0 .05 .02"/>
<site name="b" pos="0 .1 -.3"/></body></worldbody>
<tendon><spatial name="t" stiffness="30" damping="2" springlength=".3"><site site="a"/><site site="h"/>
<site site="b"/></spatial></tendon>
<actuator><motor name="m" tendon="t" gear="3"/></actuator>
<keyframe><key name="k" qpos=".1 .2 1.2 .7 .1 .3 -.4 .3 -.2 1.1 1.6 .5 -.6 .2 .1"
 qvel=".1 .2 .3 .4 .5 .6 .7 .8 .9 -1 -1.1 1.2 .3" ctrl=".4"/></keyframe></mujoco>"""
# `qpos` in MuJoCo 4.0 after 100 steps from the keyframe.
AFTER = {
    "a": (0.1420241909, 0.2389664606, 1.0634750484, 0.7695279977, 0.1735331404, 0.4209786975, -0.4477609252),
    "b": (-0.0234598107, 1.2622342252, 1.1900593373, 0.5484042774, -0.8116364918, 0.1609493375, 0.1208067233),
}
HINGE = 2.1256099164


def loaded(world, folder, text):
    (folder / "file.xml").write_text(text)
    scene = world.load(folder / "file.xml")
    assert not scene.ignored.that_matter
    scene.apply_options()
    return scene


def link_of(scene, name):
    return next(link for body in scene.bodies for link in body.links if link.name == name)


def test_they_move_as_in_mujoco(tmp_path):
    with World(contact="compliant") as world:
        scene = loaded(world, tmp_path, FILE)
        assert [body.name for body in scene.bodies] == ["a+h+b"]
        world.parameters.integrator = "euler"
        world.apply_parameters()
        scene.reset("k")
        world.step(100)
        for name, (x, y, z, *quaternion) in AFTER.items():
            pose = link_of(scene, name).pose
            assert_allclose(pose.position, (x, y, z), atol=1e-8)
            found = np.roll(pose.orientation, 1)
            assert_allclose(found * np.sign(found @ quaternion), quaternion, atol=1e-8)
        assert scene["a+h+b"].joints["h"].position == pytest.approx(HINGE, abs=1e-8)


@pytest.mark.parametrize("tied", [False, True])
def test_damping_spring_and_friction_of_free_joints_stay(tmp_path, tied):
    joint = '<joint name="fa" type="free" damping=".7" stiffness="3" armature=".4" frictionloss=".02"/>'
    text = FILE.replace('<freejoint name="fa"/>', joint).replace('stiffness="30" damping="2"', "")
    text = text.replace('ctrl=".4"', "")
    if not tied:
        text = text[: text.index("<tendon>")] + text[text.index("<keyframe>") :]
    with World(contact="compliant") as world:
        scene = loaded(world, tmp_path, text)
        scene.reset("k")
        world.step(200)
        pose = link_of(scene, "a").pose
    # `qpos` of "a" in MuJoCo 4.0, which is the same with a tendon that exerts nothing.
    wanted = (0.129575157, 0.262128419, 0.521357313, 0.848358319, 0.28466189, 0.3392748, -0.290083403)
    assert_allclose(pose.position, wanted[:3], atol=1e-6)
    found = np.roll(pose.orientation, 1)
    assert_allclose(found * np.sign(found @ wanted[3:]), wanted[3:], atol=1e-6)
