"""A Panda arm whose hand moves along an ellipse over a tray."""

from __future__ import annotations

from pybullet_robots.panda import panda_sim
from pybullet_robots.panda.panda_sim import (
    ikSolver,
    jointPositions,
    jr,
    ll,
    pandaEndEffectorIndex,
    pandaNumDofs,
    rp,
    ul,
    useNullSpace,
)

__all__ = [
    "PandaSim",
    "ikSolver",
    "jointPositions",
    "jr",
    "ll",
    "pandaEndEffectorIndex",
    "pandaNumDofs",
    "rp",
    "ul",
    "useNullSpace",
]


class PandaSim(panda_sim.PandaSim):
    """A Panda arm; each `step` advances the path of its hand by 1/60 s, without a camera image."""

    takes_pictures = False
