"""Records what MuJoCo makes of the files in `fluid_cases.py`: python record_fluids.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
from fluid_cases import FLUIDS, STEPS


def answered(text: str) -> dict[str, list[float]]:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    m.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    mujoco.mj_resetDataKeyframe(m, d, 0)
    mujoco.mj_forward(m, d)
    found = {"acceleration": d.qacc.tolist()}
    for _ in range(STEPS):
        mujoco.mj_step(m, d)
    return found | {"positions": d.qpos.tolist()}


if __name__ == "__main__":
    answers = {name: answered(text) for name, text in FLUIDS.items()}
    Path(__file__).with_name("fluid_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
