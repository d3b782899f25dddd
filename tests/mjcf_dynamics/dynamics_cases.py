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

_APART = """<body name="a" pos="0 0 1"><joint name="ja" axis="0 1 0" armature=".1"/>
<geom size=".1 .2 .3" type="box" pos=".05 .02 0"/><site name="s" pos=".1 0 .2" euler="0 .9 0"/>
<body pos="0 0 .6"><joint type="ball" damping=".01"/><geom size=".05" pos=".1 0 .1"/>
<site name="r" pos=".1 0 0"/></body></body>
<body name="b" pos="2 0 1" euler=".3 .2 .1"><geom size=".1" pos="0 0 -1"/><body>
<joint name="jb" type="slide" axis="1 0 1"/><geom size=".1 .2 .3" type="box" pos=".05 .02 0"/>
<site name="t" pos="0 .1 .1" euler=".7 0 .1"/></body></body>"""


def _apart(tendons: str, actuators: str, controls: str) -> str:
    return _file(
        _APART,
        f'qpos=".3 .9 .4 .2 -.1 -.2" qvel="1 2 -1 3 -2" ctrl="{controls}"',
        f"<tendon>{tendons}</tendon><actuator>{actuators}</actuator>",
    )


_RIG = """<site name="w" pos="0 .3 1" euler=".1 .2 .3"/><body name="a" pos="0 0 1" euler=".3 .2 .1">
<joint name="f" type="free"/><geom size=".1 .2 .3" type="box" pos=".05 .02 0"/>
<site name="s" pos=".1 0 .2" euler="0 .9 0"/></body>"""


def _free(*actuators: str) -> str:
    return _file(
        _RIG,
        f'qpos="0 .1 1 1 .2 .1 0" qvel="1 -.5 2 4 -3 5" ctrl="{" ".join([".7"] * len(actuators))}"',
        f"<actuator>{''.join(actuators)}</actuator>",
    )


DYNAMICS: dict[str, str] = {
    "spatial tendon between bodies of the world": _apart(
        '<spatial name="f" stiffness="20" damping=".3" springlength=".2"><site site="r"/><site site="t"/>'
        "</spatial>",
        '<position tendon="f" kp="3" kv=".2"/>',
        ".7",
    ),
    "fixed tendon over joints of two bodies of the world": _apart(
        '<fixed name="f" stiffness="3" damping=".1"><joint joint="ja" coef="1"/>'
        '<joint joint="jb" coef="-2"/></fixed>',
        '<motor tendon="f"/><motor joint="jb"/>',
        ".7 -.3",
    ),
    "actuators between sites of two bodies of the world": _apart(
        "",
        '<motor site="s" refsite="t" gear="1 2 3 -1 .5 .7"/>'
        '<position site="t" refsite="s" gear="1 2 3" kp="2"/>',
        ".7 .4",
    ),
    "force at a free joint": _free('<motor joint="f" gear="1 2 3"/>'),
    "torque at a free joint": _free('<velocity joint="f" gear="0 0 0 1 2 3" kv=".02"/>'),
    "wrench along the axes around a free joint": _free('<motor jointinparent="f" gear="1 -2 .5 .2 .3 .4"/>'),
    "servo of a free joint, whose length is 0": _free('<position joint="f" gear="0 0 1" kp="3" kv=".2"/>'),
    "actuator of a site of the world in a frame that moves": _free(
        '<velocity site="w" refsite="s" gear="1 2 3 -1 .5 .7" kv=".03"/>'
    ),
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
