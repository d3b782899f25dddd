"""What MuJoCo says of MJCF files: python ask_mujoco.py FILES ANSWERS, with mujoco and numpy only.

FILES has a path on each line. A line of ANSWERS is the answer for one file, as JSON: what `ask_carom.py`
compares. Files that are in ANSWERS already are left out, so it can be run again after a crash.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np

STATES = 3
MAX_DOFS = 250
SECONDS = 1.0
APART = 1e-12
"""How far velocities of another rollout with everything are from those of the first [rad/s or m/s]."""
STEP = 1e-8
OFF = ("CONTACT", "LIMIT", "FRICTIONLOSS", "EQUALITY")


def main() -> None:
    files, answers = map(Path, sys.argv[1:3])
    done = [json.loads(line) for line in answers.read_text().splitlines()] if answers.exists() else []
    known = {each["file"] for each in done}
    for file in files.read_text().splitlines():
        if file in known:
            continue
        # A file at which the interpreter dies is left out by the next run.
        with answers.open("a") as out:
            out.write(json.dumps({"file": file, "error": "MuJoCo crashed"}) + "\n")
        before = answers.read_text().splitlines()[:-1]
        begin = time.process_time()
        try:
            answer = answered(file)
        except Exception as error:
            answer = {"error": str(error).splitlines()[0][:200] if str(error) else type(error).__name__}
        answer |= {"file": file, "seconds": time.process_time() - begin}
        answers.write_text("\n".join([*before, json.dumps(answer)]) + "\n")


def answered(file: str) -> dict[str, Any]:
    begin = time.process_time()
    model = mujoco.MjModel.from_xml_path(file)
    answer: dict[str, Any] = {"load_seconds": time.process_time() - begin}
    answer |= structure(model)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    answer["poses"] = poses(model, data)
    if not 0 < model.nv <= MAX_DOFS:
        return answer
    answer["rollout"] = rollout(model, data)
    answer["apart"] = grown(answer["rollout"], rollout(model, data, APART))
    flags = model.opt.disableflags
    for name in OFF:
        model.opt.disableflags |= getattr(mujoco.mjtDisableBit, f"mjDSBL_{name}")
    answer["alone"] = rollout(model, data)
    answer["states"] = [state(model, data, seed) for seed in range(STATES)]
    model.opt.disableflags = flags
    return answer


def structure(model: Any) -> dict[str, Any]:
    """Names and masses of bodies, and names and kinds of joints, in the order of the file."""
    return {
        "bodies": [model.body(i).name for i in range(1, model.nbody)],
        "masses": model.body_mass[1:].tolist(),
        "moves": moves(model)[1:].tolist(),
        "joints": [[model.joint(i).name, int(model.jnt_type[i])] for i in range(model.njnt)],
        "actuators": [[model.actuator(i).name, bool(model.actuator_dyntype[i])] for i in range(model.nu)],
        "sensors": [
            [model.sensor(i).name, int(model.sensor_adr[i]), int(model.sensor_dim[i]), int(kind)]
            for i, kind in enumerate(model.sensor_type)
        ],
        "sizes": {name: int(getattr(model, name)) for name in ("nq", "nv", "nu", "na", "neq", "ntendon")},
        "timestep": model.opt.timestep,
        "total": float(model.body_mass[moves(model)].sum()),
    }


def moves(model: Any) -> np.ndarray:
    """Whether a force can move each body: not the world, what is fixed to it, nor mocap bodies."""
    return (model.body_weldid != 0) & (model.body_mocapid[model.body_weldid] < 0)


def poses(model: Any, data: Any) -> list[list[float]]:
    """Position and rotation matrix of each body."""
    return [[*data.xpos[i], *data.xmat[i]] for i in range(1, model.nbody)]


def state(model: Any, data: Any, seed: int) -> dict[str, Any]:
    """A random state, and what follows from it, without constraints."""
    rng = np.random.default_rng(seed)
    mujoco.mj_resetData(model, data)
    for joint in range(model.njnt):
        place = model.jnt_qposadr[joint]
        kind = model.jnt_type[joint]
        if kind == mujoco.mjtJoint.mjJNT_FREE:
            data.qpos[place : place + 3] += rng.uniform(-0.3, 0.3, 3)
            data.qpos[place + 3 : place + 7] = unit(rng.normal(size=4))
        elif kind == mujoco.mjtJoint.mjJNT_BALL:
            data.qpos[place : place + 4] = unit(rng.normal(size=4))
        else:
            lower, upper = model.jnt_range[joint] if model.jnt_limited[joint] else (-1.0, 1.0)
            data.qpos[place] = rng.uniform(max(lower, -3.0), min(upper, 3.0)) if lower < upper else lower
    data.qvel[:] = rng.uniform(-1.0, 1.0, model.nv)
    for actuator in range(model.nu):
        lower, upper = (-1.0, 1.0)
        if model.actuator_ctrllimited[actuator]:
            lower, upper = model.actuator_ctrlrange[actuator]
        data.ctrl[actuator] = rng.uniform(lower, upper)
    given = {name: getattr(data, name).tolist() for name in ("qpos", "qvel", "ctrl")}
    # Forces with `actearly` are those after a step, which is as short as Carom's.
    kept, model.opt.timestep = model.opt.timestep, STEP
    mujoco.mj_forward(model, data)
    model.opt.timestep = kept
    matrix = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, matrix)
    found = {
        "poses": poses(model, data),
        "matrix": matrix.tolist(),
        "bias": data.qfrc_bias.tolist(),
        "forces": data.actuator_force.tolist(),
        "sensors": data.sensordata.tolist(),
    }
    return given | found | {"acceleration": acceleration(model, data, given).tolist()}


def acceleration(model: Any, data: Any, given: dict[str, list[float]]) -> np.ndarray:
    """Change of velocity per time in steps that tend to 0, in which damping is implicit, as in Carom's."""
    kept = model.opt.timestep, model.opt.integrator
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    rates = []
    for step in (STEP, 0.5 * STEP):
        mujoco.mj_resetData(model, data)
        for name, values in given.items():
            getattr(data, name)[:] = values
        model.opt.timestep = step
        mujoco.mj_step(model, data)
        rates.append((data.qvel - given["qvel"]) / step)
    model.opt.timestep, model.opt.integrator = kept
    return 2.0 * rates[1] - rates[0]


def grown(one: list[list[float]] | None, other: list[list[float]] | None) -> float | None:
    """How far apart two rollouts end, as `ask_carom.py` measures it; None if one has failed."""
    if one is None or other is None:
        return None
    places = np.array(one)[:, :3]
    return float(np.abs(places - np.array(other)[:, :3]).max() / max(np.abs(places).max(), 1e-3))


def rollout(model: Any, data: Any, apart: float = 0.0) -> list[list[float]] | None:
    """Poses after a second from the first keyframe, or the reference, under its controls.

    Velocities start with up to `apart` added to them.
    """
    mujoco.mj_resetData(model, data)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
        data.act[:] = 0.0
    data.qvel[:] += apart * np.random.default_rng(0).uniform(-1.0, 1.0, model.nv)
    for _ in range(round(SECONDS / model.opt.timestep)):
        mujoco.mj_step(model, data)
    mujoco.mj_kinematics(model, data)
    found = poses(model, data)
    has_failed = not np.isfinite(found).all() or data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number
    return None if has_failed else found


def unit(numbers: np.ndarray) -> np.ndarray:
    return numbers / np.linalg.norm(numbers)


if __name__ == "__main__":
    main()
