"""Records what MuJoCo makes of the files in `controlled.py`: python record_controlled.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from controlled import CONTROLLED


def controlled(text: str) -> dict:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    d.ctrl[:] = np.random.default_rng(5).uniform(-0.6, 0.8, len(d.ctrl))
    result = {"control": d.ctrl.tolist()}
    for _ in range(400):
        mujoco.mj_step(m, d)
    return result | {"end": d.qpos.tolist(), "force": d.qfrc_actuator.tolist()}


if __name__ == "__main__":
    answers = {name: controlled(text) for name, text in CONTROLLED.items()}
    Path(__file__).with_name("controlled_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
