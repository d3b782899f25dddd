"""MJCF files with flexes on bodies, rigid ones, and skins; `record_deformables.py` asks MuJoCo."""

STILL = '<contact contype="0" conaffinity="0"/>'
_SLIDERS = "".join(f'<joint type="slide" axis="{axis}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1"))


def node(name: str, place: str, mass: float, inside: str = "") -> str:
    """A body that slides along three axes."""
    inertial = f'<inertial pos="0 0 0" mass="{mass}" diaginertia="1e-4 1e-4 1e-4"/>'
    return f'<body name="{name}" pos="{place}">{inertial}{_SLIDERS}{inside}</body>'


def _file(step: str, bodies: str, flex: str, equality: str = "") -> str:
    return (
        f'<mujoco><option timestep="{step}"/><worldbody>{bodies}</worldbody>'
        f"<deformable>{flex}</deformable>{equality}</mujoco>"
    )


_MASSES = (0.1, 0.25, 0.1, 0.05, 0.1, 0.3, 0.1)
_CABLE = "".join(node(f"n{k}", f"{0.1 * (k + 1):.1f} 0 2", mass) for k, mass in enumerate(_MASSES))
_ENDS = '<body name="left" pos="0 0 2"/><body name="right" pos=".7 0 2"/>'
_LINKS = " ".join(f"{k} {k + 1}" for k in range(8))
_CABLE_BODIES = "left n0 n1 n2 n3 n4 n5 n6 right"
_AT_ENDS = 'vertex="' + "0 0 0 " * 8 + '.1 0 0"'
_GRID = [(i, j) for i in range(4) for j in range(3)]
_CLOTH = "".join(
    node(f"c{i}{j}", f"{0.1 * i:.1f} {0.1 * j:.1f} 1", 0.02 + 0.01 * ((i + j) % 2)) for i, j in _GRID if i
)
_CLOTH_BODIES = " ".join(f"c{i}{j}" if i else "world" for i, j in _GRID)
_CLOTH_VERTICES = " ".join("0 0 0" if i else f"0 {0.1 * j:.1f} 1" for i, j in _GRID)
_CLOTH_CELLS = " ".join(
    f"{3 * i + j} {3 * i + j + 3} {3 * i + j + 4} {3 * i + j} {3 * i + j + 4} {3 * i + j + 1}"
    for i in range(3)
    for j in range(2)
)
_BAR = [(i, j, k) for i in range(5) for j in range(2) for k in range(2)]
_BAR_NODES = "".join(
    node(f"b{i}{j}{k}", f"{0.05 * i:.2f} {0.05 * j:.2f} {1 + 0.05 * k:.2f}", 0.02) for i, j, k in _BAR if i
)
_BAR_CELLS = " ".join(
    " ".join(str(4 * i + corner) for corner in cell)
    for i in range(4)
    for cell in ((0, 4, 6, 7), (0, 6, 2, 7), (0, 2, 3, 7), (0, 3, 1, 7), (0, 1, 5, 7), (0, 5, 4, 7))
)
_BAR_BODIES = " ".join(f"b{i}{j}{k}" if i else "wall" for i, j, k in _BAR)
_BAR_VERTICES = " ".join("0 0 0" if i else f"0 {0.05 * j:.2f} {0.05 * k:.2f}" for i, j, k in _BAR)

RESTING = {
    "cable of springs": _file(
        "1e-3",
        _ENDS + _CABLE,
        f'<flex name="f" dim="1" body="{_CABLE_BODIES}" {_AT_ENDS} element="{_LINKS}">'
        f'<edge stiffness="400" damping="1"/>{STILL}</flex>',
    ),
    "cable of constraints": _file(
        "1e-3",
        _ENDS + _CABLE,
        f'<flex name="f" dim="1" body="{_CABLE_BODIES}" {_AT_ENDS} element="{_LINKS}">'
        f'<edge damping=".5"/>{STILL}</flex>',
        '<equality><flex flex="f"/></equality>',
    ),
    "cloth of constraints": _file(
        "1e-3",
        _CLOTH,
        f'<flex name="f" dim="2" body="{_CLOTH_BODIES}" vertex="{_CLOTH_VERTICES}" element="{_CLOTH_CELLS}">'
        f'<edge damping=".5"/>{STILL}</flex>',
        '<equality><flex flex="f"/></equality>',
    ),
    "beam": _file(
        "2e-4",
        '<body name="wall" pos="0 0 1"><geom type="box" size=".01 .1 .1" contype="0" conaffinity="0"/></body>'
        + _BAR_NODES,
        f'<flex name="f" dim="3" body="{_BAR_BODIES}" vertex="{_BAR_VERTICES}" element="{_BAR_CELLS}">'
        f'<elasticity young="3e5" poisson=".3"/>{STILL}</flex>',
    ),
}
"""Flexes that come to rest, as nothing but gravity acts on them."""
STEPS, KEPT = 6000, 0.995
"""So many steps are made, after each of which this share of velocities is kept."""

_RIGID = (
    '<mujoco><worldbody><geom type="plane" size="2 2 .1"/><body name="p" pos="0 0 .3" euler="4 3 0">'
    '<freejoint/><inertial pos=".12 .1 .05" mass="1" diaginertia=".01 .01 .01"/>{}</body></worldbody>{}'
    "</mujoco>"
)
_POINTS = "0 0 0 .3 0 0 0 .3 0 .3 .3 0 0 0 .2"
_ELEMENTS = {1: "0 1 1 3 3 2 2 0", 2: "0 1 2 1 3 2", 3: "0 1 2 4 1 3 2 4"}
RIGID = {
    f"flex {dim}": _RIGID.format(
        "",
        f'<deformable><flex name="f" dim="{dim}" body="p" vertex="{_POINTS}" element="{cells}" radius=".02"/>'
        "</deformable>",
    )
    for dim, cells in _ELEMENTS.items()
} | {
    "flexcomp": _RIGID.format(
        '<flexcomp name="f" type="direct" dim="2" rigid="true" point=".3 0 0 0 .3 0 .3 .3 0 0 0 0" '
        'element="3 0 1 0 2 1" radius=".03"/>',
        "",
    )
}
"""Bodies whose shape is a flex, which fall on a plane."""
FALL = 4000

SKIN = """<mujoco>
  <asset>
    <texture name="halves" type="2d" builtin="checker" width="2" height="2" rgb1="1 0 0" rgb2="0 0 1"/>
    <material name="plain" rgba="0 1 0 1"/><material name="halves" texture="halves"/>
  </asset>
  <worldbody>
    <body name="a" pos="0 0 1"><joint name="j" axis="0 1 0"/><geom size=".02" contype="0" conaffinity="0"/>
      <body name="b" pos=".4 0 0" euler="0 0 30"><joint name="k" axis="0 1 0"/><geom size=".02"/></body>
    </body>
    <body name="c" pos="0 1 1"><freejoint/><geom size=".02"/></body>
  </worldbody>
  <deformable>
    <skin name="s" material="{}" inflate="{}" texcoord="0 0 .5 0 1 0 0 1 .5 1 1 1" {}
      vertex="0 -.1 1.05 .4 -.1 1.05 .8 -.1 1.05 0 .1 1.05 .4 .1 1.05 .8 .1 1.05"
      face="0 1 3 1 4 3 1 2 4 2 5 4">
      <bone body="a" bindpos="0 0 1" bindquat="2 0 0 0" vertid="0 1 3 4" vertweight="1 .5 1 .5"/>
      <bone body="b" bindpos=".4 0 1" bindquat=".9659258 0 0 .258819" vertid="1 2 4 5"
        vertweight="1.5 1 .5 1"/>
      <bone body="c" bindpos="0 1 1" bindquat="1 0 0 0" vertid="5" vertweight=".5"/>
      <bone body="world" bindpos="0 0 0" bindquat="1 0 0 0" vertid="3" vertweight=".25"/>
    </skin>
  </deformable>
</mujoco>"""
SKINS = {"plain": SKIN.format("plain", "0", ""), "inflated": SKIN.format("plain", ".05", "")}
AT = (0.3, 0.7, 0.1, 1.2, 0.9, 0.8, 0.6, 0.0, 0.0)
"""Positions of the joints of the file, in the order of MuJoCo."""
