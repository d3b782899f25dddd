"""MJCF files of the tests of mass matrices, accelerations and forces; see `record_dynamics.py`."""


def _file(bodies: str, key: str, rest: str = "") -> str:
    return f"""<mujoco><compiler angle="radian"/><worldbody>{bodies}</worldbody>{rest}
<keyframe><key {key}/></keyframe></mujoco>"""


def _chain(tendons: str, actuators: str, controls: str) -> str:
    return _file(
        """<body><joint name="a" axis="0 1 0"/><geom type="capsule" size=".05" fromto="0 0 0 .5 0 0"/>
<site name="s" pos=".25 0 .1"/><body pos=".5 0 0"><joint name="b" axis="0 1 0"/>
<geom type="capsule" size=".05" fromto="0 0 0 .5 0 .1"/><site name="t" pos=".25 0 .1"/></body></body>""",
        f'qpos=".3 -.4" qvel="1 -2" ctrl="{controls}"',
        f"<tendon>{tendons}</tendon><actuator>{actuators}</actuator>",
    )


_FIXED = '<fixed name="f" {}><joint joint="a" coef=".5"/><joint joint="b" coef="-1.5"/></fixed>'
_SPATIAL = '<spatial name="f" {}><site site="s"/><site site="t"/></spatial>'
_TWO = '<motor tendon="f" gear="2"/><motor joint="b"/><motor tendon="f" gear="-3"/>'

DYNAMICS: dict[str, str] = {
    "free body with armature": _file(
        """<body pos="0 0 1" euler=".2 .3 .4"><joint type="free" armature=".7"/>
<geom type="box" size=".1 .2 .3" pos=".1 .2 .05"/><body pos=".3 0 0"><joint axis="0 1 1" armature=".05"/>
<geom size=".1" pos="0 .2 .1"/></body></body>""",
        'qpos="0 .1 1 1 .2 .1 0 .3" qvel="1 -.5 2 4 -3 5 2"',
    ),
    "ball with a slanting capsule": _file(
        """<body pos="0 0 1"><joint axis="1 0 0"/><geom type="capsule" size=".08" fromto="0 0 0 .6 .6 0"/>
<body pos=".6 .6 0"><joint type="ball" armature=".1" damping=".2"/>
<geom type="capsule" size=".08" fromto="0 0 0 .3 .6 .1"/></body></body>""",
        'qpos=".4 .9 .4 .2 -.1" qvel="1 2 -1 3"',
    ),
    "joint with negative damping": _file(
        '<body><joint axis="0 1 0" damping="-.2"/><geom size=".1" pos=".3 0 0"/></body>', 'qpos=".3" qvel="2"'
    ),
    "bounded sum on a fixed tendon": _chain(_FIXED.format('actuatorfrcrange="-1 2"'), _TWO, "2.5 .3 .7"),
    "sum below its bound": _chain(_FIXED.format('actuatorfrcrange="-1 2"'), _TWO, "-4 .3 1"),
    "sum within its bounds": _chain(_FIXED.format('actuatorfrcrange="-1 2"'), _TWO, ".4 .3 .7"),
    "bounded sum on a spatial tendon": _chain(_SPATIAL.format('actuatorfrcrange="-1 2"'), _TWO, "2.5 .3 .7"),
    "bounded servos on a tendon": _chain(
        _FIXED.format('actuatorfrcrange="-1 2"'),
        '<position tendon="f" kp="30" kv="2" forcerange="-9 9"/><velocity tendon="f" kv="3" gear="2"/>',
        ".3 -1",
    ),
    "servos on a tendon within its bounds": _chain(
        _FIXED.format('actuatorfrcrange="-900 900"'),
        '<position tendon="f" kp="30" kv="2"/><velocity tendon="f" kv="3" gear="2"/>',
        ".3 -1",
    ),
    "tendon that moves nothing": _file(
        """<body><joint axis="0 1 0"/><geom size=".1" pos=".3 0 0"/><site name="s"/>
<site name="t" pos=".2 0 0"/></body>""",
        'qpos=".3" qvel="2" ctrl=".7"',
        '<tendon><spatial name="f"><site site="s"/><site site="t"/></spatial></tendon>'
        '<actuator><motor tendon="f" gear="2"/></actuator>',
    ),
}
