"""Plugins of MuJoCo's own in MJCF files; the numbers are MuJoCo 4.0's."""

import numpy as np
import pytest
from tests.each import each

from carom import World
from carom.errors import DescriptionError

PID = """<mujoco><option integrator="Euler" timestep=".001"/><extension><plugin plugin="mujoco.pid">
<instance name="p"><config key="kp" value="4"/></instance><instance name="pd"><config key="kp" value="4"/>
<config key="kd" value=".4"/></instance>{}</plugin></extension><worldbody>
<body name="a"><joint name="a" type="slide" axis="0 0 1"/><geom size=".1" mass=".2"/></body>
<body name="b" pos="1 0 0"><joint name="b" type="slide" axis="0 0 1"/><geom size=".1" mass=".2"/></body>
<body name="c" pos="2 0 0"><joint name="c"/><geom size=".1" mass=".2" pos=".2 0 0"/></body>
</worldbody><actuator><plugin name="a" joint="a" plugin="mujoco.pid" instance="p"/>
<plugin name="b" joint="b" plugin="mujoco.pid" instance="pd" ctrlrange="0 .15" gear="2"/>
<plugin name="c" joint="c" plugin="mujoco.pid" forcerange="-1 1" dyntype="filter" dynprm=".1">
<config key="kp" value="3"/></plugin>{}</actuator></mujoco>"""
POSITIONS = (-0.147641975, -0.053420284, 0.323515313)
FORCES = (1.7872492, 1.1046087, -0.1224732)


def loaded(world, tmp_path, text):
    (tmp_path / "plugin.xml").write_text(text)
    return world.load(tmp_path / "plugin.xml")


def test_pid_without_an_integral_is_that_of_mujoco(tmp_path):
    with World(contact="compliant") as world:
        scene = loaded(world, tmp_path, PID.format("", ""))
        assert not scene.ignored.that_matter
        for actuator in scene.actuators.values():
            actuator.control = 0.3
        world.step(300)
        np.testing.assert_allclose([scene[name].joints[0].position for name in "abc"], POSITIONS, rtol=1e-6)
        np.testing.assert_allclose([it.force for it in scene.actuators.values()], FORCES, rtol=1e-4)


INTEGRAL = """<instance name="i"><config key="kp" value="4"/><config key="ki" value="2"/>
<config key="slewmax" value="2"/></instance>"""
WITH = '<plugin name="d" joint="a" plugin="mujoco.pid" instance="i" actdim="2"/>'


def test_the_memory_of_pid_is_reported(tmp_path):
    with World() as world:
        scene = loaded(world, tmp_path, PID.format(INTEGRAL, WITH))
        assert [it.consequence for it in scene.ignored.that_matter] == [
            "errors that stay are not made up for",
            "the target may jump",
        ]
        assert scene.actuators["d"].control == 0.0


def test_keyframes_with_memories_of_plugins_are_read_without_these(tmp_path):
    key = '<keyframe><key name="k" qpos=".1 .2 .3" act="1 2 3" ctrl="0 .1"/></keyframe></mujoco>'
    with World() as world:
        scene = loaded(world, tmp_path, PID.format(INTEGRAL, WITH).replace("</mujoco>", key))
        scene.reset("k")
        assert scene["b"].joints[0].position == 0.2
        assert scene.actuators["b"].control == 0.1


@each(
    ("actuator", "says"),
    [
        ('<plugin joint="a" plugin="mujoco.pid" instance="none"/>', "no plugin instance 'none'"),
        ('<plugin joint="a" plugin="mujoco.pid"><config key="kp" value="x"/></plugin>', "kp"),
    ],
)
def test_broken_plugins_are_errors(tmp_path, actuator, says):
    with World() as world, pytest.raises(DescriptionError, match=says):
        loaded(world, tmp_path, PID.format("", actuator))


def test_other_plugins_are_left_out_and_reported(tmp_path):
    with World() as world:
        scene = loaded(world, tmp_path, PID.format("", '<plugin name="d" joint="a" plugin="my.own"/>'))
        assert "d" not in scene.actuators
        assert [it.reason for it in scene.ignored.that_matter] == [
            "actuators of plugins other than mujoco.pid are not built"
        ]
