"""Records what MuJoCo makes of the files in `flex.py`: python record_flexes.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from flex import KEPT, MADE, RESTING, STEPS


def loaded(text: str) -> tuple:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    mujoco.mj_kinematics(m, d)
    mujoco.mj_flex(m, d)
    return m, d


def made(text: str) -> dict:
    m, d = loaded(text)
    elements = m.flex_elem.reshape(-1, m.flex_dim[0] + 1)
    moving = [mujoco.mj_id2name(m, mujoco.mjtObj.mjOBJ_BODY, body) for body in range(m.nbody)]
    return {
        "points": np.round(d.flexvert_xpos, 12).tolist(),
        "cells": sorted(sorted(row) for row in elements.tolist()),
        "moving": [int(name[2:]) for name in moving if name.startswith("f_")],
        "mass": float(m.body_mass[-1]),
    }


def rest(text: str) -> list:
    m, d = loaded(text)
    for _ in range(STEPS):
        mujoco.mj_step(m, d)
        d.qvel *= KEPT
    mujoco.mj_flex(m, d)
    assert np.abs(d.qvel).max() < 1e-3, np.abs(d.qvel).max()
    return np.round(d.flexvert_xpos, 6).tolist()


if __name__ == "__main__":
    answers = {
        "made": {name: made(text) for name, text in MADE.items()},
        "rest": {name: rest(text) for name, text in RESTING.items()},
    }
    Path(__file__).with_name("flex_answers.json").write_text(json.dumps(answers) + "\n")
