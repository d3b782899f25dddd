"""How robots stand after a while in MuJoCo and in Carom: python stand.py (mujoco|bullet|compliant) FILES.

FILES has a path on each line. They start at the first keyframe, or at the reference. Position servos hold the
controls of that. Motors of joints hold the pose: `torque`, found anew before each step. `bullet` and
`compliant` are Carom's kinds of contact. A line of output has the heights of the first free body and how far
it is from upright [rad], after each of `SECONDS`, as JSON.
"""

from __future__ import annotations

import json
import logging
import sys
from pathlib import Path
from typing import Any

import numpy as np

SECONDS = (0.5, 2.0)
YIELD = 0.25
"""How far from its place a joint is when its motor does all it can [rad]; damping is `LAG` times as much."""
LAG = 0.02


def main() -> None:
    side, files = sys.argv[1:3]
    logging.disable(logging.WARNING)
    for file in Path(files).read_text().splitlines():
        try:
            found = in_mujoco(file) if side == "mujoco" else in_carom(file, side)
        except Exception as error:
            found = {"error": str(error).splitlines()[0][:200] if str(error) else type(error).__name__}
        print(json.dumps(found | {"file": file}), flush=True)


def torque(wanted: float, position: float, rate: float, limits: tuple[float, float]) -> float:
    """What a motor does to hold a joint."""
    return float(np.clip(limits[1] / YIELD * (wanted - position - LAG * rate), *limits))


def tilt(w: float, x: float, y: float, z: float) -> float:
    """Angle between a body's z axis and that of the world."""
    return float(np.arccos(np.clip(1.0 - 2.0 * (x * x + y * y), -1.0, 1.0)))


def in_mujoco(file: str) -> dict[str, Any]:
    import mujoco  # pyright: ignore[reportMissingImports]

    model = mujoco.MjModel.from_xml_path(file)
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    motors = []
    for number in range(model.nu):
        joint = model.actuator_trnid[number, 0]
        is_of_joint = model.actuator_trntype[number] == mujoco.mjtTrn.mjTRN_JOINT
        if is_of_joint and not model.actuator_biastype[number] and model.actuator_ctrllimited[number]:
            at, rate = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
            limits = tuple(model.actuator_ctrlrange[number])
            motors.append((number, at, rate, float(data.qpos[at]), limits))
    free = int(model.jnt_qposadr[np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)[0]])
    found: dict[str, Any] = {"heights": [], "tilts": [], "motors": len(motors), "actuators": model.nu}
    for seconds in SECONDS:
        while data.time < seconds - 0.5 * model.opt.timestep:
            for number, at, rate, wanted, limits in motors:
                data.ctrl[number] = torque(wanted, data.qpos[at], data.qvel[rate], limits)
            mujoco.mj_step(model, data)
        found["heights"].append(float(data.qpos[free + 2]))
        found["tilts"].append(tilt(*data.qpos[free + 3 : free + 7]))
    return found


def in_carom(file: str, contact: str) -> dict[str, Any]:
    from carom import World

    with World(contact=contact) as world:
        scene = world.load(file)
        scene.apply_options()
        if keys := scene.keyframes:
            scene.reset(next(iter(keys)))
        joints = {joint.name: joint for body in scene.bodies for joint in body.joints.movable}
        motors = []
        for actuator in scene.actuators.values():
            spec = actuator.spec
            if spec.joint and spec.bias == (0.0, 0.0, 0.0) and np.isfinite(spec.control_range).all():
                joint = joints[spec.joint]
                motors.append((actuator, joint, float(joint.position), spec.control_range))
        base = next(body for body in scene.bodies if not body.fixed_base)
        found: dict[str, Any] = {"heights": [], "tilts": [], "motors": len(motors)}
        found["actuators"] = len(scene.actuators)
        done = 0
        for seconds in SECONDS:
            for _ in range(round(seconds / world.time_step) - done):
                for actuator, joint, wanted, limits in motors:
                    actuator.control = torque(wanted, joint.position, joint.velocity, limits)
                world.step()
            done = round(seconds / world.time_step)
            x, y, z, w = base.pose.orientation
            found["heights"].append(float(base.pose.position[2]))
            found["tilts"].append(tilt(w, x, y, z))
        return found


if __name__ == "__main__":
    main()
