"""The quadruped as an environment."""

from __future__ import annotations

from functools import partial
from typing import Any

from carom.vector.quadruped.robot import QuadrupedRobot
from carom.vector.quadruped.terms import TASK
from carom.vector.single import SingleEnv


class Quadruped(QuadrupedRobot):
    """An A1 that follows commands of velocity on random terrain.

    All worlds share one height field of tiles: kinds of terrain (rough, slopes, stairs, blocks) beside each
    other, and levels of difficulty one behind the other. Each world has its kind; its level rises when its
    robot walks as far as commanded, and falls when it does not.

    Action: deviations of the targets of the twelve joints from a gait, in units of 0.35 rad, at most 2. The
    gait is to tread on the spot, diagonal pairs of legs in turn, or to stand if that is the command. The
    targets are followed by springs with dampers. Observations, rewards, terminations, events, commands and
    curriculum are in `carom.vector.quadruped.terms.TASK`. A step lasts 1/50 s.

    Attributes:
        terrain: The ground.
        levels: Level of each world, (num_envs,).
        kinds: Kind of terrain of each world, (num_envs,).

    Args:
        num_envs: Number of environments.
        seed_of_terrain: The same seed gives the same ground.
        **options: As for `WorldsEnv`.
    """

    def __init__(self, num_envs: int = 1, *, seed_of_terrain: int = 0, **options: Any) -> None:
        super().__init__(num_envs, TASK, seed_of_terrain=seed_of_terrain, **options)


single_Quadruped = partial(SingleEnv, Quadruped)
