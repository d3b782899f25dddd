"""Records what MuJoCo makes of the files in `camera.py`: python record_cameras.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
from camera import CAMERAS, MOVED


def poses(text: str) -> list[dict]:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    found = []
    for is_moved in (False, True):
        if is_moved:
            d.qpos[:3] += MOVED[0]
            d.qpos[3:7], d.qpos[7], d.qpos[8] = MOVED[1:]
        mujoco.mj_forward(m, d)
        one = {m.camera(c).name: [*d.cam_xpos[c].tolist(), *d.cam_xmat[c].tolist()] for c in range(m.ncam)}
        found.append(one)
    return found


if __name__ == "__main__":
    answers = {name: poses(text) for name, text in CAMERAS.items()}
    Path(__file__).with_name("camera_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
