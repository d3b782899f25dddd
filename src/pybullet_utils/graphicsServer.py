"""A window for clients in other processes: `python -m pybullet_utils.graphicsServer`."""

from __future__ import annotations

import time

import pybullet


def main() -> None:
    """Shows the window until it is closed."""
    pybullet.connect(pybullet.GRAPHICS_SERVER)
    print("started graphics server")
    while pybullet.isConnected():
        time.sleep(1.0 / 240.0)


if __name__ == "__main__":
    main()
