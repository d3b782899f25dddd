"""Records what MuJoCo makes of the files in `soft.py`: python record_soft.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]

from soft import MOVED, PAIRS, STEPS, WEIGHED


def weighed(text: str) -> dict:
    m = mujoco.MjModel.from_xml_string(text)
    joints = {m.joint(j).name: m.dof_invweight0[m.jnt_dofadr[j]] for j in range(m.njnt) if m.joint(j).name}
    return {
        "bodies": {m.body(b).name: m.body_invweight0[b].tolist() for b in range(1, m.nbody)},
        "joints": joints,
    }


def moved(text: str) -> list:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    d.ctrl[:] = 2.0
    answers = []
    for step in range(1, STEPS[-1] + 1):
        mujoco.mj_step(m, d)
        if step in STEPS:
            answers.append(d.qpos[:3].tolist())
    return answers


if __name__ == "__main__":
    answers = {"weights": weighed(WEIGHED), **{name: moved(text) for name, text in (MOVED | PAIRS).items()}}
    Path(__file__).with_name("soft_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
