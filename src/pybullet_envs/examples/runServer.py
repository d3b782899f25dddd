"""A server with a window, for clients in other processes: `python -m pybullet_envs.examples.runServer`."""

from __future__ import annotations

from pybullet_utils.runServer import main

if __name__ == "__main__":
    main()
