"""Records what MuJoCo makes of the files in `driven.py`: python record_driven.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from driven import ACTUATED, TIED


def names(m):
    return [m.joint(j).name for j in range(m.njnt)]


def actuated(text: str) -> dict:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    rng = np.random.default_rng(5)
    q, v = rng.uniform(-0.3, 0.3, m.nq), rng.uniform(-1, 1, m.nv)
    control, activation = rng.uniform(0.1, 2, m.nu), rng.uniform(-0.2, 0.2, m.na)
    d.qpos[:], d.qvel[:], d.ctrl[:], d.act[:] = q, v, control, activation
    mujoco.mj_forward(m, d)
    result = {"joints": names(m), "q": q.tolist(), "v": v.tolist(), "control": control.tolist()}
    result["own"] = d.actuator_force.tolist()
    result |= {"activation": activation.tolist(), "force": d.qfrc_actuator.tolist()}
    result["with_activation"] = [m.actuator(i).name for i in range(m.nu) if m.actuator_dyntype[i]]
    for _ in range(400):
        mujoco.mj_step(m, d)
    return result | {"end": d.qpos.tolist(), "end_activation": d.act.tolist()}


def tied(text: str) -> dict:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    for _ in range(200):
        mujoco.mj_step(m, d)
    return {m.body(b).name: d.xpos[b].tolist() for b in range(1, m.nbody)} | {
        m.body(b).name + " turn": d.xmat[b].tolist() for b in range(1, m.nbody)
    }


if __name__ == "__main__":
    answers = {name: actuated(text) for name, text in ACTUATED.items()}
    answers |= {name: tied(text) for name, text in TIED.items()}
    Path(__file__).with_name("driven_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
