"""An MJCF file with cameras that follow bodies; `record_cameras.py` asks MuJoCo what they see."""

_FILE = """<mujoco><worldbody><geom type="plane" size="1 1 1" pos="0 0 -9"/>
<body name="t" pos="1 0 .2" euler="10 0 0"><freejoint/><inertial mass="1" pos=".1 .2 .3" diaginertia="1 1 1"/>
<geom size=".1"/><body name="c" pos=".3 0 0"><joint name="j" axis="0 0 1"/><geom size=".1" pos=".1 0 0"/>
<camera name="inside" {inside} pos="0 0 .3"/></body></body>
<camera name="still" pos="0 0 1" euler="20 30 0" {still}/>
<body name="m" pos="2 2 2" euler="0 0 30"><joint name="k" axis="1 0 0"/><geom size=".1" pos="0 .2 0"/>
<camera name="held" pos=".1 .2 .3" euler="20 30 10" {held}/></body></worldbody></mujoco>"""


def file(inside: str, still: str, held: str) -> str:
    return _FILE.format(inside=inside, still=still, held=held)


CAMERAS = {
    "targets": file(
        'mode="targetbody" target="m"',
        'mode="targetbody" target="t"',
        'mode="targetbodycom" target="t"',
    ),
    "tracking": file('mode="track"', 'mode="track"', 'mode="track" target="t"'),
    "tracking centres": file('mode="trackcom"', 'mode="trackcom"', 'mode="trackcom"'),
    "the world": file("", 'mode="targetbodycom" target="world"', 'mode="targetbody" target="world"'),
    "nothing": file('mode="targetbody"', 'mode="targetbodycom"', 'target="t"'),
}
MOVED = ((0.3, 0.4, -0.2), (0.9, 0.1, 0.3, -0.2), 0.5, 0.7)
"""What the free body moves by, its quaternion, w first, and the positions of the joints."""
