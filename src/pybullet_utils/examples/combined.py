"""Shows the robot that `combineUrdf` has written: `python -m pybullet_utils.examples.combined`."""

from __future__ import annotations

import time

import pybullet


def main() -> None:
    """Simulates `combined.urdf` until the window is closed."""
    pybullet.connect(pybullet.GUI)
    pybullet.loadURDF("combined.urdf", useFixedBase=True)
    pybullet.setRealTimeSimulation(1)
    while pybullet.isConnected():
        time.sleep(0.01)


if __name__ == "__main__":
    main()
