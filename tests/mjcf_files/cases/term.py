"""MJCF files of the tests of terms of joints and tendons, and of sliders; see `record_terms.py`."""

_HEAD = '<mujoco><option timestep=".001" gravity="{}">{}</option><default>{}</default><worldbody>'


def _free(
    terms: str, default: str = "", gravity: str = "0 0 -9.81", option: str = "", damping: str = 'damping=".1"'
) -> str:
    return f"""{_HEAD.format(gravity, option, default)}<body name="f" pos="0 0 1" euler="20 30 40">
<joint type="free" {terms}/><geom type="box" size=".1 .2 .3" pos=".1 .2 .05"/><body name="arm" pos=".3 0 0">
<joint axis="0 1 1" {damping}/><geom size=".1" pos="0 .2 .1"/></body></body></worldbody>
<keyframe><key qpos="0 .1 1 1 .2 .1 0 .3" qvel="1 -.5 2 4 -3 5 2"/></keyframe></mujoco>"""


def _ball(joint: str, start: str = ".9 .4 .2 -.1") -> str:
    return f"""{_HEAD.format("3 0 -9.81", "", "")}<body name="a" pos="0 0 1"><joint name="b" type="ball"
 pos="0 .05 0" {joint}/><geom type="box" size=".1 .05 .02" pos=".1 0 -.2"/><body name="c"
 pos=".2 0 0"><joint axis="0 1 0"/><geom size=".05" pos=".1 0 0"/></body></body></worldbody>
<keyframe><key qpos="{start} .2" qvel="1 -2 1 1"/></keyframe></mujoco>"""


def _tendon(tendon: str) -> str:
    return f"""{_HEAD.format("0 0 -9.81", "", "")}<body name="a" pos="0 0 1"><joint name="j" axis="0 1 0"
 damping=".1"/><geom size=".1" pos=".3 0 0"/><body name="b" pos=".3 0 0"><joint name="k" axis="0 1 .2"
 armature=".02"/><geom size=".08" pos=".2 0 .1"/></body></body></worldbody><tendon><fixed name="t" {tendon}>
<joint joint="j" coef=".5"/><joint joint="k" coef="-1.5"/></fixed></tendon>
<keyframe><key qpos=".3 -.4" qvel="1 -2"/></keyframe></mujoco>"""


def _crank(actuator: str, rod: str = ".5") -> str:
    return f"""{_HEAD.format("0 0 -9.81", "", "")}<site name="rail" pos=".6 0 .1" zaxis="1 0 .2"/>
<body name="a"><joint name="j" axis="0 1 0" damping=".1"/><geom size=".1" pos="0 0 .2"/>
<site name="pin" pos=".02 0 .2"/><body name="b" pos="0 0 .3"><joint name="k" axis="0 1 .2"/><geom size=".08"
 pos=".2 0 .1"/><site name="guide" pos=".1 .02 0" euler="10 20 0"/></body></body></worldbody><actuator>
<motor name="p" {actuator} cranklength="{rod}" gear="15"/></actuator><sensor>
<actuatorpos name="l" actuator="p"/><actuatorvel name="r" actuator="p"/></sensor>
<keyframe><key qpos=".3 -.4" qvel="1 -2" ctrl=".4"/></keyframe></mujoco>"""


MOVED: dict[str, str] = {
    "free without terms": _free(""),
    "free with damping": _free('damping="3"'),
    "free with armature": _free('armature="5"', gravity="1 2 -3"),
    "free with both by a default": _free("", '<joint damping="2" armature=".7"/>'),
    "free with a spring": _free('stiffness="60" armature=".5"'),
    "free with a spring and a damper": _free('stiffness="40" damping="5"', gravity="1 2 -3"),
    "free with a spring off": _free('stiffness="90"', option='<flag spring="disable"/>'),
    "free with a damper off": _free('damping="50"', option='<flag damper="disable"/>'),
    "free with friction": _free('frictionloss="3"', damping=""),
    "free with friction that holds": _free('frictionloss="900" solreffriction=".1 1"', damping=""),
    "free with soft friction": _free(
        'frictionloss="40" solreffriction=".3 1" solimpfriction=".4 .5 .1"', damping=""
    ),
    "free with friction off": _free('frictionloss="3"', option='<flag frictionloss="disable"/>'),
    "ball without a limit": _ball(""),
    "ball with friction": _ball('frictionloss=".3"'),
    "ball with friction that holds": _ball('frictionloss="90"'),
    "ball with soft friction": _ball('frictionloss="8" solreffriction=".3 1" solimpfriction=".4 .5 .1"'),
    "ball with a limit": _ball('range="0 45"'),
    "ball with a soft limit": _ball('range="0 30" solreflimit=".1 .4" solimplimit=".5 .8 .1" margin=".1"'),
    "ball beyond half a turn": _ball('range="0 150"', "-.1 .9 .3 .2"),
    "ball with limits off": _ball('range="0 45"').replace("</option>", '<flag limit="disable"/></option>'),
    "tendon with armature": _tendon('armature=".4"'),
    "tendon with armature, spring and damper": _tendon('armature=".4" stiffness="20" damping=".3"'),
    "crank on a slider of the world": _crank('cranksite="pin" slidersite="rail"'),
    "crank on a slider that moves": _crank('cranksite="pin" slidersite="guide"'),
    "crank in the world": _crank('cranksite="rail" slidersite="guide"', "1.1"),
    "rod that is too short": _crank('cranksite="pin" slidersite="rail"', ".05"),
}
STEPS = (1, 100, 400)
