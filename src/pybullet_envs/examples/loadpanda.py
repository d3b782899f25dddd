"""Shows a Panda that draws ellipses: `python -m pybullet_envs.examples.loadpanda`."""

from __future__ import annotations

from pybullet_envs.examples.panda_sim import PandaSim
from pybullet_robots.panda._show import show

if __name__ == "__main__":
    show(PandaSim, 1.0 / 60.0)
