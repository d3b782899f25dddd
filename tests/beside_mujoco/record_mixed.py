"""Records what MuJoCo makes of the files in `mixed.py`: python record_mixed.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
from mixed import MIXED


def acceleration(text: str) -> list[float]:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    mujoco.mj_resetDataKeyframe(m, d, 0)
    mujoco.mj_forward(m, d)
    return d.qacc.tolist()


if __name__ == "__main__":
    answers = {name: acceleration(text) for name, text in MIXED.items()}
    Path(__file__).with_name("mixed_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
