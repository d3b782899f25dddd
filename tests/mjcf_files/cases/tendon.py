"""MJCF files of the tests with tendons and their actuators; `record_tendons.py` asks MuJoCo what they do."""

_HEAD = """<option timestep=".0002"/><default><geom contype="0" conaffinity="0"/>{}</default>"""
_BODIES = """<worldbody><site name="fix" pos=".1 .05 .4"/><body name="still" pos=".2 0 0" euler="0 0 20"><geom
 name="post" type="cylinder" size=".05 .2" pos="0 0 .2" euler="90 0 0"/><site name="nail" pos="-.1 .05 .25"/>
</body><body name="a" pos="0 0 .1"><joint name="j" axis="0 1 0" damping=".1" armature=".01" springref="10"/>
<geom type="capsule" size=".02" fromto="0 0 0 .3 0 0"/><geom name="ball" size=".06" pos=".3 0 0"/><site
 name="one" pos=".12 .01 .05"/><site name="up" pos=".3 .01 .1"/><site name="in" pos=".3 .005 .02"/><body
 name="b" pos=".3 0 0"><joint name="k" axis=".1 1 0" damping=".1" ref="5"/><geom type="capsule" size=".02"
 fromto="0 0 0 .25 0 -.1"/><geom name="roll" type="cylinder" size=".03 .1" pos=".15 0 -.03" zaxis="0 1 .2"/>
<site name="two" pos=".1 .02 .06"/><site name="low" pos=".15 .01 -.08"/><site name="core" pos=".15 .01 -.03"/>
<body name="c" pos=".25 0 -.1"><joint name="s" type="slide" axis="1 0 .2" damping="2"/><geom size=".05"/>
<site name="end" pos=".05 .03 .05"/></body></body></body></worldbody>"""


def file(tendons: str, actuators: str = "", after: str = "", defaults: str = "") -> str:
    return (
        f"<mujoco>{_HEAD.format(defaults)}{_BODIES}<tendon>{tendons}</tendon><actuator>{actuators}</actuator>"
        f"{after}</mujoco>"
    )


def path(*parts: str, **attributes: str) -> str:
    """A spatial tendon: sites by name, `geom` or `geom/sidesite`, and numbers for pulleys."""
    geoms, inner = ("post", "ball", "roll"), ""
    for part in parts:
        name, _, side = part.partition("/")
        if name in geoms:
            inner += f'<geom geom="{name}"' + (f' sidesite="{side}"/>' if side else "/>")
        elif name in "23":
            inner += f'<pulley divisor="{name}"/>'
        else:
            inner += f'<site site="{name}"/>'
    stated = " ".join(f'{name}="{value}"' for name, value in attributes.items())
    return f"<spatial {stated}>{inner}</spatial>"


_FIXED = """<fixed name="f" stiffness="30" damping="2"><joint joint="j" coef=".5"/><joint joint="s"
 coef="-2"/></fixed>"""
_MOTOR = '<motor tendon="t" gear="3"/><position tendon="t" kp="40" kv="3" gear="2" group="1"/>'
TENDONS: dict[str, str] = {
    "fixed": file(_FIXED, '<motor tendon="f" gear="-4"/>'),
    "springs at lengths": file(
        path("fix", "one", "two", "end", name="t", stiffness="200", damping="1", springlength=".2 .3"),
        '<velocity tendon="t" kv="5"/>',
    ),
    "sphere": file(path("one", "ball", "two", name="t", stiffness="50"), _MOTOR),
    "sphere with a side": file(path("one", "ball/up", "two", "end", name="t"), _MOTOR),
    "sphere from the other side": file(path("one", "ball/low", "two", name="t"), _MOTOR),
    "within a sphere": file(path("one", "ball/in", "end", name="t"), _MOTOR),
    "cylinder": file(path("two", "roll", "end", name="t", damping="3"), _MOTOR),
    "cylinder with a side": file(path("up", "roll/low", "end", name="t"), _MOTOR),
    "within a cylinder": file(path("two", "roll/core", "end", name="t"), _MOTOR),
    "post in the world": file(path("fix", "post", "one", "ball/up", "two", name="t"), _MOTOR),
    "pulleys": file(path("fix", "one", "2", "one", "ball/up", "two", "3", "nail", "end", name="t"), _MOTOR),
    "armature": file(
        path("fix", "one", "two", "end", "2", "nail", "low", name="t", armature=".6", stiffness="20"), _MOTOR
    ),
    "defaults": file(
        path("fix", "end", name="t", **{"class": "soft"}),
        _MOTOR,
        defaults='<default class="soft"><tendon stiffness="70" damping="2"/></default>',
    ),
    "site": file("", '<motor site="end" gear="1 2 -3 .1 .2 .3"/><general site="two" gear="0 0 1"/>'),
    "site from another": file(
        "",
        '<position site="end" refsite="one" gear="1 2 -3 .1 .2 .3" kp="3" kv=".2"/>'
        '<motor site="two" refsite="fix" gear="0 0 1 0 .5 .5"/>',
    ),
    "muscles": file(
        path("fix", "one", "ball/up", "end", name="t"),
        '<muscle tendon="t" force="60" lengthrange=".3 .6" timeconst=".02 .06"/><muscle joint="k" force="5" '
        'lengthrange="-1 1" range=".6 1.2" lmax="1.4" vmax="3" fpmax="1" fvmax="1.5" tausmooth=".5"/>',
    ),
    "muscles as MuJoCo writes them": file(
        path("fix", "one", "ball/up", "end", name="t"),
        '<general tendon="t" dyntype="muscle" gaintype="muscle" biastype="muscle" lengthrange=".3 .6" '
        'dynprm=".02 .06 .3" gainprm=".75 1.05 60 200 .5 1.6 1.5 1.3 1.2" '
        'biasprm=".75 1.05 60 200 .5 1.6 1.5 1.3 1.2"/>'
        '<general joint="k" dyntype="muscle" gaintype="muscle" biastype="muscle" lengthrange="-1 1" '
        'dynprm=".01 .04" gainprm=".6 1.2 -1 20 .5 1.4 3 1 1.5" biasprm=".6 1.2 -1 30 .5 1.4 3 1 1.5"/>'
        '<general joint="k" dyntype="filter" dynprm=".1" gaintype="muscle" lengthrange="-1 1" '
        'gainprm=".7 1.3 5 200 .5 1.6 1.5 1.3 1.2"/>'
        '<general joint="k" gaintype="muscle" biastype="muscle" lengthrange="-1 1" '
        'gainprm=".7 1.3 5 200 .5 1.6 1.5 1.3 1.2" biasprm=".7 1.3 9 200 .5 1.6 1.5 1.3 1.2"/>',
    ),
    "muscles without a force": file(
        path("fix", "one", "end", name="t"),
        '<muscle tendon="t" lengthrange=".3 .6"/><muscle joint="k" lengthrange="-1 1" scale="20" gear="2"/>',
    ),
}
"""Those of which lengths, velocities and accelerations are compared."""
SENSED = file(
    path("fix", "one", "ball/up", "end", name="t"),
    '<motor name="m" tendon="t"/>',
    '<sensor><tendonpos name="p" tendon="t"/><tendonvel name="v" tendon="t"/><actuatorpos name="ap" '
    'actuator="m"/><actuatorvel name="av" actuator="m"/></sensor>',
)
