"""MJCF files of the tests with sensors; `record_sensors.py` asks MuJoCo what they show."""

FRAMES = ("pos", "quat", "xaxis", "yaxis", "zaxis", "linvel", "angvel", "linacc", "angacc")

_BODIES = """<mujoco><option timestep="1e-7" magnetic=".1 .2 -.4"><flag contact="disable"/></option>
<worldbody><geom type="plane" size="5 5 .1"/><body name="a" pos="0 0 1"><joint name="j" axis="0 1 0"
 range="-90 90"/><geom size=".1" pos=".2 0 0"/><site name="one" pos=".1 .05 0" euler="20 0 10"/><body name="b"
 pos=".4 0 0" euler="0 0 20"><joint name="k" type="slide" axis="1 0 0" range="-.1 .05" limited="true"/>
<geom type="box" size=".05 .1 .15" pos=".1 0 0"/><site name="tip" pos=".2 .1 0" euler="180 10 0"/>
<body name="c" pos="0 0 .3"><joint name="ball" type="ball"/>
<geom type="capsule" size=".04 .1" pos=".1 0 0"/></body></body></body>
<body name="f" pos="1 2 1.5"><freejoint/><geom type="box" size=".1 .2 .3" pos=".1 0 0"/>
<site name="free" pos="0 .1 .2"/></body></worldbody><actuator><motor name="m" joint="j" gear="3"/>
<position name="p" joint="k" kp="50"/></actuator><sensor>"""
_PARTS = [
    *(f'<{tag} site="tip"/>' for tag in ("accelerometer", "velocimeter", "gyro", "magnetometer")),
    *(f'<{tag} site="{site}"/>' for site in ("tip", "one") for tag in ("force", "torque")),
    *(f'<{tag} site="one"/>' for tag in ("gyro", "velocimeter")),
    *(f'<{tag} site="free"/>' for tag in ("accelerometer", "velocimeter", "gyro")),
    '<rangefinder site="tip"/>',
    '<rangefinder site="tip" cutoff=".5"/>',
    *(f'<joint{what} joint="{joint}"/>' for what in ("pos", "vel", "actuatorfrc") for joint in "jk"),
    *(f'<joint{what} joint="k"/>' for what in ("limitpos", "limitvel")),
    '<ballquat joint="ball"/>',
    '<ballangvel joint="ball"/>',
    *(f'<actuator{what} actuator="{it}"/>' for what in ("pos", "vel", "frc") for it in "mp"),
    *(f'<frame{what} objtype="site" objname="tip"/>' for what in FRAMES),
    *(f'<frame{what} objtype="xbody" objname="b"/>' for what in FRAMES),
    *(f'<frame{what} objtype="site" objname="tip" reftype="xbody" refname="f"/>' for what in FRAMES[:7]),
    '<framepos objtype="body" objname="b" reftype="site" refname="one"/>',
    '<framelinvel objtype="body" objname="f" reftype="xbody" refname="world"/>',
    *(f'<subtree{what} body="{body}"/>' for what in ("com", "linvel", "angmom") for body in "abf"),
    '<gyro site="tip" cutoff=".4"/>',
]
_PULLED = """<mujoco><option timestep="1e-7" gravity="0 0 0"/><worldbody><site name="w" pos=".3 .1 .4"/>
<body name="a" pos="0 0 1"><joint name="j1" axis="0 1 0"/><geom size=".05" pos="0 0 -.2"/><site name="sa"
 pos=".1 .05 -.3"/><geom name="roll" type="cylinder" size=".04 .1" euler="90 0 0" pos="0 0 -.4" contype="0"
 conaffinity="0"/><body name="b" pos="0 0 -.4"><joint name="j2" axis="0 1 0" pos=".01 0 .02"/><geom size=".05"
 pos="0 .02 -.2"/><site name="sb" pos=".1 0 -.2" euler="10 20 30"/><body name="c" pos="0 0 -.4"><joint
 name="j3" type="slide" axis="0 .6 .8"/><geom size=".05"/><site name="sc" pos=".02 .01 0"/><body name="d"
 pos="0 .1 0"><joint name="j4"/><geom size=".05" pos=".1 0 0"/></body></body></body></body></worldbody>
<tendon><spatial name="t"><site site="w"/><site site="sa"/><geom geom="roll"/><site site="sb"/>
<pulley divisor="2"/><site site="sb"/><site site="sc"/></spatial><fixed name="f"><joint joint="j1" coef=".5"/>
<joint joint="j3" coef="-2"/></fixed></tendon><actuator><motor joint="j1" gear="2"/>
<motor tendon="t" gear="3"/><motor tendon="f"/><motor site="sc" gear="1 2 3 .1 .2 .3"/>
<motor site="sc" refsite="sa" gear="1 0 2 0 .4 .3"/><general cranksite="sb" slidersite="w" cranklength="2"/>
</actuator><sensor>"""
_PULLED += "".join(f'<jointactuatorfrc name="s{number}" joint="j{number}"/>' for number in range(1, 5))
_PULLED += "</sensor></mujoco>"
_FRAMED = """<mujoco><option timestep="1e-7"/><worldbody><frame pos="0 0 .2" euler="0 30 0"><body name="a">
<joint axis="0 1 .2"/><geom name="g" type="box" size=".1 .2 .3" pos=".2 0 .1" euler="10 20 30"/><body name="b"
 pos=".3 0 0"><joint axis="1 0 0"/><geom name="h" type="cylinder" size=".05" fromto="0 0 0 .1 .2 .3"/>
<camera name="eye" pos=".1 0 .2" xyaxes="0 1 0 .2 0 1"/></body></body></frame></worldbody><sensor>"""
_FRAMED += "".join(
    f'<frame{what} name="{kind}{what}" objtype="{kind}" objname="{name}"/>'
    for kind, name in (("geom", "g"), ("camera", "eye"))
    for what in FRAMES
)
_FRAMED += "".join(
    f'<frame{what} name="between{what}" objtype="geom" objname="h" reftype="camera" refname="eye"/>'
    f'<frame{what} name="back{what}" objtype="xbody" objname="b" reftype="geom" refname="g"/>'
    for what in FRAMES[:7]
)
_FRAMED += "</sensor></mujoco>"
SENSORS: dict[str, str] = {
    "one of each": f"{_BODIES}{''.join(_PARTS)}</sensor></mujoco>",
    "copies": '<mujoco><worldbody><replicate count="3" offset="0 1 0"><body><joint name="r"/><geom size=".1" '
    'pos=".1 0 0"/><site name="s" pos="0 0 .2"/></body></replicate></worldbody><sensor><jointpos name="p" '
    'joint="r"/><velocimeter name="v" site="s"/></sensor></mujoco>',
    "joints that tendons and sites pull": _PULLED,
    "frames of geoms and cameras": _FRAMED,
}
