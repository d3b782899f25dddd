"""Records what MuJoCo makes of the files in `tendon.py`: python record_tendons.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from tendon import TENDONS

STATES = 4


def states(text: str) -> list[dict]:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    found = []
    for seed in range(STATES):
        rng = np.random.default_rng(seed)
        mujoco.mj_resetData(m, d)
        d.qpos[:] = rng.uniform(-0.6, 0.6, m.nq) * [1, 1, 0.1]
        d.qvel[:] = rng.uniform(-1, 1, m.nv)
        d.ctrl[:] = rng.uniform(0.1, 0.9, m.nu)
        d.act[:] = rng.uniform(0.1, 0.9, m.na)
        mujoco.mj_forward(m, d)
        one = {name: getattr(d, name).tolist() for name in ("qpos", "qvel", "ctrl", "act", "qacc")}
        one |= {"length": d.ten_length.tolist(), "velocity": d.ten_velocity.tolist()}
        one |= {"drive_length": d.actuator_length.tolist(), "drive_velocity": d.actuator_velocity.tolist()}
        one |= {"force": d.actuator_force.tolist()}
        arms = np.zeros((m.ntendon, m.nv))
        for dof in range(m.nv):
            d.qvel[:] = 0
            d.qvel[dof] = 1
            mujoco.mj_forward(m, d)
            arms[:, dof] = d.ten_velocity
        one["arms"] = arms.tolist()
        d.qvel[:] = one["qvel"]
        mujoco.mj_forward(m, d)
        matrix = np.zeros((m.nv, m.nv))
        mujoco.mj_fullM(m, d, matrix)
        one |= {"matrix": matrix.tolist(), "bias": d.qfrc_bias.tolist()}
        for _ in range(50):
            mujoco.mj_step(m, d)
        found.append(one | {"end": d.qpos.tolist(), "end_act": d.act.tolist()})
    return found


if __name__ == "__main__":
    answers = {name: states(text) for name, text in TENDONS.items()}
    Path(__file__).with_name("tendon_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
