"""Sections that appear several times are one: scenes that include a robot and add a floor, as in MuJoCo."""

import pytest
from numpy.testing import assert_allclose

from carom import World
from carom.errors import DescriptionError

# Feet that touch only what is told to touch them, as in MuJoCo Playground's quadrupeds.
ROBOT = """<mujoco><default><default class="foot"><geom contype="0" conaffinity="1"/></default></default>
<worldbody><body name="trunk" pos="0 0 .4"><freejoint/><geom size=".1" mass="1" contype="0" conaffinity="0"/>
 <site name="hook" pos="0 0 .3"/>
 <body name="leg" pos="0 0 -.1"><joint name="knee" axis="0 1 0"/>
  <geom class="foot" size=".1" mass="1" pos="0 0 -.1"/>
  <site name="toe" pos=".2 0 -.1"/></body></body></worldbody>
<tendon><spatial name="cord" stiffness="3"><site site="hook"/><site site="toe"/></spatial></tendon>
<actuator><muscle name="calf" tendon="cord" force="10" lengthrange=".2 .8"/>
 <motor name="m" joint="knee"/></actuator>
<equality><connect name="pin" body1="trunk" body2="leg" anchor=".1 0 0" active="false"/></equality>
<contact><exclude body1="trunk" body2="leg"/></contact>
<sensor><jointpos name="angle" joint="knee"/></sensor></mujoco>"""
SCENE = """<mujoco><include file="robot.xml"/>
<worldbody><geom name="floor" type="plane" size="0 0 .01" contype="1" conaffinity="0"/>
 <body name="post" pos="1 0 1"><geom size=".1" contype="0" conaffinity="0"/></body></worldbody>
<sensor><jointvel name="rate" joint="knee"/></sensor>
<equality><weld name="leash" body1="trunk" body2="post" active="false"/></equality>
<keyframe><key name="home" qpos="0 0 .3 1 0 0 0 .1"/></keyframe>
<keyframe><key name="away" qpos="1 0 .3 1 0 0 0 .2"/></keyframe></mujoco>"""


@pytest.fixture
def load(tmp_path):
    def load(text, **others):
        for name, other in others.items():
            (tmp_path / f"{name}.xml").write_text(other)
        (tmp_path / "file.xml").write_text(text)
        return World().load(tmp_path / "file.xml")

    return load


def test_a_robot_in_a_scene_is_the_robot_alone(load):
    alone = load(ROBOT)
    scene = load(SCENE, robot=ROBOT)
    for each in (alone, scene):
        assert not [it for it in each.ignored.that_matter if it.reason == "it moves nothing"]
        each.world.gravity = (0.0, 0.0, 0.0)
        each.actuators["calf"].control = 0.7
        each.world.step(100)
    assert set(alone.constraints) == {"pin"}
    assert set(scene.constraints) == {"pin", "leash"}
    ends = [each["trunk"].joints["knee"].position for each in (alone, scene)]
    assert abs(ends[0]) > 0.01
    assert_allclose(ends[0], ends[1], rtol=1e-12)
    assert list(scene.sensors) == ["angle", "rate"]
    assert list(scene.keyframes) == ["home", "away"]


def test_feet_stand_on_the_floor_of_the_scene(load):
    scene = load(SCENE, robot=ROBOT)
    scene.apply_options()
    scene.world.step(500)
    assert -0.005 < scene["trunk"].links["leg"].pose.position[2] - 0.2 < 0.005


def test_bodies_of_several_sections_share_masses_and_names(load):
    # MuJoCo 4.0: the masses are 2 and 4.
    text = (
        '<mujoco><compiler settotalmass="6"/><worldbody><body name="a"><freejoint/><geom size=".1" mass="1"/>'
        '</body></worldbody><worldbody><body name="b" pos="1 0 0"><freejoint/><geom size=".1" mass="2"/>'
        '</body></worldbody><contact><exclude body1="a" body2="b"/></contact></mujoco>'
    )
    scene = load(text)
    assert_allclose([body.spec.base.mass for body in scene], [2.0, 4.0], rtol=1e-12)
    with pytest.raises(DescriptionError, match="the name 'a' is taken already"):
        load(text.replace('"b"', '"a"'))


def test_errors_name_the_file_of_a_section(load):
    broken = '<mujoco>\n\n<worldbody><geom size="many"/></worldbody></mujoco>'
    main = '<mujoco><worldbody/><include file="other.xml"/></mujoco>'
    with pytest.raises(DescriptionError, match=r"other\.xml:3") as problem:
        load(main, other=broken)
    assert problem.value.line == 3
    main = '<mujoco><include file="other.xml"/>\n<worldbody><geom size="many"/></worldbody></mujoco>'
    with pytest.raises(DescriptionError, match=r"file\.xml:2"):
        load(main, other="<mujoco><worldbody/></mujoco>")


def test_defaults_and_options_count_in_their_order(load):
    # MuJoCo 4.0: what a class inherits is what its parent had by then; the last of several options counts.
    scene = load(
        '<mujoco><option timestep=".1"/><option gravity="0 0 1"/><option timestep=".2"/>'
        '<default><joint damping="1"/><default class="a"><joint armature="2"/></default></default>'
        '<default><joint damping="3" stiffness="4"/></default><worldbody><body childclass="a">'
        '<joint name="j"/><geom size=".1"/><body><joint name="k" class="main"/><geom size=".1"/></body>'
        "</body></worldbody></mujoco>"
    )
    assert (scene.options["timestep"], scene.options["gravity"]) == (0.2, (0.0, 0.0, 1.0))
    joints = {joint.name: joint for body in scene for joint in body.joints}
    assert [(joints[it].damping, joints[it].armature, joints[it].stiffness) for it in "jk"] == [
        (1.0, 2.0, 0.0),
        (3.0, 0.0, 4.0),
    ]
    with pytest.raises(DescriptionError, match="the default class 'a' is there already"):
        load("<mujoco>" + 2 * '<default><default class="a"/></default>' + "</mujoco>")
