"""Records what MuJoCo makes of the files in `ball.py`: python record_balls.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from ball import BALL, BALLS, CONTROL, HINGE


def motion(text: str) -> dict:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    d.qpos[0] = HINGE
    for place, quaternion in zip((1, 5), BALL, strict=True):
        d.qpos[place : place + 4] = np.array(quaternion) / np.linalg.norm(quaternion)
    d.ctrl[:] = CONTROL
    mujoco.mj_forward(m, d)
    return {
        "acceleration": d.qacc.tolist(),
        "length": d.actuator_length.tolist(),
        "force": d.actuator_force.tolist(),
        "damping": m.actuator_biasprm[:, 2].tolist(),
    }


if __name__ == "__main__":
    answers = {name: motion(text) for name, text in BALLS.items()}
    Path(__file__).with_name("ball_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
