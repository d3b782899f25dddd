"""Records what MuJoCo makes of the files in `turned.py`: python record_turned.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
from turned import MOVED, STEPS, TURNED


def started(text: str):
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    mujoco.mj_resetDataKeyframe(m, d, 0)
    return m, d


def acceleration(text: str) -> list[float]:
    m, d = started(text)
    mujoco.mj_forward(m, d)
    return d.qacc.tolist()


def motion(text: str) -> list[list[float]]:
    m, d = started(text)
    found = []
    for step in range(1, STEPS[-1] + 1):
        mujoco.mj_step(m, d)
        if step in STEPS:
            mujoco.mj_kinematics(m, d)
            found.append([*d.body("b").xpos.tolist(), *d.body("b").xmat.tolist()])
    return found


if __name__ == "__main__":
    answers = {
        "accelerations": {name: acceleration(text) for name, text in TURNED.items()},
        "motions": {name: motion(text) for name, text in MOVED.items()},
    }
    Path(__file__).with_name("turned_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
