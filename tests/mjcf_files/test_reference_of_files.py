"""Numbers of MJCF files that follow from masses at the reference: damping ratios, and forces of muscles."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom import World
from carom.errors import DescriptionError

ROBOT = """<mujoco><worldbody><body name="base" pos="0 0 1" euler="20 30 40"><freejoint/>
<inertial mass="3" pos=".1 .05 -.02" diaginertia=".02 .03 .04" euler="10 20 30"/>
<body name="leg" pos=".1 0 .2" euler="0 15 0"><joint name="hip" axis="0 1 0" armature=".01" ref="20"/>
<geom type="capsule" fromto="0 0 0 0 0 -.5" size=".03" mass="2"/>
<body name="shin" pos="0 .1 -.5"><joint name="knee" axis="1 1 0" pos="0 0 .01"/>
<geom size=".05" pos=".1 0 -.2" mass="1"/><site name="t" pos=".1 .2 -.1" euler="5 6 7"/></body></body>
<site name="s" pos=".2 0 0"/></body><site name="w" pos="1 1 .5"/></worldbody>
<tendon><fixed name="f" armature=".05"><joint joint="hip" coef="2"/><joint joint="knee" coef="-1"/></fixed>
<spatial name="p"><site site="w"/><site site="t"/></spatial>
<spatial name="o"><site site="s"/><site site="t"/></spatial></tendon>
<actuator><position name="hip" joint="hip" kp="100" dampratio="1"/>
<position name="knee" joint="knee" gear="3" kp="100" dampratio=".5"/>
<position name="fixed" tendon="f" gear="2" kp="100" dampratio="1"/>
<position name="to the world" tendon="p" kp="100" dampratio="1"/>
<position name="inside" tendon="o" kp="100" dampratio="1"/>
<position name="site" site="t" refsite="s" gear="1 2 0 0 0 .3" kp="100" dampratio="1"/>
<position name="crank" cranksite="t" slidersite="s" cranklength="2" kp="100" dampratio="1"/>
<intvelocity name="speed" joint="hip" kp="50" dampratio=".5" actrange="-1 1"/>
<muscle name="calf" tendon="o" lengthrange=".3 .7" scale="50"/>
<muscle name="thigh" joint="knee" lengthrange="-.3 .7"/></actuator></mujoco>"""
# MuJoCo 4.0: -biasprm[2] of servos; scale over actuator_acc0 of muscles.
DAMPING = {
    "hip": 8.460127759483145,
    "knee": 0.6463516314013309,
    "fixed": 2.3855410052201997,
    "to the world": 16.87254406107548,
    "inside": 66.1490140241605,
    "site": 15.415196298878133,
    "crank": 27.378257444499038,
    "speed": 2.9911068542175423,
}
FORCES = {"calf": 32.40518396848891, "thigh": 6.228845588769085}


def load(folder, text):
    (folder / "file.xml").write_text(text)
    return World().load(folder / "file.xml")


def test_damping_ratios_and_accelerations_mean_what_they_mean_in_mujoco(tmp_path):
    scene = load(tmp_path, ROBOT)
    assert not scene.ignored.that_matter
    found = {name: -it.spec.bias[2] for name, it in scene.actuators.items() if it.spec.muscle is None}
    assert_allclose(list(found.values()), list(DAMPING.values()), rtol=1e-9)
    assert list(found) == list(DAMPING)
    forces = [scene.actuators[name].spec.muscle.force for name in FORCES]
    assert_allclose(forces, list(FORCES.values()), rtol=1e-9)
    # The engine has them, and the base is still at rest.
    gains = np.array([scene.actuators[name].kv for name in ("hip", "knee")])
    assert_allclose(gains, [DAMPING["hip"], DAMPING["knee"]], rtol=1e-9)
    assert not np.any(scene["base"].links[-1].velocity)


def test_damping_by_velocity_is_no_ratio(tmp_path):
    # A positive last parameter of a bias is a ratio only where the gain is that of a servo.
    text = ROBOT[: ROBOT.index("<actuator>")] + (
        '<actuator><general name="a" joint="hip" gainprm="5" biastype="affine" biasprm="0 -4 .5"/>'
        '<general name="b" joint="hip" gainprm="5" biastype="affine" biasprm="0 -5 .5"/></actuator></mujoco>'
    )
    scene = load(tmp_path, text)
    # Numbers of MuJoCo 4.0.
    assert_allclose(
        [scene.actuators[name].spec.bias[2] for name in "ab"], [0.5, -0.945871038426865], rtol=1e-9
    )


def test_muscles_as_general_actuators_say_what_of_them_is_not_simulated(tmp_path):
    begin = (
        ROBOT[: ROBOT.index("<actuator>")]
        + '<actuator><general joint="hip" gaintype="muscle" biastype="muscle" '
        'lengthrange="-1 1" gainprm=".75 1.05 9 200 .5 1.6 1.5 1.3 1.2" biasprm="'
    )
    scene = load(tmp_path, begin + '.75 1.1 9 200 .5 1.5 1.5 1.3 1.2"/></actuator></mujoco>')
    (lost,) = scene.ignored.that_matter
    assert lost.consequence == "its passive force has the lmax, range of the active one"
    with pytest.raises(DescriptionError, match="a muscle needs lmin < 1 < lmax"):
        load(tmp_path, begin.replace(".5 1.6", "1.5 1.6") + '1"/></actuator></mujoco>')
