"""MJCF files of the tests, each with a few features; `record_mujoco.py` asks MuJoCo what they mean."""

L_SHAPE = (
    'vertex="0 0 0 2 0 0 2 1 0 1 1 0 1 2 0 0 2 0 0 0 1 2 0 1 2 1 1 1 1 1 1 2 1 0 2 1" '
    'face="0 2 1 0 3 2 0 4 3 0 5 4 6 7 8 6 8 9 6 9 10 6 10 11 0 1 7 0 7 6 1 2 8 1 8 7 2 3 9 2 9 8 3 4 10 '
    '3 10 9 4 5 11 4 11 10 5 0 6 5 6 11"'
)
OPEN = L_SHAPE.removesuffix(' 5 0 6 5 6 11"') + '"'


def body(content: str, before: str = "", attributes: str = "") -> str:
    inside = f'<body name="b" {attributes}><freejoint/>{content}</body>'
    return f"<mujoco>{before}<worldbody>{inside}</worldbody></mujoco>"


def mesh(attributes: str, geom: str = 'type="mesh" density="7"', compiler: str = "") -> str:
    asset = f'{compiler}<asset><mesh name="m" {attributes}/></asset>'
    return body(f'<geom {geom} mesh="m" pos=".1 .2 .3" euler="10 20 30"/>', asset)


_GEOMS = (
    '<geom size=".1" pos="1 2 3" density="500"/><geom type="box" size=".1 .2 .3" euler="10 20 30" mass="2"/>'
    '<geom type="capsule" size=".05" fromto="0 0 0 .1 .2 .3"/>'
    '<geom type="cylinder" size=".2 .3" axisangle="1 1 0 40" group="3"/>'
    '<geom type="ellipsoid" size=".1 .2 .3" xyaxes="1 1 0 -1 1 0"/>'
    '<geom type="box" size=".1" fromto="0 0 0 0 1 0"/>'
)
_STATED = '<inertial pos=".1 .2 .3" quat="1 1 0 0" mass="2" diaginertia=".1 .2 .25"/>'
_TREE = """<mujoco><compiler eulerseq="XYZ"/><default><joint damping=".5"/><default class="arm">
<joint axis="0 1 0" range="-30 60"/><geom size=".1"/></default></default><worldbody><geom type="plane"
 size="1 1 1"/>
<body name="stand" pos="0 0 1" euler="10 20 30"><geom size=".2"/>
 <body name="upper" pos=".3 0 0" childclass="arm"><joint name="one" pos=".1 0 0" ref="20"/>
  <joint name="two" type="slide" pos="0 .2 0" axis="1 0 1" range="-.1 .2"/><joint name="three" axis="0 0
 1"/>
  <geom/><body name="lower" pos="0 0 .4" quat="1 .1 .2 .3"><joint class="main" name="four" type="ball"
 pos="0 0 .05"/>
  <geom fromto="0 0 0 .2 .3 .1" type="capsule"/><body name="tip" pos=".2 0
 0"><geom/></body></body></body></body>
<body name="cart"><joint name="rail" type="slide" axis="1 0 0"/><geom size=".3"/></body>
<body name="ball" pos="1 2 3"><freejoint/><geom size=".1" pos=".1 0 0"/></body>
<body name="hand" mocap="true" pos="3 0 0"><geom size=".1" contype="0"
 conaffinity="0"/></body></worldbody></mujoco>"""
_COPIES = """<mujoco><worldbody><frame pos="0 0 1" euler="0 0 30"><body name="in" pos="1 0 0"><geom
 size=".1"/>
<frame pos="0 1 0"><body name="deep"><joint axis="1 0 0"/><geom size=".2" pos="0 .1
 0"/></body></frame></body></frame>
<replicate count="3" offset="1 0 .1" euler="0 0 40" sep="-"><body name="r" pos="0 .5 0"><joint name="j"/>
<geom size=".1"/></body></replicate></worldbody></mujoco>"""

CASES: dict[str, str] = {
    "geoms": body(_GEOMS),
    "groups": body(_GEOMS, '<compiler inertiagrouprange="1 3"/>'),
    "stated": body(_STATED + _GEOMS),
    "stated is ignored": body(_STATED + _GEOMS, '<compiler inertiafromgeom="true"/>'),
    "geoms are ignored": body(_STATED + _GEOMS, '<compiler inertiafromgeom="false"/>'),
    "full tensor": body('<inertial pos="0 0 1" mass="3" fullinertia=".2 .3 .4 .01 .02 .03"/>'),
    "balanced": body(
        '<inertial pos="0 0 0" mass="1" diaginertia="1 2 9"/>', '<compiler balanceinertia="true"/>'
    ),
    "bounded": body('<geom size=".01"/>', '<compiler boundmass=".5" boundinertia=".1"/>'),
    "total mass": _TREE.replace("<compiler", '<compiler settotalmass="7"'),
    "radians": body('<geom type="box" size=".1 .2 .3" euler="1 2 3"/>', '<compiler angle="radian"/>'),
    "shells": body(
        "".join(
            f'<geom type="{kind}" size=".1 .2 .3" pos="{x} 0 0" density="3" shellinertia="true"/>'
            for x, kind in enumerate(("sphere", "box", "cylinder", "capsule"))
        )
    ),
    "mesh": mesh(L_SHAPE),
    "mesh, exact": mesh(f'{L_SHAPE} inertia="exact" scale="1 2 -3"'),
    "mesh, convex": mesh(f'{L_SHAPE} inertia="convex"'),
    "mesh, shell": mesh(f'{L_SHAPE} inertia="shell"'),
    "open mesh, legacy": mesh(f'{OPEN} inertia="legacy"'),
    "open mesh, exact": mesh(f'{OPEN} inertia="exact"'),
    "mesh, moved": mesh(f'{L_SHAPE} refpos="1 2 3" refquat="1 1 0 .5" scale="1 2 3"'),
    "mesh, points": mesh(L_SHAPE.partition(" face")[0]),
    "mesh, stated mass": mesh(L_SHAPE, 'type="mesh" mass="2"'),
    **{
        f"{kind} fitted to {way or 'inertia'}": mesh(
            L_SHAPE, f'type="{kind}"', f'<compiler fitaabb="{"true" if way else "false"}"/>'
        )
        for kind in ("sphere", "capsule", "cylinder", "ellipsoid", "box")
        for way in ("", "bounds")
    },
    "cone": mesh('builtin="cone" params="6 .5"'),
    "sphere": mesh('builtin="sphere" params="1"'),
    "hemisphere": mesh('builtin="hemisphere" params="2"'),
    "supersphere": mesh('builtin="supersphere" params="7 .5 1.5"'),
    "supertorus": mesh('builtin="supertorus" params="5 .3 .5 1.5"'),
    "tree": _TREE,
    "copies": _COPIES,
}
