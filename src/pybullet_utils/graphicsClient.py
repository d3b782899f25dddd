"""A robot that falls, shown by `graphicsServer`: `python -m pybullet_utils.graphicsClient`."""

from __future__ import annotations

import time

import pybullet
import pybullet_data


def main() -> None:
    """Simulates until the window is closed."""
    pybullet.connect(pybullet.GRAPHICS_SERVER_TCP)
    pybullet.setAdditionalSearchPath(pybullet_data.getDataPath())
    pybullet.loadURDF("plane.urdf")
    pybullet.loadURDF("r2d2.urdf", [0, 0, 3])
    pybullet.setGravity(0, 0, -10)
    while pybullet.isConnected():
        pybullet.stepSimulation()
        time.sleep(1.0 / 240.0)


if __name__ == "__main__":
    main()
