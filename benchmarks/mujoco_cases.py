"""The cases MuJoCo can be compared in: the same bodies, time step and friction."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np

DATA = Path(__file__).resolve().parents[1] / "src" / "pybullet_data"

EDGE = 0.2
FRICTION = 0.25
SETTLING_STEPS = 60


def tower_model(side: int) -> mujoco.MjModel:
    """Towers of boxes on a plane, `side` boxes along each axis."""
    boxes = "".join(
        f'<body pos="{1.05 * EDGE * i} {1.05 * EDGE * j} {EDGE * (k + 0.5)}"><freejoint/>'
        f'<geom type="box" size="{EDGE / 2} {EDGE / 2} {EDGE / 2}" mass="1" friction="{FRICTION}"/></body>'
        for i in range(side)
        for j in range(side)
        for k in range(side)
    )
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{1 / 240}" gravity="0 0 -9.81"/><worldbody>'
        f'<geom type="plane" size="50 50 1" friction="{FRICTION}"/>{boxes}</worldbody></mujoco>'
    )


def _towers(side: int) -> Callable[[], None]:
    model = tower_model(side)
    data = mujoco.MjData(model)
    for _ in range(SETTLING_STEPS):
        mujoco.mj_step(model, data)
    return partial(mujoco.mj_step, model, data)


def step_27_boxes(original_data: str) -> Callable[[], None]:
    return _towers(3)


def step_125_boxes(original_data: str) -> Callable[[], None]:
    return _towers(5)


def cloth_model(side: int) -> mujoco.MjModel:
    """Cloth of 1 m and 1 kg on a ball, as a flex that is about as stiff as springs of 40 N/m.

    Of the integrators only this one is stable at 1/240 s.
    """
    return mujoco.MjModel.from_xml_string(
        f'''<mujoco><option timestep="{1 / 240}" gravity="0 0 -9.81" integrator="discrete"/>
        <size memory="256M"/><worldbody>
        <geom type="sphere" size="0.3" pos="0 0 0.3" friction="{FRICTION}"/>
        <flexcomp name="cloth" type="grid" dim="2" count="{side} {side} 1" pos="0 0 0.63" mass="1"
                  spacing="{1 / (side - 1)} {1 / (side - 1)} 1" radius="0.01">
        <contact selfcollide="none" friction="{FRICTION}"/>
        <elasticity young="2e4" poisson="0.3" thickness="2e-3" damping="0.01" elastic2d="stretch"/>
        </flexcomp></worldbody></mujoco>'''
    )


def step_cloth(original_data: str) -> Callable[[], None]:
    model = cloth_model(32)
    data = mujoco.MjData(model)
    for _ in range(2 * SETTLING_STEPS):
        mujoco.mj_step(model, data)
    return partial(mujoco.mj_step, model, data)


def _transition(spec: mujoco.MjSpec) -> Callable[[], None]:
    """Central differences of a step of a robot with a torque on each joint that has one axis."""
    spec.option.timestep = 1 / 240
    for joint in spec.joints:
        if joint.type in (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE):
            spec.add_actuator(target=joint.name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 10)
    size = 2 * model.nv + model.na
    by_state, by_control = np.zeros((size, size)), np.zeros((size, model.nu))
    return partial(mujoco.mjd_transitionFD, model, data, 1e-6, True, by_state, by_control, None, None)


def linearize_panda(original_data: str) -> Callable[[], None]:
    text = (DATA / "franka_panda" / "panda.urdf").read_text(encoding="utf-8")
    # Meshes are not needed: nothing touches.
    bare = re.sub(r"<(visual|collision)\b.*?</\1>", "", text, flags=re.DOTALL)
    return _transition(mujoco.MjSpec.from_string(bare))


def linearize_ant(original_data: str) -> Callable[[], None]:
    return _transition(mujoco.MjSpec.from_file(str(DATA / "mjcf" / "ant.xml")))
