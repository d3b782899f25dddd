"""Small MJCF files whose motion MuJoCo and Carom compute with each integrator; MuJoCo's is recorded."""

from __future__ import annotations

INTEGRATORS = ("discrete", "Euler", "explicit", "implicitfast", "implicit", "RK4")
STEPS = 200


def file_of(scene: str, integrator: str) -> str:
    """The file of a scene, which names an integrator; "explicit" is Euler without implicit damping."""
    named = "Euler" if integrator == "explicit" else integrator
    damping = ' eulerdamp="disable"' if integrator == "explicit" else ""
    contact = "" if scene in TOUCHING else ' contact="disable"'
    option = f'<option timestep="0.002" integrator="{named}"><flag{contact}{damping}/></option>'
    return f"<mujoco>{option}{SCENES[scene]}</mujoco>"


TOUCHING = ("falling off its frame",)
"""Scenes with contacts."""
_OFF_FRAME = """<body name="trunk" pos="0 0 {height}" euler="10 20 30"><freejoint/>
    <site name="s" pos="0.1 0.2 0.1"/>
    <geom type="box" pos="0.08 -0.05 0.12" euler="20 0 40" size="0.1 0.06 0.04" mass="1"/>
    <geom type="sphere" pos="0.03 0.02 -0.02" size="0.05" mass="0.2"/>
    <body pos="0.1 0 0"><joint name="a" axis="0 1 0" damping="0.05"/>
    <geom type="capsule" fromto="0 0 0 0.2 0 0" size="0.02" mass="0.4"/>
    <body name="hand" pos="0.2 0 0"><joint name="b" axis="0 0 1" damping="0.05" {limit}/>
    <geom type="capsule" fromto="0 0 0 0.2 0 0.05" size="0.02" mass="0.3"/></body></body></body>"""
_LIMIT = 'range="-20 40"'
_STIRRED = '<keyframe><key qvel="0.4 -0.3 0.2 3 2 -4 1 -1"/></keyframe>'
_LEGS = """
    <body pos="0 0 1"><joint name="a" type="hinge" axis="0 1 0" damping="0.02"/>
      <geom type="capsule" fromto="0 0 0 0 0 -0.3" size="0.03" mass="1"/>
      <body pos="0 0 -0.3"><joint name="b" axis="1 0 0" damping="0.3" stiffness="2" armature="0.01"/>
        <geom type="capsule" fromto="0 0 0 0.2 0 -0.2" size="0.03" mass="0.6"/>
        <body pos="0.2 0 -0.2"><joint name="c" type="slide" axis="1 0 1" damping="4" stiffness="200"/>
          <geom type="box" size="0.05 0.03 0.02" mass="0.4"/></body></body>
      <body pos="0 0.1 -0.3"><joint name="d" type="hinge" axis="0 1 0" damping="0.1"/>
        <geom type="capsule" fromto="0 0 0 0 0.1 -0.2" size="0.02" mass="0.5"/></body></body>
"""

SCENES = {
    "free body": """<worldbody><body pos="0 0 1"><freejoint/>
        <geom type="box" size="0.1 0.2 0.05" mass="1"/></body></worldbody>
        <keyframe><key qvel="0.3 -0.2 1 0.4 5 -2"/></keyframe>""",
    "pendulum": """<worldbody><body pos="0 0 1"><joint axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.5" size="0.02" mass="1"/></body></worldbody>
        <keyframe><key qpos="1.2" qvel="2"/></keyframe>""",
    "three pendulums": """<worldbody><body pos="0 0 2"><joint axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.4" size="0.02" mass="1"/>
        <body pos="0 0 -0.4"><joint axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.3" size="0.02" mass="0.5"/>
        <body pos="0 0 -0.3"><joint axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.5" size="0.02" mass="0.8"/></body></body></body></worldbody>
        <keyframe><key qpos="1 0.5 -0.4" qvel="0 1 0"/></keyframe>""",
    "ball and chain": """<worldbody><body pos="0 0 2"><joint type="ball" damping="0.05"/>
        <geom type="box" pos="0.05 0 -0.2" size="0.05 0.1 0.2" mass="1"/>
        <body pos="0 0 -0.4"><joint axis="1 0 0" damping="0.1"/>
        <geom type="capsule" fromto="0 0 0 0 0.1 -0.3" size="0.02" mass="0.5"/></body></body></worldbody>
        <keyframe><key qpos="0.9238795325112867 0.3826834323650898 0 0 0.4" qvel="1 3 4 -2"/></keyframe>""",
    "free chain": """<worldbody><body pos="0 0 1"><freejoint/>
        <geom type="box" size="0.1 0.06 0.04" mass="1"/>
        <body pos="0.1 0 0"><joint name="a" axis="0 1 0" damping="0.05"/>
        <geom type="capsule" fromto="0 0 0 0.2 0 0" size="0.02" mass="0.4"/>
        <body pos="0.2 0 0"><joint name="b" axis="0 0 1" damping="0.05"/>
        <geom type="capsule" fromto="0 0 0 0.2 0 0.05" size="0.02" mass="0.3"/>
        </body></body></body></worldbody>
        <actuator><motor joint="a" gear="2"/><motor joint="b"/></actuator>
        <keyframe><key qvel="0 0 1 0.5 1 -2 1 -1" ctrl="0.2 -0.1"/></keyframe>""",
    "damped limbs": f"""<worldbody>{_LEGS}</worldbody>
        <keyframe><key qpos="0.5 0.3 0.02 -0.4" qvel="1 -2 0.3 4"/></keyframe>""",
    "servos": f"""<worldbody>{_LEGS}</worldbody>
        <actuator><position joint="a" kp="40" kv="3"/><velocity joint="b" kv="0.5" gear="2"/>
        <motor joint="c" gear="3"/><position joint="d" kp="30" kv="1" forcerange="-2 2"/>
        <intvelocity joint="a" kp="5" actrange="-1 1"/>
        <general joint="d" dyntype="filter" dynprm="0.05" gainprm="3" biastype="affine" biasprm="0 0 -0.2"/>
        <general joint="b" dyntype="filterexact" dynprm="0.03" gainprm="2"/></actuator>
        <keyframe><key qpos="0.5 0.3 0.02 -0.4" qvel="1 -2 0.3 4"
        ctrl="0.2 1 -1 0.5 0.8 1 -0.5"/></keyframe>""",
    "tendons": f"""<worldbody>{_LEGS}<site name="w" pos="0.2 0 1"/></worldbody>
        <tendon><fixed name="t" damping="0.6" stiffness="5" springlength="0.1"><joint joint="a" coef="1"/>
        <joint joint="b" coef="-0.5"/></fixed>
        <fixed name="u" damping="0.4"><joint joint="a" coef="0.4"/><joint joint="d" coef="0.7"/></fixed>
        </tendon>
        <actuator><position tendon="t" kp="10" kv="1"/></actuator>
        <keyframe><key qpos="0.5 0.3 0.02 -0.4" qvel="1 -2 0.3 4" ctrl="0.3"/></keyframe>""",
    "lone body off its frame": """<worldbody><body pos="0 0 1"><freejoint/>
        <geom type="box" pos="0.1 0.02 -0.07" size="0.1 0.2 0.05" mass="1"/></body></worldbody>
        <keyframe><key qvel="0.3 -0.2 1 0.4 5 -2"/></keyframe>""",
    "chain off its frame": f"<worldbody>{_OFF_FRAME.format(height=1, limit=_LIMIT)}</worldbody>{_STIRRED}",
    "tied off its frame": f"""<worldbody>{_OFF_FRAME.format(height=1, limit=_LIMIT)}</worldbody>
        <equality><connect body1="trunk" anchor="0.1 0.1 0"/></equality>
        <keyframe><key qvel="0.2 -0.3 0.2 3 2 -4 1 -1"/></keyframe>""",
    "welded off its frame": f"""<worldbody>{_OFF_FRAME.format(height=1, limit=_LIMIT)}</worldbody>
        <equality><weld body1="hand" relpose="0.3 0 0.9 1 0 0 0"/></equality>{_STIRRED}""",
    "falling off its frame": f"""<worldbody><geom type="plane" size="0 0 1"/>
        {_OFF_FRAME.format(height=0.2, limit=_LIMIT)}</worldbody>{_STIRRED}""",
    "hung off its frame": f"""<worldbody><site name="w" pos="0.5 0.2 1.5"/>
        {_OFF_FRAME.format(height=1, limit="")}</worldbody>
        <tendon><spatial armature="0.5" stiffness="20" damping="0.3">
        <site site="w"/><site site="s"/></spatial></tendon>{_STIRRED}""",
    "servos at bounds": """<worldbody><body pos="0 0 1">
        <joint name="a" axis="0 1 0" damping="0.1" actuatorfrcrange="-3 3"/>
        <geom type="capsule" fromto="0 0 0 0.2 0 -0.2" size="0.03" mass="1"/>
        <body pos="0.2 0 -0.2"><joint name="b" axis="0 1 0" damping="0.05" actuatorfrcrange="-1 1"/>
        <geom type="capsule" fromto="0 0 0 0.2 0 -0.1" size="0.03" mass="0.5"/>
        <body pos="0.2 0 -0.1"><joint name="c" axis="0 1 0" armature="0.01"/>
        <geom type="capsule" fromto="0 0 0 0.1 0 -0.1" size="0.02" mass="0.2"/></body></body></body>
        </worldbody>
        <tendon><fixed name="t" actuatorfrcrange="-0.4 0.4"><joint joint="c" coef="0.8"/></fixed></tendon>
        <actuator><position joint="a" kp="40" kv="2"/><position joint="b" kp="30" kv="1"/>
        <velocity joint="b" kv="0.4" gear="2"/><position tendon="t" kp="8" kv="0.5"/></actuator>
        <keyframe><key qpos="0.5 0.3 -0.4" qvel="1 -2 3" ctrl="-0.2 0.6 0.5 0.3"/></keyframe>""",
}
