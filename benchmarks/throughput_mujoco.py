"""World-steps per second of MuJoCo's `rollout` on threads; `throughput.py` starts it."""

from __future__ import annotations

import sys
import time

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from mujoco import rollout  # pyright: ignore[reportMissingImports]
from mujoco_cases import SETTLING_STEPS, tower_model

WORLDS, STEPS = 256, 50
TIME_STEP = 1 / 240
HOME = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8, 0.02, 0.02]


def panda_model(urdf: str) -> tuple[mujoco.MjModel, np.ndarray]:
    """Our Panda, with position actuators of MuJoCo's own choice, and its targets."""
    spec = mujoco.MjSpec.from_file(urdf)
    spec.option.timestep = TIME_STEP
    joints = [joint for joint in spec.joints if joint.type != mujoco.mjtJoint.mjJNT_FREE]
    for joint in joints:
        actuator = spec.add_actuator()
        actuator.target = joint.name
        actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
        actuator.set_to_position(kp=400.0, kv=40.0)
    return spec.compile(), np.array(HOME[: len(joints)])


def main() -> None:
    """Roll out for some seconds and print how many steps a second all threads make together."""
    case, seconds, threads, urdf = sys.argv[1], float(sys.argv[2]), int(sys.argv[3]), sys.argv[4]
    if case == "panda":
        model, targets = panda_model(urdf)
        settling = 0
    else:
        model, targets, settling = tower_model(3), np.zeros(0), SETTLING_STEPS
    data = [mujoco.MjData(model) for _ in range(threads)]
    for _ in range(settling):
        mujoco.mj_step(model, data[0])
    if case == "panda":
        data[0].qpos[:] = targets
    full = mujoco.mjtState.mjSTATE_FULLPHYSICS
    state = np.empty(mujoco.mj_stateSize(model, full))
    mujoco.mj_getState(model, data[0], state, full)
    states = np.tile(state, (WORLDS, 1))
    control = np.tile(targets, (WORLDS, STEPS, 1)) if len(targets) else None
    with rollout.Rollout(nthread=threads) as runner:
        runner.rollout(model, data, states, control, nstep=STEPS)
        start, steps = time.perf_counter(), 0
        while time.perf_counter() - start < seconds:
            found, _ = runner.rollout(model, data, states, control, nstep=STEPS)
            states = found[:, -1]
            steps += WORLDS * STEPS
        print(steps / (time.perf_counter() - start))


if __name__ == "__main__":
    main()
