"""Shows an xArm that draws circles: `python -m pybullet_envs.examples.loadxarm`."""

from __future__ import annotations

from pybullet_robots.xarm.loadxarm_sim import main

if __name__ == "__main__":
    main()
