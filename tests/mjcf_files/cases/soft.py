"""MJCF files of the tests of what yields; `record_soft.py` asks MuJoCo how they move."""

WEIGHED = """<mujoco><worldbody><body name="a" pos="0 0 1" euler="10 20 30"><joint name="hinge" axis="0 1 0"
 damping=".1" armature=".2"/><geom size=".1" pos=".2 0 0"/><body name="b" pos=".4 .1 0"><joint name="ball"
 type="ball" pos="0 .1 0"/><geom type="box" size=".1 .2 .3" pos=".1 0 .3"/><body name="c" pos="0 0 .5"><joint
 name="slide" type="slide" axis="1 1 0"/><joint name="other" axis="0 1 1" armature=".1" ref="30"/><geom
 size=".05"/><body name="d" pos="0 .1 0"><geom size=".1"/></body></body>
<body name="massless" pos=".2 .3 .4" euler="0 40 0">
<geom size=".1" mass="0" pos="0 0 1"/></body><frame pos="0 0 1"><body name="empty" pos=".1 0 .2"/>
</frame></body></body>
<body name="free" pos="3 0 0"><freejoint/><geom type="box" size=".1 .2 .3" pos=".1 .2 0"/>
<body name="arm" pos=".3 0 0"><joint
 name="last" axis="1 0 0"/><geom size=".1" pos="0 .2 0"/></body></body><body name="still"><geom size=".1"/>
</body></worldbody></mujoco>"""


def _pendulum(joint: str, more: str = "", option: str = "", gravity: str = "0 0 -9.81") -> str:
    return f"""<mujoco><option timestep=".001" gravity="{gravity}">{option}</option><worldbody>
<body name="a" pos="0 0 1"><joint name="j" axis="0 1 0" {joint}/><geom size=".1" pos=".3 0 0" density="300"/>
<body name="b" pos=".3 0 0"><joint name="k" type="slide" axis="1 0 0" range="-.1 .1"/><geom size=".05"
 density="800"/></body></body></worldbody>{more}</mujoco>"""


def _ball(plane: str, ball: str, option: str = "") -> str:
    return f"""<mujoco>{option}<worldbody><geom type="plane" size="5 5 .1" {plane}/><body name="f"
 pos="0 0 .1999"><freejoint/><geom size=".2" {ball}/></body></worldbody></mujoco>"""


def pair_of(stated: str, geom: str = "", option: str = "") -> str:
    """A ball that a sloping force rolls on a plane whose contacts only a pair describes."""
    return f"""<mujoco><option timestep=".001" gravity="2 0 -9.81" {option}/><worldbody><geom name="p"
 type="plane" size="5 5 .1" friction=".7" {geom}/><body name="f" pos="0 0 .1999">
<freejoint/><geom name="s" size=".2"
 solref=".07 .4" priority="1" {geom}/></body></worldbody><contact><pair
 geom1="p" geom2="s" {stated}/></contact>
<default><pair solimp=".8 .9 .002"/></default></mujoco>"""


def _arm(geom: str, option: str = "") -> str:
    ball = f'<geom size=".05" pos=".3 0 0" {geom}'
    return f"""<mujoco>{option}<worldbody><geom type="plane" size="5 5 .1" {geom}/><body name="a"
 pos="0 0 .25"><joint name="j" axis="0 1 0"/>{ball}/><body name="b" pos=".3 0 0"><joint name="k"
 axis="0 1 0"/>{ball} solref=".04 .8"/></body></body></worldbody></mujoco>"""


def _hull(ground: str) -> str:
    corners = " ".join(f"{x} {y} {z}" for x in (-0.3, 0.3) for y in (-0.2, 0.2) for z in (-0.1, 0.1))
    return f"""<mujoco><asset><mesh name="m" vertex="{corners}"/></asset><worldbody><geom pos="0 0 -.1"
 {ground}/><body name="f" pos="0 0 .0999"><freejoint/><geom type="mesh" mesh="m" solref=".05 .6"/></body>
</worldbody></mujoco>"""


_FIXED = '<tendon><fixed name="t" range="-.1 .2" {}><joint joint="j" coef=".5"/><joint joint="k" coef="2"/>'
MOVED: dict[str, str] = {
    "limits": _pendulum('range="-30 20"'),
    "soft limit": _pendulum('range="-30 20" solreflimit=".1 .4" solimplimit=".5 .8 .1 .3 3"'),
    "limit with a margin": _pendulum('range="-30 20" margin=".2" solreflimit="-600 -30"'),
    "limit with stiffness": _pendulum('range="-30 20" solreflimit="-900 -10"'),
    "friction": _pendulum('frictionloss="3.5"'),
    "soft friction": _pendulum('frictionloss="30" solreffriction=".3 1" solimpfriction=".4 .5 .1"'),
    "friction that slides": _pendulum('frictionloss=".8" solreffriction=".1 1"'),
    "springdamper": _pendulum('springdamper=".2 .7" springref="25"'),
    "tendon limit": _pendulum("", _FIXED.format("") + "</fixed></tendon>"),
    "soft tendon limit": _pendulum(
        "", _FIXED.format('solreflimit=".1 .5" solimplimit=".6 .9 .1" margin=".03"') + "</fixed></tendon>"
    ),
    "limits off": _pendulum('range="-30 20"', option='<flag limit="disable"/>'),
    "spring off": _pendulum('stiffness="9" damping=".1"', option='<flag spring="disable"/>'),
    "damper off": _pendulum('stiffness="9" damping="2"', option='<flag damper="disable"/>'),
    "friction off": _pendulum('frictionloss="3.5"', option='<flag frictionloss="disable"/>'),
    "equality off": _pendulum("", '<equality><joint joint1="j"/></equality>', '<flag equality="disable"/>'),
    "constraint off": _pendulum(
        'range="-30 20" frictionloss="1"',
        '<equality><joint joint1="k"/></equality>',
        '<flag constraint="disable"/>',
    ),
    "clampctrl off": _pendulum(
        "",
        '<actuator><motor joint="j" ctrlrange="-.1 .1" name="m"/></actuator>',
        '<flag clampctrl="disable"/>',
    ),
    "contact": _ball("", ""),
    "contact without friction": _ball("", 'condim="1"').replace("<geom type", '<geom condim="1" type'),
    "little friction": _ball('friction=".5"', 'friction=".3"'),
    "spinning friction": _ball("", 'condim="4"'),
    "rolling friction": _ball("", 'condim="6"'),
    "round cones": _ball("", "", '<option cone="elliptic"/>'),
    "stiff cones": _ball("", "", '<option impratio="4"/>'),
    "margins": _ball('margin=".01" gap=".02"', 'margin=".004"'),
    "mixed contacts": _ball('solref=".05 1" solmix="2"', 'solref=".03 .5" solimp=".7 .8 .01"'),
    "contact of one stiffness": _ball('solref="-500 -20"', 'solref=".02 .5"'),
    "contacts of two stiffnesses": _ball('solref="-500 -20"', 'solref="-300 -50"'),
    "contact of priority": _ball('solref=".1 1" priority="1"', 'solref=".03 .5"'),
    "contacts that an option overrides": _ball(
        'friction="2" priority="1" margin=".1"',
        'solref="-300 -50"',
        '<option o_margin=".03" o_solref=".05 .7" o_solimp=".6 .7 .01" o_friction=".3 .3 .02"><flag'
        ' override="enable"/></option>',
    ),
    "options that override nothing": _ball(
        "", "", '<option o_margin=".03" o_solref=".05 .7" o_friction="3"/>'
    ),
    "contact off": _ball("", "", '<option><flag contact="disable"/></option>'),
    "arm on a smooth floor": _arm('condim="1"'),
    "arm on a floor": _arm(""),
    "arm on a rough floor": _arm('friction="2"'),
    "arm with round cones": _arm("", '<option cone="elliptic"/>'),
    "box": """<mujoco><worldbody><geom type="plane" size="5 5 .1"/><body name="f" pos="0 0 .0999"><freejoint/>
<geom type="box" size=".3 .2 .1" solref=".05 .6"/></body></worldbody></mujoco>""",
    "box beside the origin of a plane": """<mujoco><worldbody><geom type="plane" size="1 1 .1" pos="2 -3 0"/>
<body name="f" pos="0 0 .0999"><freejoint/><geom type="box" size=".3 .2 .1" solref=".05 .6"/></body>
</worldbody></mujoco>""",
    "hull on a box": _hull('type="box" size="1 1 .1"'),
    "hull on a hull": _hull('type="mesh" mesh="m"'),
}
STEPS = (40, 120, 400)
PAIRS: dict[str, str] = {
    "pair": pair_of(""),
    "pair without bits": pair_of('solref=".05 .8"', 'contype="0" conaffinity="0" condim="1"'),
    "pair with a margin": pair_of(
        'margin=".03" gap=".02" solref=".03 .6" solimp=".5 .8 .02"', 'margin=".05"'
    ),
    "pair without friction": pair_of('condim="1"'),
    "pair of friction": pair_of('friction=".12 .12"'),
    "pair that spins": pair_of('condim="4" friction="1 1 .1"'),
    "pair of soft friction": pair_of('solreffriction=".2 1"', option='cone="elliptic"'),
    "pair of soft friction on pyramids": pair_of('solreffriction=".2 1"'),
}
