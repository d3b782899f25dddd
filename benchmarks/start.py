"""What a short script does first: import, connect, load, and one thing besides. Prints when it is done.

The argument says which: a key of `THINGS`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pybullet as p

DATA = Path(__file__).resolve().parents[1] / "src" / "pybullet_data"


def load_panda() -> int:
    """Connect and load the arm."""
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81)
    return p.loadURDF(str(DATA / "franka_panda" / "panda.urdf"), useFixedBase=True)


def step() -> None:
    """One step of the arm."""
    load_panda()
    p.stepSimulation()


def contact() -> None:
    """One step of a cube on the ground, and its contacts."""
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81)
    p.loadURDF(str(DATA / "plane.urdf"))
    cube = p.loadURDF(str(DATA / "cube_small.urdf"), [0, 0, 0.0249])
    p.stepSimulation()
    assert p.getContactPoints(cube)


def image() -> None:
    """One small camera image of the arm."""
    load_panda()
    view = p.computeViewMatrix([1, 1, 1], [0, 0, 0.5], [0, 0, 1])
    lens = p.computeProjectionMatrixFOV(60, 1, 0.1, 10)
    p.getCameraImage(64, 64, view, lens, renderer=p.ER_TINY_RENDERER)


def inverse_kinematics() -> None:
    """The joint positions for one place of the hand."""
    p.calculateInverseKinematics(load_panda(), 11, [0.4, 0.1, 0.5])


def ray() -> None:
    """One ray at the arm."""
    load_panda()
    p.rayTest([1, 0, 0.1], [-1, 0, 0.1])


THINGS = {
    "start_import": lambda: None,
    "start_step": step,
    "start_contact": contact,
    "start_image": image,
    "start_inverse_kinematics": inverse_kinematics,
    "start_ray": ray,
}

if __name__ == "__main__":
    THINGS[sys.argv[1]]()
    sys.stdout.write("done\n")
    sys.stdout.flush()
