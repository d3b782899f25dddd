"""The Minitaur called Rainbow Dash, measured on the real robot."""

from __future__ import annotations

from pybullet_envs.minitaur.envs.minitaur_derpy import MinitaurDerpy

KNEE_CONSTRAINT_POINT_LONG = (0.0, 0.0045, 0.088)
KNEE_CONSTRAINT_POINT_SHORT = (0.0, 0.0045, 0.100)


class MinitaurRainbowDash(MinitaurDerpy):
    """Like `MinitaurDerpy`, but from another file and with other knee constraints."""

    _file = "quadruped/minitaur_rainbow_dash.urdf"
    _long, _short = KNEE_CONSTRAINT_POINT_LONG, KNEE_CONSTRAINT_POINT_SHORT
