"""The hand of a Panda draws ellipses over a tray."""

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
    """An arm that moves by a sixtieth of a second with each `step`, and takes no pictures."""

    takes_pictures = False
