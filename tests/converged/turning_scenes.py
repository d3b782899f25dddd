"""Scenes whose rows turn as bodies do, of which `mujoco_turning.json` has steps of MuJoCo; makes that file.

python -m tests.converged.turning_scenes        with MuJoCo 4
"""

from __future__ import annotations

import json
from pathlib import Path

STEPS = Path(__file__).parent / "mujoco_turning.json"
_TWO = """<body name="a" pos="0 0 1"><freejoint/><geom type="box" size=".1 .2 .05" mass="1"/></body>
<body name="b" pos="0.3 0.1 1"><freejoint/><geom type="box" size=".05 .1 .2" mass="2"/></body>"""
_CAPSULE = """<geom type="plane" size="5 5 .1" euler="5 0 0"/>
<body name="a" pos="0 0 .0495" euler="0 90 35"><freejoint/>
<geom type="capsule" size=".05 .2" mass="1"/></body>"""


def _held(equality: str) -> str:
    return (
        '<mujoco><option timestep="0.002"><flag contact="disable"/></option>'
        f"<worldbody>{_TWO}</worldbody><equality>{equality}</equality></mujoco>"
    )


def _lying(condim: int) -> str:
    return (
        '<mujoco><option timestep="0.002" cone="pyramidal"/>'
        f'<default><geom condim="{condim}" friction="0.5 0.05 0.02"/></default>'
        f"<worldbody>{_CAPSULE}</worldbody></mujoco>"
    )


SCENES = {
    "connect of two": _held('<connect body1="a" body2="b" anchor="0.1 0.2 0.1"/>'),
    "connect to the world": _held('<connect body1="b" anchor="0.1 0.2 0.1"/>'),
    "weld of two": _held('<weld body1="a" body2="b"/>'),
} | {f"capsule on a plane, condim {condim}": _lying(condim) for condim in (3, 4, 6)}
"""By what they have."""


def _record() -> None:
    import mujoco  # pyright: ignore[reportMissingImports]
    import numpy as np

    steps = {}
    for name, scene in SCENES.items():
        model = mujoco.MjModel.from_xml_string(scene)
        model.opt.tolerance, model.opt.iterations = 1e-14, 200
        data = mujoco.MjData(model)
        data.qvel[:] = 2.0 * np.random.default_rng(1).uniform(-1.0, 1.0, model.nv)
        if "capsule" in name:
            data.qvel[:] *= 0.1
        steps[name] = []
        for number in range(100):
            before = [data.qpos.tolist(), data.qvel.tolist()]
            mujoco.mj_step(model, data)
            if data.nefc and number in (5, 30, 70):
                steps[name].append([*before, data.qpos.tolist(), data.qvel.tolist()])
    STEPS.write_text(json.dumps(steps) + "\n")


if __name__ == "__main__":
    _record()
