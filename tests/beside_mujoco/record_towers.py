"""Records how far the towers of `towers.py` creep in MuJoCo: python record_towers.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
from towers import COUNT, SECONDS, TIME_STEP, tower


def drifts(cone: str) -> list[list[list[float]]]:
    model = mujoco.MjModel.from_xml_string(tower(cone))
    model.opt.tolerance, model.opt.iterations = 1e-14, 200
    data, found = mujoco.MjData(model), []
    for seconds in SECONDS:
        while data.time < seconds - 0.5 * TIME_STEP:
            mujoco.mj_step(model, data)
        found.append(data.qpos.reshape(COUNT, 7)[:, :3].copy())
    return [(later - found[0]).tolist() for later in found[1:]]


if __name__ == "__main__":
    answers = {cone: drifts(cone) for cone in ("pyramidal", "elliptic")}
    Path(__file__).with_name("tower_answers.json").write_text(json.dumps(answers) + "\n")
