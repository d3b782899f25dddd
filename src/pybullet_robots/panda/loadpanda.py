"""Shows a Panda that draws ellipses: `python -m pybullet_robots.panda.loadpanda`."""

from __future__ import annotations

from pybullet_robots.panda._show import show
from pybullet_robots.panda.panda_sim import PandaSim

if __name__ == "__main__":
    show(PandaSim, 1.0 / 60.0)
