"""Vector environments with poles on carts."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom.checks import Array
from carom.worlds.chosen import Mask
from pybullet_envs.gym_pendulum_envs import (
    InvertedDoublePendulumBulletEnv,
    InvertedPendulumBulletEnv,
    InvertedPendulumSwingupBulletEnv,
)
from pybullet_envs.robot_pendula import HANGING, LARGEST_START
from pybullet_envs.vector.base import BulletVectorEnv, held
from pybullet_envs.vector.parts import Joints, Part


class _CartVectorEnv(BulletVectorEnv):
    _single: Any

    def __init__(self, num_envs: int = 1, **options: Any) -> None:
        """Makes the environments; see `BulletVectorEnv`."""
        super().__init__(self._single(), num_envs, **options)

    def take(self, single: Any) -> None:
        """Find cart and poles."""
        robot = single.robot
        self._push = robot.push
        self._slider = Joints(self.worlds, robot.ordered_joints[:1])
        self._hinges = Joints(self.worlds, robot.ordered_joints[1:])
        self._fallen = single.fallen

    def act(self, actions: np.ndarray) -> None:
        """Apply forces to the carts."""
        self._slider.push(self._push * held(actions))

    def _observe(self, extra: int) -> np.ndarray:
        """Values of cart and hinges, with room for `extra` numbers between them."""
        count, first = self._hinges.count, 2 + extra
        whole = np.empty((self.num_envs, first + 3 * count), np.float32)
        whole[:, 0] = self._slider.positions()[:, 0]
        whole[:, 1] = self._slider.velocities()[:, 0]
        self._angles = self._hinges.positions().copy()
        whole[:, first::3] = np.cos(self._angles)
        whole[:, first + 1 :: 3] = np.sin(self._angles)
        whole[:, first + 2 :: 3] = self._hinges.velocities()
        return whole


class InvertedPendulumVectorEnv(_CartVectorEnv):
    """Poles to keep upright; see `pybullet_envs.gym_pendulum_envs.InvertedPendulumBulletEnv`."""

    _single = InvertedPendulumBulletEnv
    _offset = 0.0

    def begin(self, worlds: np.ndarray) -> None:
        """Place the poles near upright or, in the swing-up, near hanging."""
        offsets = self.random.uniform(worlds, -LARGEST_START, LARGEST_START, 1)
        self._hinges.put(worlds, offsets + self._offset)

    def observe(self) -> np.ndarray:
        """Position and velocity of the cart; cosine, sine and velocity of the pole's angle."""
        return self._observe(0)

    def reward(self, actions: np.ndarray) -> Array:
        """1 for each step."""
        return np.ones(self.num_envs)

    def terminated(self) -> Mask:
        """Where the pole has fallen."""
        return np.abs(self._angles[:, 0]) > self._fallen


class InvertedPendulumSwingupVectorEnv(InvertedPendulumVectorEnv):
    """Poles to swing up; the reward of each step is the cosine of the angle from upright."""

    _single = InvertedPendulumSwingupBulletEnv
    _offset = HANGING

    def reward(self, actions: np.ndarray) -> Array:
        """The cosine of the angle."""
        return np.cos(self._angles[:, 0])

    def terminated(self) -> Mask:
        """No environment."""
        return np.zeros(self.num_envs, dtype=bool)


class InvertedDoublePendulumVectorEnv(_CartVectorEnv):
    """Two poles, one on the other; see `pybullet_envs.gym_pendulum_envs.InvertedDoublePendulumBulletEnv`."""

    _single = InvertedDoublePendulumBulletEnv

    def take(self, single: Any) -> None:
        """Find cart and poles."""
        super().take(single)
        self._pole = Part(self.worlds, single.robot.pole2)
        self._to_tip, self._aim = single.to_tip, single.aim

    def begin(self, worlds: np.ndarray) -> None:
        """Place both poles near upright."""
        self._hinges.put(worlds, self.random.uniform(worlds, -LARGEST_START, LARGEST_START, 2))

    def observe(self) -> np.ndarray:
        """Values of the cart, x of the upper pole, values of both angles."""
        whole = self._observe(1)
        self._place = self._pole.poses()[:, :3]
        whole[:, 2] = self._place[:, 0]
        self._tip = self._place[:, 2] + self._to_tip
        return whole

    def reward(self, actions: np.ndarray) -> Array:
        """10, minus the squared height error of the tip [m], minus 0.01 times the squared x of the pole."""
        return 10.0 + (-0.01 * self._place[:, 0] ** 2 - (self._tip - self._aim) ** 2)

    def terminated(self) -> Mask:
        """Where the tip is too low."""
        return self._tip <= self._fallen
