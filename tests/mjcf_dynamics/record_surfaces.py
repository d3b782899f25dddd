"""Records what MuJoCo makes of `surface_cases.py`: python record_surfaces.py, with mujoco 4.0."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
from surface_cases import ALIGNED, MOVING, STEPS


def posed(text: str, steps: int) -> dict[str, list[float]]:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    m.opt.iterations, m.opt.tolerance = 200, 1e-14
    for _ in range(steps):
        mujoco.mj_step(m, d)
    mujoco.mj_kinematics(m, d)
    found = {m.body(b).name: [*d.xpos[b], *d.xquat[b]] for b in range(1, m.nbody) if m.body(b).name}
    for site in range(m.nsite):
        quaternion = d.xquat[0].copy()
        mujoco.mju_mat2Quat(quaternion, d.site_xmat[site])
        found[m.site(site).name] = [*d.site_xpos[site], *quaternion]
    return {name: [float(number) for number in pose] for name, pose in found.items()}


if __name__ == "__main__":
    answers = {name: posed(text, STEPS) for name, text in MOVING.items()} | {"aligned": posed(ALIGNED, 0)}
    Path(__file__).with_name("surface_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
