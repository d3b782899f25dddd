"""MJCF files with actuators of ball joints; `record_balls.py` asks MuJoCo what they do."""

_FILE = """<mujoco><option gravity="0 0 0" timestep=".001"><flag contact="disable"/></option><worldbody>
<body name="p" pos="0 0 1" euler="10 0 20"><joint name="h" axis="0 1 0"/><geom size=".1" mass="1"/>
<body name="c" pos=".3 0 0" euler="0 30 0"><joint name="b" type="ball" pos="0 .1 0"/>
<geom type="box" size=".1 .2 .3" mass="2" pos=".2 0 0"/></body></body>
<body name="w" pos="3 0 0"><joint name="u" type="ball"/>
<geom type="box" size=".1 .2 .3" mass="2" pos=".2 0 0"/></body></worldbody><actuator>{}</actuator></mujoco>"""
BALLS = {
    name: _FILE.format(text)
    for name, text in {
        "motor": '<motor name="m" joint="b" gear="1 2 3"/>',
        "motor in the parent": '<motor name="m" jointinparent="b" gear="1 2 3"/>',
        "motor on the world": '<motor name="m" joint="u" gear="1 2 3"/>',
        "motor in the world": '<motor name="m" jointinparent="u" gear="1 2 3"/>',
        "usual gear": '<motor name="m" joint="b"/>',
        "servo": '<position name="m" joint="b" gear=".5 0 1" kp="5" dampratio="1"/>',
        "servo in the world": '<position name="m" jointinparent="u" gear=".5 0 1" kp="5" dampratio=".5"/>',
        "two": '<motor name="m" joint="b"/><velocity name="n" jointinparent="b" gear="0 0 2" kv="3"/>',
    }.items()
}
HINGE, BALL = 0.3, ((0.9, 0.2, -0.1, 0.3), (0.8, -0.3, 0.2, 0.1))
"""Positions of the joints: of the hinge, and of both balls, w first and not of length 1."""
CONTROL = 0.7
