"""Records what MuJoCo's range finders show: python record_range_images.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from range_images import ANGLE, RANGES

if __name__ == "__main__":
    m = mujoco.MjModel.from_xml_string(RANGES)
    d = mujoco.MjData(m)
    d.qpos[0] = ANGLE
    mujoco.mj_forward(m, d)
    names = [m.sensor(number).name for number in range(m.nsensor)]
    answers = {name: np.round(d.sensor(name).data, 7).tolist() for name in names}
    Path(__file__).with_name("range_images.json").write_text(json.dumps(answers) + "\n")
