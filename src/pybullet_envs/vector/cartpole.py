"""Vector environments with poles on carts that are pushed left or right."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom.checks import Array
from carom.worlds.chosen import Mask
from pybullet_envs.bullet.cartpole_bullet import CART, LARGEST_START, POLE, CartPoleBulletEnv
from pybullet_envs.vector.base import BulletVectorEnv


class CartPoleVectorEnv(BulletVectorEnv):
    """Poles to keep upright; see `pybullet_envs.bullet.cartpole_bullet.CartPoleBulletEnv`.

    Args:
        num_envs: Number of environments.
        discrete_actions: Whether to push with the full force to one side; otherwise, with any force.
        **options: Other arguments of `BulletVectorEnv`.
    """

    def __init__(self, num_envs: int = 1, *, discrete_actions: bool = True, **options: Any) -> None:
        self._discrete = discrete_actions
        super().__init__(CartPoleBulletEnv(discrete_actions=discrete_actions), num_envs, **options)

    def take(self, single: Any) -> None:
        """Find cart and pole."""
        self._body = self.worlds[single.cartpole]
        self._cart, self._pole = (self._body.joints[[joint]].columns.start for joint in (CART, POLE))  # type: ignore[union-attr]
        self._force = single.force_mag
        self._farthest, self._steepest = single.x_threshold, single.theta_threshold_radians

    def begin(self, worlds: np.ndarray) -> None:
        """Set positions and velocities of carts and poles to random values within ±0.05."""
        angle, rate, position, velocity = self.random.uniform(worlds, -LARGEST_START, LARGEST_START, 4).T
        for column, place, speed in ((self._pole, angle, rate), (self._cart, position, velocity)):
            self._body.joints.positions[worlds, column] = place
            self._body.joints.velocities[worlds, column] = speed

    def act(self, actions: np.ndarray) -> None:
        """Apply forces to the carts."""
        ways = np.where(actions == 1, 1.0, -1.0) if self._discrete else actions[:, 0] / self._force
        self._body.joints.torques[:, self._cart] = self._force * ways

    def observe(self) -> np.ndarray:
        """Angle and velocity of the pole, position and velocity of the cart."""
        positions, velocities = self._body.joints.positions, self._body.joints.velocities
        whole = np.empty((self.num_envs, 4), np.float32)
        for place, column in ((0, self._pole), (2, self._cart)):
            whole[:, place] = positions[:, column]
            whole[:, place + 1] = velocities[:, column]
        return whole

    def reward(self, actions: np.ndarray) -> Array:
        """1 for each step."""
        return np.ones(self.num_envs)

    def terminated(self) -> Mask:
        """Where the pole has fallen or the cart has left its track."""
        positions = np.abs(self._body.joints.positions)
        return (positions[:, self._cart] > self._farthest) | (positions[:, self._pole] > self._steepest)


class CartPoleContinuousVectorEnv(CartPoleVectorEnv):
    """The same, but with any force up to 10 N."""

    def __init__(self, num_envs: int = 1, **options: Any) -> None:
        super().__init__(num_envs, discrete_actions=False, **options)
