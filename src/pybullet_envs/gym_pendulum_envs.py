"""Poles on a cart."""

from __future__ import annotations

from math import cos, sin
from typing import Any

import numpy as np

from pybullet_envs.env_bases import checked
from pybullet_envs.robot_bases import MJCFEnv

_LARGEST_START = 0.1
"""Poles begin so far from upright at most [rad]."""


class InvertedPendulumBulletEnv(MJCFEnv):
    """A pole to keep upright by pushing the cart with up to 100 N; a point for each step that it stands.

    Observation: position and velocity of the cart, cosine, sine and rate of the pole's angle.
    """

    model, robot_name = "inverted_pendulum.xml", "cart"
    observation_count, action_count = 5, 1
    push = 100.0
    swingup = False
    _fallen = 0.2

    def _place(self) -> None:
        offset = self.np_random.uniform(-_LARGEST_START, _LARGEST_START)
        # As PyBullet has it: half a turn to four digits.
        self.parts.motors["hinge"].place(offset + (3.1415 if self.swingup else 0.0))

    def _observe(self) -> np.ndarray:
        position, velocity = self.parts.motors["slider"].state()
        angle, rate = self.parts.motors["hinge"].state()
        return np.array([position, velocity, cos(angle), sin(angle), rate], np.float32)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Pushes the cart for a step."""
        self.parts.motors["slider"].drive(self.push * checked(action)[0])
        self._p.stepSimulation()
        angle = self.parts.motors["hinge"].state()[0]
        if self.swingup:
            return self._observe(), cos(angle), False, False, {}
        return self._observe(), 1.0, abs(angle) > self._fallen, False, {}


class InvertedPendulumSwingupBulletEnv(InvertedPendulumBulletEnv):
    """A pole that hangs at first; each step rewards the cosine of its angle from upright."""

    swingup = True


class InvertedDoublePendulumBulletEnv(MJCFEnv):
    """Two poles, one on the other, to keep upright by pushing the cart with up to 200 N.

    Observation: position and velocity of the cart, where the upper pole is, and cosine, sine and rate of both
    angles. Reward: 10 less the squared distance of the tip from its highest place.
    """

    model, robot_name = "inverted_double_pendulum.xml", "cart"
    observation_count, action_count = 9, 1
    push = 200.0
    # From the centre of the upper pole to its tip, and how high the tip is to be [m].
    _to_tip, _aim, _fallen = 0.3, 2.0, 1.0

    def _place(self) -> None:
        offsets = self.np_random.uniform(-_LARGEST_START, _LARGEST_START, 2)
        for name, offset in zip(("hinge", "hinge2"), offsets, strict=True):
            self.parts.motors[name].place(float(offset))

    def _observe(self) -> np.ndarray:
        position, velocity = self.parts.motors["slider"].state()
        pole = self.parts.links["pole2"].pose()[0]
        angles = [self.parts.motors[name].state() for name in ("hinge", "hinge2")]
        turns = [value for angle, rate in angles for value in (cos(angle), sin(angle), rate)]
        return np.array([position, velocity, pole[0], *turns], np.float32)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Pushes the cart for a step."""
        self.parts.motors["slider"].drive(self.push * checked(action)[0])
        self._p.stepSimulation()
        x, _, z = self.parts.links["pole2"].pose()[0]
        tip = float(z) + self._to_tip
        reward = 10.0 - 0.01 * float(x) ** 2 - (tip - self._aim) ** 2
        return self._observe(), reward, tip <= self._fallen, False, {}
