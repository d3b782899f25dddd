"""MJCF files of the tests of fluids; see `record_fluids.py`."""

STEPS = 200


def _file(option: str, bodies: str, key: str, flags: str = "", assets: str = "") -> str:
    return f"""<mujoco><compiler angle="radian"/><option timestep=".002" {option}><flag {flags}/></option>
<asset>{assets}</asset><worldbody><geom type="plane" size="1 1 1"/>{bodies}</worldbody>
<keyframe><key {key}/></keyframe></mujoco>"""


_BOX = """<body name="a" pos="0 0 1" euler=".3 .4 .5"><freejoint/>
<geom type="box" size=".1 .2 .3" pos=".05 .1 0"/></body>"""
_ARM = """<body name="a" pos="0 0 1"><joint axis="0 1 0"/><geom type="capsule" fromto="0 0 0 .3 .05 0"
 size=".04"/><body name="b" pos=".3 .05 0"><joint axis="0 1 .2"/><geom type="capsule" fromto="0 0 0 .2 0 .1"
 size=".03"/><body name="c" pos=".2 0 .1"><geom type="box" size=".05 .02 .1" euler=".2 0 .1"/></body></body>
</body>"""
_FISH = """<body name="a" pos="0 0 1" euler=".1 -.2 .3"><freejoint/>
<geom type="ellipsoid" size=".1 .05 .2" fluidshape="ellipsoid" fluidcoef=".6 .3 1.4 .9 .8"/>
<geom type="sphere" size=".08" pos=".1 0 .1" fluidshape="ellipsoid"/><geom type="box" size=".05 .05 .1"/>
<body name="b" pos="0 0 -.2"><joint axis="0 1 0"/>
<geom type="capsule" size=".02 .1" pos="0 0 -.1" euler=".3 .2 0" fluidshape="ellipsoid" fluidcoef=".7"/>
</body>
<body name="c" pos="0 .2 0"><joint axis="1 0 0"/><geom type="cylinder" size=".06 .02" fluidshape="ellipsoid"/>
<geom type="mesh" mesh="m" fluidshape="ellipsoid" pos="0 .1 0"/></body>
<body name="d" pos="0 -.2 0"><joint axis="1 0 0"/><geom type="box" size=".02 .1 .05"/></body></body>"""
_MESH = '<mesh name="m" vertex="0 0 0 .1 0 0 0 .2 0 0 0 .15 .1 .2 .15"/>'
_MOVING = 'qpos=".1 .2 1 .9 .3 .2 -.1" qvel="1 -.5 2 3 -2 1"'
_BENT = 'qpos=".4 -.7" qvel="2 -3"'
_SWIMMING = 'qpos=".1 .2 1 .9 .3 .2 -.1 .2 -.3 .4" qvel="1 -.5 2 1 -2 1 2 -1 3"'

FLUIDS: dict[str, str] = {
    "box in a viscous fluid": _file('viscosity=".3"', _BOX, _MOVING),
    "box in a dense fluid": _file('density="200"', _BOX, _MOVING),
    "box in wind": _file('density="200" viscosity=".3" wind="1 2 -.5"', _BOX, _MOVING),
    "arm": _file('density="500" viscosity=".5" wind="0 0 1"', _ARM, _BENT),
    "ellipsoids": _file('density="300" viscosity=".2" wind="1 2 -.5"', _FISH, _SWIMMING, assets=_MESH),
    "ellipsoids in a viscous fluid": _file('viscosity="2"', _FISH, _SWIMMING, assets=_MESH),
    "arm with springs off": _file('density="500"', _ARM, _BENT, 'spring="disable"'),
    "arm with passive forces off": _file('density="500"', _ARM, _BENT, 'spring="disable" damper="disable"'),
}
