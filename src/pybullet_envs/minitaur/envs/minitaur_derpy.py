"""The Minitaur called Derpy: lower legs of different lengths, measured on the real robot."""

from __future__ import annotations

import pybullet
from pybullet_envs.minitaur.envs.minitaur import Minitaur
from pybullet_envs.minitaur_bases import Point

KNEE_CONSTRAINT_POINT_LONG = (0.0, 0.0055, 0.088)
KNEE_CONSTRAINT_POINT_SHORT = (0.0, 0.0055, 0.100)


class MinitaurDerpy(Minitaur):
    """Like `Minitaur`, but from another file; links do not collide with their parents."""

    _file = "quadruped/minitaur_derpy.urdf"
    _knee_joint = "knee_{}{}_joint"
    _self_collision = pybullet.URDF_USE_SELF_COLLISION_EXCLUDE_PARENT
    _long, _short = KNEE_CONSTRAINT_POINT_LONG, KNEE_CONSTRAINT_POINT_SHORT

    def _knee_points(self, leg: int) -> tuple[Point, Point]:
        on_the_left = leg < self.num_legs // 2
        return (self._short, self._long) if on_the_left else (self._long, self._short)
