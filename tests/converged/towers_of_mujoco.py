"""Towers in MuJoCo's format; `mujoco_towers.json` has how they creep in MuJoCo itself. Makes that file.

python -m tests.converged.towers_of_mujoco        with MuJoCo 4
"""

from __future__ import annotations

import json
from pathlib import Path

DRIFTS = Path(__file__).parent / "mujoco_towers.json"
COUNT, TIME_STEP = 10, 0.002
SECONDS = (1, 6, 61)
"""When positions are compared with those of the first of these times [s]."""
_OFFSETS = (
    (0.0014, -0.0023), (-0.0046, -0.0048), (0.0031, 0.0041), (0.0011, 0.0023), (0.0004, 0.0044),
    (0.0032, -0.005), (0.0036, -0.0047), (0.0023, -0.0032), (0.0036, 0.0004), (-0.002, -0.0008),
)  # fmt: skip


def tower(cone: str = "pyramidal", share: float = 1.0, time_step: float = TIME_STEP) -> str:
    """A tower of boxes of 20 cm, off centre by a share of up to 5 mm."""
    bodies = "".join(
        f'<body name="b{i}" pos="{share * x!r} {share * y!r} {0.1 + 0.2 * i!r}"><freejoint/>'
        '<geom type="box" size=".1 .1 .1" mass="1"/></body>'
        for i, (x, y) in enumerate(_OFFSETS)
    )
    return (
        f'<mujoco><option cone="{cone}" timestep="{time_step!r}"/><worldbody>'
        f'<geom type="plane" size="5 5 .1"/>{bodies}</worldbody></mujoco>'
    )


def _record() -> None:
    import mujoco  # pyright: ignore[reportMissingImports]

    drifts = {}
    for cone in ("pyramidal", "elliptic"):
        model = mujoco.MjModel.from_xml_string(tower(cone))
        model.opt.tolerance, model.opt.iterations = 1e-14, 200
        data, found = mujoco.MjData(model), []
        for seconds in SECONDS:
            while data.time < seconds - 0.5 * TIME_STEP:
                mujoco.mj_step(model, data)
            found.append(data.qpos.reshape(COUNT, 7)[:, :3].copy())
        drifts[cone] = [(later - found[0]).tolist() for later in found[1:]]
    DRIFTS.write_text(json.dumps(drifts) + "\n")


if __name__ == "__main__":
    _record()
