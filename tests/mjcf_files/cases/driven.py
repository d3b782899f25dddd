"""MJCF files of the tests with actuators and constraints; `record_driven.py` asks MuJoCo what they do."""

_ARM = """<body name="a" pos="0 0 1"><joint name="j" axis="0 1 0" range="-60 60" armature=".1" damping=".2"
 actuatorfrcrange="-8 8"/><geom size=".1" pos=".2 0 0" density="300"/><body pos=".3 0 0" name="b"><joint
 name="k" type="slide" axis="1 0 0" range="-.4 .5" damping="20"/><geom type="box" size=".05 .05 .1"
 density="400"/></body></body>"""
_CLASSES = """<default><position kp="20"/><default class="geared"><general forcerange="-3 3" gear="2"/>
</default></default>"""


def arm(actuators: str, before: str = "", *, bounded: bool = False) -> str:
    head = '<option timestep=".0005"><flag contact="disable" limit="disable"/></option>'
    body = _ARM if bounded or actuators.count('"j"') < 2 else _ARM.replace('actuatorfrcrange="-8 8"', "")
    return f"<mujoco>{head}{before}<worldbody>{body}</worldbody><actuator>{actuators}</actuator></mujoco>"


ACTUATED: dict[str, str] = {
    "motor": arm('<motor name="m" joint="j" gear="3" ctrlrange="-1 1"/><motor joint="k" forcerange="-2 2"/>'),
    "motor with a negative gear": arm('<motor joint="j" gear="-12"/>'),
    "position": arm('<position joint="j" kp="40" kv="3"/><position joint="k" kp="90" kv="5"/>'),
    "damping ratios": arm(
        '<position joint="j" kp="40" dampratio="1"/><position joint="k" dampratio=".7" class="geared"/>',
        _CLASSES,
    ),
    "inherited range": arm('<position joint="j" kp="9" kv="1" inheritrange=".3"/>'),
    "filtered position": arm('<position joint="j" kp="40" kv="3" timeconst=".1"/>'),
    "velocity": arm('<velocity joint="j" kv="5"/><velocity joint="k" class="geared"/>', _CLASSES),
    "integrated velocity": arm('<intvelocity joint="j" kp="40" kv="2" actrange="-.2 .3"/>'),
    "damper": arm('<damper joint="j" kv="2" ctrlrange="0 5"/><damper joint="k" kv="9" ctrlrange="0 5"/>'),
    "cylinder": arm('<cylinder joint="k" diameter=".2" bias="1 -2 -3" timeconst=".2"/>'),
    "general": arm(
        '<general joint="k" gaintype="affine" gainprm="1 2 -3" biastype="affine" biasprm="3 -2 -1" '
        'dyntype="filter" dynprm=".3"/><general joint="j" gainprm="5" biastype="affine" biasprm="0 -5 .8"/>'
    ),
    "general with an integrator": arm('<general jointinparent="k" dyntype="integrator" gainprm="7"/>'),
    "defaults of other shortcuts": arm(
        '<general joint="j"/><motor joint="k" class="geared"/><velocity joint="j"/>', _CLASSES
    ),
    "dcmotor": arm(
        '<dcmotor joint="j" motorconst=".5 .7" resistance=".3" gear="3"/>'
        '<dcmotor joint="k" nominal="12 9 2"/>'
    ),
    "dcmotor with defaults": arm(
        '<dcmotor joint="j" class="strong"/>'
        '<dcmotor joint="k" class="strong" nominal="1 2 4" saturation="0 3"/>',
        '<default><default class="strong"><dcmotor motorconst="2" resistance=".5" saturation="1.5 1 9" '
        'ctrlrange="-1 1" cogging="0 6 0"/></default></default>',
    ),
    "dcmotor after a general default": arm(
        '<dcmotor joint="j" motorconst="0 2" resistance=".5" input="voltage"/>',
        '<default><general gainprm="7" forcerange="-1 1"/></default>',
    ),
    "sum of motors": arm('<motor joint="j" gear="90"/><motor joint="j" gear="-3"/>', bounded=True),
    "sum of servos": arm(
        '<position joint="j" kp="60" kv="2"/><velocity joint="j" kv="5" forcerange="-1 1"/>'
        '<motor joint="k"/>',
        bounded=True,
    ),
    "sum of servos that is within": arm(
        '<position joint="j" kp=".9" kv="1" gear="-2"/><velocity joint="j" kv=".5"/>'
        '<intvelocity joint="j" kp="3" actrange="-1 1"/>',
        bounded=True,
    ),
    "switched off": arm(
        '<motor joint="k" group="2"/><motor joint="j"/>', '<option actuatorgroupdisable="2"/>'
    ),
    "copies": '<mujoco><worldbody><replicate count="3" offset="0 1 0"><body><joint name="r"/><geom size=".1" '
    'pos=".1 0 0"/></body></replicate></worldbody><actuator><motor name="m" joint="r"/></actuator></mujoco>',
}

_HEAD = '<mujoco><option timestep=".001"><flag contact="disable"/></option><worldbody>'
TIED: dict[str, str] = {
    "connected sites": f"""{_HEAD}<body name="a" pos="0 0 1"><joint name="j" axis="0 1 0"/><geom size=".1"
 pos=".2 0 0"/><site name="tip" pos=".4 0 0"/></body><body name="b" pos=".4 0 1.3"><joint name="k"
 axis="0 1 0" ref="10"/><geom size=".1" pos="-.1 0 .2"/><site name="top" pos="0 0 -.3"/></body>
</worldbody><equality><connect site1="tip" site2="top"/></equality></mujoco>""",
    "hung from the world": f"""{_HEAD}<body name="f" pos="0 2 1"><freejoint/><geom type="box" size=".1 .2 .3"
 pos=".1 0 0"/></body></worldbody><equality><connect body1="f" anchor=".1 .2 .3"/></equality></mujoco>""",
    "welded": f"""{_HEAD}<body name="f" pos="0 2 1"><joint name="x" axis="0 1 0" pos="-.5 0 0"/><geom
 size=".1"/></body><body name="g" pos="0 3 1" euler="10 20 30"><freejoint/><geom type="box" size=".1 .2 .1"/>
</body></worldbody><equality><weld body1="f" body2="g"/></equality></mujoco>""",
    "welded to a moved body": f"""{_HEAD}<body name="m" mocap="true" pos="0 5 1"/><body name="h" pos="0 5.5 1"
 quat="1 0 0 1"><freejoint/><geom size=".1"/></body></worldbody><equality><weld body1="m" body2="h"
 relpose="0 .5 0 1 0 0 1"/></equality></mujoco>""",
    "coupled": f"""{_HEAD}<body name="l" pos="3 0 0"><joint name="one" axis="0 1 0"/><geom size=".1" pos=".3
 0 0"/></body><body name="n" pos="4 0 0"><joint name="two" axis="0 1 0" ref="20"/><geom size=".1" pos=".2 0
 0"/></body></worldbody><equality><joint joint1="two" joint2="one" polycoef="0 -.5 .1"/>
</equality></mujoco>""",
    "coupled to a reference": f"""{_HEAD}<body name="l"><joint name="one" axis="0 1 0" ref="30"/><geom
 size=".1" pos=".3 0 0"/><body name="n" pos=".3 0 0"><joint name="two" axis="0 1 0"/><geom size=".1" pos=".2
 0 0"/></body></body></worldbody><equality><joint joint1="two" joint2="one" polycoef="0 -.5 .2 .1"/>
</equality></mujoco>""",
    "softly connected": f"""{_HEAD}<body name="f" pos="0 2 1"><freejoint/><geom size=".1"/></body></worldbody>
<equality><connect body1="f" anchor="0 0 0" solref=".15 .4" solimp=".5 .8 .02"/></equality></mujoco>""",
    "softly welded": f"""{_HEAD}<body name="m" mocap="true" pos="0 5 1"/><body name="h" pos="0 5.5 1">
<freejoint/><geom size=".1"/></body></worldbody><equality><weld body1="m" body2="h"
 relpose=".05 .5 .1 1 .1 .05 0" solref="-300 -20" solimp=".7 .95 .05 .4 3"/></equality></mujoco>""",
    "softly coupled": f"""{_HEAD}<body name="l"><joint name="one" axis="0 1 0"/><geom size=".1" pos=".3 0
 0"/></body></worldbody><equality><joint joint1="one" polycoef="-.2" solref=".2 1"/></equality></mujoco>""",
}
