"""Records what MuJoCo's inverse dynamics, in discrete time, answers for the scenes of `yielding_scenes`.

python -m tests.converged.record_inverse        with MuJoCo 4
"""

from __future__ import annotations

import json
from pathlib import Path

from tests.converged.yielding_scenes import SCENES

ANSWERS = Path(__file__).parent / "mujoco_inverse.json"
"""By scene: a list of (positions, velocities, accelerations, forces, forces of constraints)."""


def _record() -> None:
    import mujoco  # pyright: ignore[reportMissingImports]
    import numpy as np

    answers = {}
    for name, scene in SCENES.items():
        model = mujoco.MjModel.from_xml_string(scene)
        model.opt.tolerance, model.opt.iterations = 1e-14, 200
        data, random = mujoco.MjData(model), np.random.default_rng(2)
        data.qvel[:] = 0.5 * random.uniform(-1.0, 1.0, model.nv)
        answers[name] = []
        for number in range(100):
            if data.ncon and number in (30, 70):
                asked = mujoco.MjData(model)
                model.opt.enableflags = int(mujoco.mjtEnableBit.mjENBL_INVDISCRETE)
                asked.qpos[:], asked.qvel[:] = data.qpos, data.qvel
                asked.qacc[:] = random.uniform(-20.0, 20.0, model.nv)
                mujoco.mj_inverse(model, asked)
                model.opt.enableflags = 0
                fields = asked.qpos, asked.qvel, asked.qacc, asked.qfrc_inverse, asked.qfrc_constraint
                answers[name].append([field.tolist() for field in fields])
            mujoco.mj_step(model, data)
    ANSWERS.write_text(json.dumps(answers) + "\n")


if __name__ == "__main__":
    _record()
