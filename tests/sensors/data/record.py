"""Records what MuJoCo 4.0.0 measures of the scenes beside this file: `python record.py` writes mujoco.json.

Kinematics and loads of the arm are those of `mj_forward` for three states; those of the box, which rests on
a plane, are of a step.
"""

from __future__ import annotations

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]

FOLDER = Path(__file__).parent
STATES = (
    ([0.3, 0.2], [1.0, -0.5], [0.4, 0.5]),
    ([-1.1, 0.6], [-3.0, 2.5], [-1.5, -0.3]),
    ([0.5, 0.75], [0.2, 0.4], [0.0, 0.0]),
)
OF_SITES = ("gyro", "accelerometer", "velocimeter", "force", "torque", "magnetometer")
OF_FRAMES = ("framepos", "framequat", "framexaxis", "frameyaxis", "framezaxis", "framelinvel", "frameangvel")
ARM = """
<mujoco><option timestep="0.0001"/><worldbody>
<body name="mount" pos="0 0 1"><geom type="sphere" size="0.01" mass="0.1" contype="0" conaffinity="0"/>
<body name="arm"><joint name="shoulder" axis="0 1 0"/>
<inertial pos="0.1 0 -0.2" mass="1.5" diaginertia="0.02 0.03 0.01"/>
<site name="s_arm" pos="0.05 0.02 -0.1" quat="0.5 0.5 -0.1 0.7"/>
<body name="fore" pos="0 0 -0.4" euler="0 0 30"><joint name="elbow" axis="1 0 0" range="-20 40"/>
<inertial pos="0 0.02 -0.15" mass="0.7" diaginertia="0.01 0.012 0.004"/>
<site name="s_fore" pos="0.01 0.02 -0.3" quat="0.9 -0.2 0.3 0.1"/>
<body name="tool" pos="0 0 -0.3" euler="0 15 0">
<inertial pos="0 0 -0.05" mass="0.2" diaginertia="0.001 0.001 0.0005"/>
<site name="s_tool" pos="0.01 0 0.02" quat="0.7 0.1 0.6 0.2"/>
</body></body></body></body></worldbody>
<actuator><motor name="m1" joint="shoulder" gear="2"/><motor name="m2" joint="elbow"/></actuator>
<sensor>%s</sensor></mujoco>
"""
BOX = """
<mujoco><option timestep="0.0002" cone="elliptic" impratio="100"/><worldbody>
<geom type="plane" size="5 5 1" friction="0.2 0 0"/>
<body name="box" pos="0 0 0.02"><freejoint/>
<geom type="box" size="0.2 0.15 0.02" mass="2" friction="0.2 0 0" solref="0.01 1"/>
<site name="imu" pos="0.02 0.03 0.01" quat="0.7 0.1 0.6 0.2"/>
<site name="skin" type="box" size="0.21 0.16 0.03"/>
<site name="half" type="box" pos="0.2 0 -0.02" size="0.05 0.2 0.01"/>
<site name="eye" pos="0 0 0.01" quat="0 1 0 0"/>
</body></worldbody>
<sensor>
<accelerometer name="accelerometer imu" site="imu"/><gyro name="gyro imu" site="imu"/>
<velocimeter name="velocimeter imu" site="imu"/>
<touch name="touch skin" site="skin"/><touch name="touch half" site="half"/>
<rangefinder name="rangefinder eye" site="eye"/>
</sensor></mujoco>
"""


def arm_sensors() -> str:
    """The sensors of the arm: their names are kind, object and, for relative ones, `rel`."""
    lines = ['<clock name="clock"/>']
    for site in ("s_arm", "s_fore", "s_tool"):
        lines += [f'<{kind} name="{kind} {site}" site="{site}"/>' for kind in OF_SITES]
        for kind in (*OF_FRAMES, "framelinacc", "frameangacc"):
            lines.append(f'<{kind} name="{kind} {site}" objtype="site" objname="{site}"/>')
        for kind in OF_FRAMES:
            relative = 'reftype="xbody" refname="arm"'
            lines.append(f'<{kind} name="{kind} {site} rel" objtype="site" objname="{site}" {relative}/>')
    for joint in ("shoulder", "elbow"):
        for kind in ("jointpos", "jointvel", "jointactuatorfrc"):
            lines.append(f'<{kind} name="{kind} {joint}" joint="{joint}"/>')
    for kind in ("jointlimitpos", "jointlimitvel"):
        lines.append(f'<{kind} name="{kind} elbow" joint="elbow"/>')
    for actuator in ("m1", "m2"):
        for kind in ("actuatorpos", "actuatorvel", "actuatorfrc"):
            lines.append(f'<{kind} name="{kind} {actuator}" actuator="{actuator}"/>')
    for body in ("arm", "fore"):
        for kind in ("subtreecom", "subtreelinvel", "subtreeangmom"):
            lines.append(f'<{kind} name="{kind} {body}" body="{body}"/>')
    return "".join(lines)


def measurements(model: mujoco.MjModel, data: mujoco.MjData) -> dict[str, list[float]]:
    """All sensors by name."""
    return {model.sensor(i).name: data.sensor(i).data.tolist() for i in range(model.nsensor)}


def record() -> dict[str, object]:
    """The measurements of both scenes."""
    model = mujoco.MjModel.from_xml_string(ARM % arm_sensors())
    arm = []
    for positions, velocities, controls in STATES:
        data = mujoco.MjData(model)
        data.qpos[:], data.qvel[:], data.ctrl[:] = positions, velocities, controls
        mujoco.mj_forward(model, data)
        values = measurements(model, data)
        arm.append({"q": positions, "v": velocities, "control": controls, "sensors": values})
    model = mujoco.MjModel.from_xml_string(BOX)
    data = mujoco.MjData(model)
    box = {}
    for time in (0.5,):
        while data.time < time - 1e-9:
            mujoco.mj_step(model, data)
        box[str(time)] = measurements(model, data)
    return {"mujoco": mujoco.__version__, "arm": arm, "box": box}


if __name__ == "__main__":
    (FOLDER / "mujoco.json").write_text(json.dumps(record(), indent=1) + "\n", encoding="utf-8")
