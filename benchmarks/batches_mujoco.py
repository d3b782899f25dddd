"""World-steps per second of `mujoco.batch`; `batches.py` starts it."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import mjcf_scenes
import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from mujoco.batch import Batch  # pyright: ignore[reportMissingImports]
from mujoco_cases import SETTLING_STEPS, tower_model

TIME_STEP = 1 / 240
CHECKED_STEPS, CHECKED_CHANGE = 60, 0.1
HOME = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8, 0.02, 0.02]


def panda_model(path: Path) -> mujoco.MjModel:
    """Our Panda, with position actuators as those of `batches.py`."""
    spec = mujoco.MjSpec.from_file(str(path))
    spec.option.timestep = TIME_STEP
    for joint in spec.joints:
        servo = spec.add_actuator()
        servo.target, servo.trntype = joint.name, mujoco.mjtTrn.mjTRN_JOINT
        servo.set_to_position(kp=400.0, kv=40.0)
    # Links of the arm do not collide with each other on the other side either.
    for geom in spec.geoms:
        geom.contype = geom.conaffinity = 0
    return spec.compile()


def legged_model(path: Path, strength: float) -> mujoco.MjModel:
    """A robot of a file on a floor, with a motor at each of its hinges."""
    spec = mujoco.MjSpec.from_file(str(path))
    spec.option.timestep = TIME_STEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    if not any(geom.type == mujoco.mjtGeom.mjGEOM_PLANE for geom in spec.geoms):
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], contype=1, conaffinity=1)
    for joint in spec.joints:
        if joint.type == mujoco.mjtJoint.mjJNT_HINGE:
            motor = spec.add_actuator()
            motor.target, motor.trntype = joint.name, mujoco.mjtTrn.mjTRN_JOINT
            motor.set_to_motor()
            motor.gear[0] = strength
    return spec.compile()


def coordinates_after(model: mujoco.MjModel, controls: np.ndarray, steps: int) -> list[float]:
    """The heights of free bodies, or the coordinates of an arm, after some steps with controls that stay."""
    data = mujoco.MjData(model)
    is_arm = model.nu == model.nq
    if is_arm:
        data.qpos[:] = controls
        data.ctrl[:] = controls + CHECKED_CHANGE
    mujoco.mj_step(model, data, steps)
    free = [
        address + 2
        for address, kind in zip(model.jnt_qposadr, model.jnt_type, strict=True)
        if kind == mujoco.mjtJoint.mjJNT_FREE
    ]
    return data.qpos.tolist() if is_arm else data.qpos[free].tolist()


def main() -> None:
    """Step for some seconds and print how many steps a second all threads make together.

    With 0 steps a call it prints coordinates after some steps instead, which the other side has to have, too.
    """
    case, seconds, threads, steps, count = sys.argv[1], float(sys.argv[2]), *map(int, sys.argv[3:6])
    data = Path(sys.argv[6])
    generator = np.random.default_rng(0)
    if case == "panda":
        model = panda_model(data / "franka_panda" / "panda.urdf")
        middle, amount = np.array(HOME), 0.2
    elif case in mjcf_scenes.SCENES:
        model = mujoco.MjModel.from_xml_string(mjcf_scenes.SCENES[case]())
        around, amount = mjcf_scenes.CONTROLS.get(case, (0.0, 0.0))
        middle = np.full(model.nu, around)
    elif case == "boxes":
        model, middle, amount = tower_model(3), np.zeros(0), 0.0
    else:
        model, amount = legged_model(data / "mjcf" / f"{case}.xml", float(sys.argv[7])), 1.0
        middle = np.zeros(model.nu)
    if steps == 0:
        print(*coordinates_after(model, middle, CHECKED_STEPS))
        return
    batch = Batch(model, count, threads, persistent=True)
    if case == "panda":
        batch.bind("qpos")[:] = middle
    if case == "boxes":
        batch.step(nstep=SETTLING_STEPS)
    controls = batch.bind("ctrl")
    began, done = 0.0, 0
    for turn in range(1_000_000):
        if turn == 5:
            began, done = time.perf_counter(), 0
        elif turn > 5 and time.perf_counter() - began > seconds:
            break
        if len(middle):
            controls[:] = middle + generator.uniform(-amount, amount, controls.shape)
        batch.step(nstep=steps)
        done += count * steps
    print(done / (time.perf_counter() - began))


if __name__ == "__main__":
    main()
