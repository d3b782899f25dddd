"""Shows a Panda that grasps bricks: `python -m pybullet_robots.panda.loadpanda_grasp`."""

from __future__ import annotations

from pybullet_robots.panda._show import show
from pybullet_robots.panda.panda_sim_grasp import PandaSimAuto

if __name__ == "__main__":
    show(PandaSimAuto, 1.0 / 240.0)
