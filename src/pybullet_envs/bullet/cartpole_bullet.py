"""Environments with a pole on a cart that is pushed left or right."""

from __future__ import annotations

import os
from math import pi
from typing import Any

import numpy as np

import pybullet
import pybullet_data
from pybullet_envs._gymnasium import gymnasium
from pybullet_envs.env_bases import BulletEnv

CART, POLE = 0, 1
LARGEST_START = 0.05


class CartPoleBulletEnv(BulletEnv):
    """A pole to keep upright; the reward is 1 per step, until the pole falls or the cart leaves its track.

    Observation: angle and velocity of the pole, position and velocity of the cart. Action: 0 pushes with 10 N
    to one side, 1 to the other.
    """

    picture_size = (320, 200)
    _camera = (2.0, 0.0, 0.3)
    force_mag = 10.0
    theta_threshold_radians = 12 * 2 * pi / 360
    x_threshold = 0.4
    time_step = 0.02

    def __init__(
        self, renders: bool = False, discrete_actions: bool = True, render_mode: str | None = None
    ) -> None:
        """Makes an environment.

        Args:
            renders: Whether to open a window.
            discrete_actions: Whether to push with the full force to one side; otherwise, with any force.
            render_mode: `human`, `rgb_array` or none.
        """
        super().__init__(renders, render_mode)
        most = np.finfo(np.float32).max
        high = np.array([self.x_threshold * 2, most, self.theta_threshold_radians * 2, most], np.float32)
        self.observation_space = gymnasium.spaces.Box(-high, high, dtype=np.float32)
        force = np.array([self.force_mag], np.float32)
        self._discrete = discrete_actions
        self.action_space: gymnasium.spaces.Space[Any] = (
            gymnasium.spaces.Discrete(2) if discrete_actions else gymnasium.spaces.Box(-force, force)
        )

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode, with random positions and velocities within ±0.05."""
        super().reset(seed=seed)
        if self._connect():
            self._load()
        angle, rate, position, velocity = self.np_random.uniform(-LARGEST_START, LARGEST_START, 4)
        self._p.resetJointState(self.cartpole, POLE, angle, rate)
        self._p.resetJointState(self.cartpole, CART, position, velocity)
        return self._observe(), {}

    def _load(self) -> None:
        bullet = self._p
        self.cartpole = bullet.loadURDF(os.path.join(pybullet_data.getDataPath(), "cartpole.urdf"))
        for link in (-1, CART, POLE):
            bullet.changeDynamics(self.cartpole, link, linearDamping=0, angularDamping=0)
        for joint in (CART, POLE):
            bullet.setJointMotorControl2(self.cartpole, joint, pybullet.VELOCITY_CONTROL, force=0)
        bullet.setGravity(0, 0, -9.8)
        bullet.setTimeStep(self.time_step)

    def _observe(self) -> np.ndarray:
        pole, cart = (self._p.getJointState(self.cartpole, joint)[:2] for joint in (POLE, CART))
        return np.array([*pole, *cart], np.float32)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Applies an action for one step."""
        way = (1.0 if action == 1 else -1.0) if self._discrete else float(action[0]) / self.force_mag
        force = self.force_mag * way
        self._p.setJointMotorControl2(self.cartpole, CART, pybullet.TORQUE_CONTROL, force=force)
        self._p.stepSimulation()
        angle = self._p.getJointState(self.cartpole, POLE)[0]
        position = self._p.getJointState(self.cartpole, CART)[0]
        done = abs(position) > self.x_threshold or abs(angle) > self.theta_threshold_radians
        return self._observe(), 1.0, done, False, {}


class CartPoleContinuousBulletEnv(CartPoleBulletEnv):
    """The same, but with any force up to 10 N."""

    def __init__(self, renders: bool = False, render_mode: str | None = None) -> None:
        """Makes an environment; see `CartPoleBulletEnv`."""
        super().__init__(renders, discrete_actions=False, render_mode=render_mode)
