"""Records what MuJoCo makes of the files in `compiled.py`: python record_mujoco.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from compiled import CASES


def answer(text: str) -> dict:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    rng = np.random.default_rng(7)
    for j in range(m.njnt):
        at = m.jnt_qposadr[j]
        if m.jnt_type[j] == mujoco.mjtJoint.mjJNT_BALL:
            q = rng.standard_normal(4)
            d.qpos[at : at + 4] = q / np.linalg.norm(q)
        elif m.jnt_type[j] != mujoco.mjtJoint.mjJNT_FREE:
            d.qpos[at] += rng.uniform(-0.3, 0.3)
    mujoco.mj_forward(m, d)
    bodies = {}
    for b in range(1, m.nbody):
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, m.body_iquat[b])
        turn = turn.reshape(3, 3)
        bodies[m.body(b).name] = {
            "mass": m.body_mass[b],
            "centre": m.body_ipos[b].tolist(),
            "tensor": (turn @ np.diag(m.body_inertia[b]) @ turn.T).tolist(),
            "position": d.xpos[b].tolist(),
            "rotation": d.xmat[b].tolist(),
        }
    joints = {
        m.joint(j).name: {
            "start": m.qpos0[m.jnt_qposadr[j]],
            "position": d.qpos[
                m.jnt_qposadr[j] : m.jnt_qposadr[j] + (4 if m.jnt_type[j] == 1 else 1)
            ].tolist(),
            "range": m.jnt_range[j].tolist() if m.jnt_limited[j] else None,
        }
        for j in range(m.njnt)
        if m.jnt_type[j] != mujoco.mjtJoint.mjJNT_FREE
    }
    return {"bodies": bodies, "joints": joints}


if __name__ == "__main__":
    answers = {name: answer(text) for name, text in CASES.items()}
    Path(__file__).with_name("mujoco_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
