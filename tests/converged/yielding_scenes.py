"""Scenes in MuJoCo's format, of which `mujoco_steps.json` has steps of MuJoCo itself; makes that file.

python -m tests.converged.yielding_scenes        with MuJoCo 4
"""

from __future__ import annotations

import json
from pathlib import Path

STEPS = Path(__file__).parent / "mujoco_steps.json"
_SPHERES = """<geom type="plane" size="5 5 .1"/>
<body name="a" pos="0 0 0.0995"><freejoint/><geom type="sphere" size=".1" mass="1"/></body>
<body name="b" pos="0.15 0.03 0.229"><freejoint/><geom type="sphere" size=".1" mass="2"/></body>
<body name="c" pos="0.31 0.0 0.0998"><freejoint/><geom type="sphere" size=".1" mass="1.5"/></body>"""
_BOX = """<geom type="plane" size="5 5 .1"/>
<body name="a" pos="0 0 0.0995"><freejoint/><geom type="box" size=".1 .12 .1" mass="1"/></body>"""
_LIMB = """<geom type="plane" size="5 5 .1"/>
<body name="a" pos="0 0 0.54"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>
<joint type="hinge" axis="0 1 0"/><geom type="sphere" size=".05" mass="1" contype="0" conaffinity="0"/>
<body name="l" pos="0 0 -.05"><joint type="hinge" axis="0 1 0" range="-60 60" limited="true"/>
<geom type="capsule" fromto="0 0 0 .2 0 -.2" size=".03" mass=".5"/>
<body name="f" pos=".2 0 -.2"><joint type="hinge" axis="0 1 0"/>
<geom type="capsule" fromto="0 0 0 -.2 0 -.27" size=".03" mass=".5"/></body></body></body>"""


def _scene(cone: str, condim: int, impratio: float, bodies: str, noslip: int = 0) -> str:
    # Spinning and rolling friction count with 4 and 6 only.
    friction = "0.5" if condim < 4 else "0.5 0.05 0.02"
    return (
        f'<mujoco><option cone="{cone}" timestep="0.002" impratio="{impratio}" noslip_iterations="{noslip}" '
        'noslip_tolerance="0"/>'
        f'<default><geom condim="{condim}" friction="{friction}"/></default>'
        f"<worldbody>{bodies}</worldbody></mujoco>"
    )


SCENES = {
    f"{name}, {cone}, condim {condim}, impratio {impratio}": _scene(cone, condim, impratio, bodies)
    for name, bodies in (("spheres", _SPHERES), ("box", _BOX), ("limb", _LIMB))
    for cone in ("elliptic", "pyramidal")
    for condim, impratio in ((1, 1.0), (3, 1.0), (3, 10.0), (4, 1.0), (4, 10.0), (6, 1.0), (6, 10.0))
}
"""By what they have."""
# With dry friction of joints as well.
_RUBBING_LIMB = _LIMB.replace('type="hinge"', 'type="hinge" frictionloss=".3"')
WITHOUT_SLIP = {
    f"{name}, {cone}, condim {condim}, no slip": _scene(cone, condim, 1.0, bodies, 1000)
    for name, bodies in (("spheres", _SPHERES), ("box", _BOX), ("limb", _RUBBING_LIMB))
    for cone in ("elliptic", "pyramidal")
    for condim in (3, 4, 6)
}
"""With MuJoCo's `noslip_iterations`, as many as change anything."""


def _record() -> None:
    import mujoco  # pyright: ignore[reportMissingImports]
    import numpy as np

    steps = {}
    for name, scene in (SCENES | WITHOUT_SLIP).items():
        model = mujoco.MjModel.from_xml_string(scene)
        model.opt.tolerance, model.opt.iterations = 1e-14, 200
        data = mujoco.MjData(model)
        data.qvel[:] = 0.5 * np.random.default_rng(1).uniform(-1.0, 1.0, model.nv)
        steps[name] = []
        for number in range(100):
            before = [data.qpos.tolist(), data.qvel.tolist()]
            mujoco.mj_step(model, data)
            if data.ncon and number in (30, 70):
                steps[name].append([*before, data.qpos.tolist(), data.qvel.tolist()])
    STEPS.write_text(json.dumps(steps) + "\n")


if __name__ == "__main__":
    _record()
