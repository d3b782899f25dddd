"""Records what MuJoCo 4.0 makes of the files in `dynamics_cases.py`: python record_dynamics.py."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from dynamics_cases import DYNAMICS


def answered(text: str) -> dict[str, list]:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    mujoco.mj_resetDataKeyframe(m, d, 0)
    mujoco.mj_forward(m, d)
    matrix = np.zeros((m.nv, m.nv))
    mujoco.mj_fullM(m, d, matrix)
    return {
        "matrix": matrix.tolist(),
        "acceleration": d.qacc.tolist(),
        "forces": d.actuator_force.tolist(),
    }


if __name__ == "__main__":
    answers = {name: answered(text) for name, text in DYNAMICS.items()}
    Path(__file__).with_name("dynamics_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
