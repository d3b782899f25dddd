"""Records what MuJoCo makes of the files in `point.py`: python record_points.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from point import RESTING, STEPS, TOUCHING


def touching(text: str) -> dict:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    mujoco.mj_forward(m, d)
    turn = d.body("b").xmat.reshape(3, 3)
    return {
        "contacts": d.ncon,
        "acceleration": [*d.qacc[:3].tolist(), *np.dot(turn, d.qacc[3:6]).tolist()],
    }


def resting(text: str) -> list[list[float]]:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    found = []
    for step in range(1, STEPS[-1] + 1):
        mujoco.mj_step(m, d)
        if step in STEPS:
            mujoco.mj_kinematics(m, d)
            found.append(d.body("b").xpos.tolist())
    return found


if __name__ == "__main__":
    answers = {
        "touching": {name: touching(text) for name, text in TOUCHING.items()},
        "resting": {name: resting(text) for name, text in RESTING.items()},
    }
    Path(__file__).with_name("point_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
