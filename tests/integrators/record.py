"""Record MuJoCo's motion of all scenes: `PYTHON -m tests.integrators.record`, with MuJoCo 4.0."""

from __future__ import annotations

import importlib
import json
from pathlib import Path

from tests.integrators.scenes import INTEGRATORS, SCENES, STEPS, file_of

RECORDED = Path(__file__).parent / "mujoco_motion.json"


def main() -> None:
    """Write the coordinates and velocities after half of the steps and after all of them."""
    mujoco = importlib.import_module("mujoco")
    scenes = {}
    for scene in SCENES:
        for integrator in INTEGRATORS:
            model = mujoco.MjModel.from_xml_string(file_of(scene, integrator))
            model.opt.tolerance = 0.0
            data = mujoco.MjData(model)
            mujoco.mj_resetDataKeyframe(model, data, 0)
            after = []
            for step in range(STEPS):
                mujoco.mj_step(model, data)
                if step + 1 in (STEPS // 2, STEPS):
                    after.append({"qpos": data.qpos.tolist(), "qvel": data.qvel.tolist()})
            scenes[f"{scene}, {integrator}"] = after
    RECORDED.write_text(json.dumps({"mujoco": mujoco.__version__, "motion": scenes}) + "\n")


if __name__ == "__main__":
    main()
