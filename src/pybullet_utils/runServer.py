"""A server with a window, for clients in other processes: `python -m pybullet_utils.runServer`."""

from __future__ import annotations

import time

import pybullet
import pybullet_data


def main() -> None:
    """Serves until the window is closed."""
    pybullet.connect(pybullet.GUI_SERVER)
    pybullet.setAdditionalSearchPath(pybullet_data.getDataPath())
    while pybullet.isConnected():
        time.sleep(0.01)


if __name__ == "__main__":
    main()
