"""An arm in the plane that reaches for a target."""

from __future__ import annotations

from math import cos, sin
from typing import Any

import numpy as np

from pybullet_envs.env_bases import checked
from pybullet_envs.robot_bases import MJCFEnv

_TARGET_REACH = 0.27
_TURN = 3.14


class ReacherBulletEnv(MJCFEnv):
    """Two links whose tip is to come to a target, driven with up to 0.05 N m.

    Observation: the target (x, y), the way from it to the tip (x, y), cosine, sine and rate of the first
    joint, position and rate of the second. Reward: 100 times the way come nearer, less the effort.
    """

    model, robot_name = "reacher.xml", "body0"
    observation_count, action_count = 9, 2
    gravity = 0.0
    torque = 0.05

    def _place(self) -> None:
        motors = self.parts.motors
        for name in ("target_x", "target_y", "joint0", "joint1"):
            reach = _TURN if name.startswith("joint") else _TARGET_REACH
            motors[name].place(self.np_random.uniform(-reach, reach))
        self._distance = self._way()[1]

    def _way(self) -> tuple[np.ndarray, float]:
        """From the target to the tip, and how long that is [m]."""
        way = self.parts.links["fingertip"].pose()[0] - self.parts.links["target"].pose()[0]
        return way, float(np.linalg.norm(way))

    def _observe(self) -> np.ndarray:
        motors = self.parts.motors
        turn, rate = motors["joint0"].relative_state()
        bend, bend_rate = motors["joint1"].relative_state()
        target = [motors[name].state()[0] for name in ("target_x", "target_y")]
        way = self._way()[0]
        return np.array([*target, way[0], way[1], cos(turn), sin(turn), rate, bend, bend_rate], np.float32)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Turns the joints for a step."""
        given = np.asarray(action, dtype=float)
        for name, share in zip(("joint0", "joint1"), checked(action), strict=True):
            self.parts.motors[name].drive(self.torque * share)
        self._p.stepSimulation()
        before, self._distance = self._distance, self._way()[1]
        rates = np.array([self.parts.motors[name].relative_state()[1] for name in ("joint0", "joint1")])
        effort = 0.1 * float(np.abs(given * rates).sum()) + 0.01 * float(np.abs(given).sum())
        bend = self.parts.motors["joint1"].relative_state()[0]
        stuck = 0.1 if abs(abs(bend) - 1.0) < 0.01 else 0.0
        return self._observe(), 100.0 * (before - self._distance) - effort - stuck, False, False, {}
