"""Shows an xArm that draws circles: `python -m pybullet_robots.xarm.loadxarm_sim`."""

from __future__ import annotations

import time

import pybullet
import pybullet_data
from pybullet_robots.xarm.xarm_sim import XArm6Sim


def main() -> None:
    """Simulates in real time until the window is closed."""
    pybullet.connect(pybullet.GUI)
    pybullet.setAdditionalSearchPath(pybullet_data.getDataPath())
    pybullet.setTimeStep(1.0 / 60.0)
    pybullet.setGravity(0, 0, -9.8)
    arm = XArm6Sim(pybullet, [0.0, 0.0, 0.0])
    while pybullet.isConnected():
        arm.step()
        pybullet.stepSimulation()
        time.sleep(1.0 / 60.0)


if __name__ == "__main__":
    main()
