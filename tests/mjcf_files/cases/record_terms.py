"""Records what MuJoCo makes of the files in `term.py`: python record_terms.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
from term import MOVED, STEPS


def moved(text: str) -> list:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    mujoco.mj_resetDataKeyframe(m, d, 0)
    mujoco.mj_forward(m, d)
    answers = [{"sensors": d.sensordata.tolist()}] if m.nsensor else []
    for step in range(1, STEPS[-1] + 1):
        mujoco.mj_step(m, d)
        if step in STEPS:
            mujoco.mj_kinematics(m, d)
            answers.append({m.body(b).name: [*d.xpos[b], *d.xmat[b]] for b in range(1, m.nbody)})
    return answers


if __name__ == "__main__":
    answers = {name: moved(text) for name, text in MOVED.items()}
    Path(__file__).with_name("term_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
