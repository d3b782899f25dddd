"""Bodies of the world that a tendon or an actuator ties to each other are one body, as MuJoCo moves them."""

from pathlib import Path

import pytest
from numpy.testing import assert_allclose

from carom import World
from carom.world.scene import Scene

CARTS = """<mujoco><option timestep=".002" gravity="0 0 0"/><worldbody>
<body name="left" pos="-1 0 0"><joint name="l" type="slide" axis="1 0 0"/><geom type="box" size=".2 .2 .2"/>
<site name="a"/></body>
<body name="middle" pos="0 2 0"><joint name="m" type="slide" axis="1 0 0"/><geom size=".1"/></body>
<body name="right" pos="1 0 0"><joint name="r" type="slide" axis="1 0 0"/><geom type="box" size=".2 .2 .2"/>
<site name="b"/></body></worldbody>
<tendon><spatial name="rope" range="0 2.5" limited="true" frictionloss="{}"><site site="a"/><site site="b"/>
</spatial></tendon><actuator><motor name="drive" joint="r"/></actuator>
<keyframe><key name="moving" qpos=".1 .2 .3" qvel="1 2 -1" ctrl=".5"/></keyframe></mujoco>"""


def loaded(folder: Path, friction: float = 0.0) -> Scene:
    (folder / "carts.xml").write_text(CARTS.format(friction))
    scene = World(contact="bullet").load(folder / "carts.xml")
    assert not scene.ignored.that_matter
    return scene


def test_they_have_a_name_of_all_and_keep_names_sensors_and_keyframes(tmp_path: Path):
    scene = loaded(tmp_path)
    assert [body.name for body in scene.bodies] == ["left+right", "middle"]
    scene.reset("moving")
    carts = scene["left+right"]
    assert (carts.joints["l"].position, carts.joints["r"].position) == (0.1, 0.3)
    assert (carts.joints["l"].velocity, scene["middle"].joints["m"].velocity) == (1.0, 2.0)
    assert scene.actuators["drive"].control == 0.5
    assert scene.tendons["rope"].length == pytest.approx(2.2)


def test_they_still_collide_with_each_other(tmp_path: Path):
    scene = loaded(tmp_path)
    carts = scene["left+right"]
    carts.joints["l"].velocity = 2.0
    scene.world.step(1000)
    # Without contact the left one would be on the other side.
    gap = carts.links["right"].pose.position[0] - carts.links["left"].pose.position[0]
    assert gap > 0.39
    assert carts.joints["r"].position > 0.5


def test_a_limit_of_a_tendon_holds_them_together(tmp_path: Path):
    scene = loaded(tmp_path)
    carts = scene["left+right"]
    carts.joints["l"].velocity = -2.0
    carts.joints["r"].velocity = 1.0
    scene.world.step(1000)
    assert scene.tendons["rope"].length < 2.6
    # What one loses the other gets.
    assert_allclose(carts.joints["l"].velocity + carts.joints["r"].velocity, -1.0, atol=1e-9)


def test_friction_of_a_tendon_ends_their_relative_motion(tmp_path: Path):
    scene = loaded(tmp_path, friction=200.0)
    carts = scene["left+right"]
    carts.joints["l"].velocity = 1.0
    scene.world.step(300)
    assert_allclose([carts.joints[name].velocity for name in "lr"], [0.5, 0.5], atol=1e-6)
