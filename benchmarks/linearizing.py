"""The cases that only Carom has of the engines with PyBullet's interface: derivatives of a step.

`mujoco_cases.py` has the same robots for `mjd_transitionFD`, with a torque on each joint.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from carom import World, Worlds

DATA = Path(__file__).resolve().parents[1] / "src" / "pybullet_data"


def linearize_panda(original_data: str) -> Callable[[], Any]:
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.load_urdf(DATA / "franka_panda" / "panda.urdf", fixed_base=True, as_pybullet=False)
    world.step(10)
    return world.linearize


def linearize_ant(original_data: str) -> Callable[[], Any]:
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.load_mjcf(DATA / "mjcf" / "ant.xml")
    world.step(10)
    return world.linearize


def linearize_pandas(original_data: str) -> Callable[[], Any]:
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.load_urdf(DATA / "franka_panda" / "panda.urdf", fixed_base=True, as_pybullet=False)
    world.step(10)
    return Worlds(world, 64).linearize


def differentiate_pandas(original_data: str) -> Callable[[], Any]:
    import torch

    from carom.torch import Stepper

    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.load_urdf(DATA / "franka_panda" / "panda.urdf", fixed_base=True, as_pybullet=False)
    world.step(10)
    stepper = Stepper(Worlds(world, 256))
    state, torques = stepper.state(), stepper.control_values().requires_grad_()

    def forward_and_backward() -> Any:
        after = stepper(state, torques)
        return torch.autograd.grad(after.velocities.square().sum(), torques)

    return forward_and_backward
