"""Records what MuJoCo makes of the files in `cases.py`: python record_deformables.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from cases import AT, FALL, KEPT, RESTING, RIGID, SKINS, STEPS


def loaded(text: str) -> tuple:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    mujoco.mj_kinematics(m, d)
    mujoco.mj_flex(m, d)
    return m, d


def rest(text: str) -> dict:
    m, d = loaded(text)
    start = np.round(d.flexvert_xpos, 9).tolist()
    for _ in range(STEPS):
        mujoco.mj_step(m, d)
        d.qvel *= KEPT
    mujoco.mj_flex(m, d)
    assert np.abs(d.qvel).max() < 1e-3, np.abs(d.qvel).max()
    return {"start": start, "end": np.round(d.flexvert_xpos, 6).tolist()}


def fall(text: str) -> list:
    m, d = loaded(text)
    for _ in range(FALL):
        mujoco.mj_step(m, d)
    return np.round(d.qpos, 6).tolist()


def skin(text: str) -> dict:
    m, d = loaded(text)
    d.qpos[:] = AT
    mujoco.mj_forward(m, d)
    scene = mujoco.MjvScene(m, 1000)
    options, camera = mujoco.MjvOption(), mujoco.MjvCamera()
    options.flags[mujoco.mjtVisFlag.mjVIS_SKIN] = 1
    everything = mujoco.mjtCatBit.mjCAT_ALL.value
    mujoco.mjv_updateScene(m, d, options, mujoco.MjvPerturb(), camera, everything, scene)
    mujoco.mjv_updateSkin(m, d, scene)
    return {
        "vertices": np.round(scene.skinvert.reshape(-1, 3).astype(float), 7).tolist(),
        "normals": np.round(scene.skinnormal.reshape(-1, 3).astype(float), 7).tolist(),
    }


if __name__ == "__main__":
    answers = {
        "rest": {name: rest(text) for name, text in RESTING.items()},
        "fall": {name: fall(text) for name, text in RIGID.items()},
        "skin": {name: skin(text) for name, text in SKINS.items()},
    }
    Path(__file__).with_name("answers.json").write_text(json.dumps(answers) + "\n")
