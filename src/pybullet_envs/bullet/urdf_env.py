"""Base class of the environments with the KUKA and with the racing car."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

import numpy as np

import pybullet_data
from pybullet_envs._gymnasium import gymnasium
from pybullet_envs.env_bases import BulletEnv

# Size of the images of `render` [pixels].
RENDER_HEIGHT, RENDER_WIDTH = 720, 960


class UrdfEnv(BulletEnv, ABC):
    """A robot and objects from the files of a folder, with continuous or discrete actions."""

    picture_size = (RENDER_WIDTH, RENDER_HEIGHT)
    _timeStep: float
    """Time step of the simulation [s]."""

    def __init__(
        self,
        urdfRoot: str | None,
        actionRepeat: int,
        isEnableSelfCollision: bool,
        renders: bool,
        isDiscrete: bool,
        render_mode: str | None,
    ) -> None:
        """Makes the environment and its world.

        Args:
            urdfRoot: Folder of the files; by default that of `pybullet_data`.
            actionRepeat: Number of simulation steps per environment step.
            isEnableSelfCollision: No effect.
            renders: Whether to open a window.
            isDiscrete: Whether an action is one of several choices.
            render_mode: `human`, `rgb_array` or none.
        """
        super().__init__(renders, render_mode)
        self._urdfRoot = pybullet_data.getDataPath() if urdfRoot is None else urdfRoot
        self._actionRepeat = actionRepeat
        self._isEnableSelfCollision = isEnableSelfCollision
        self._isDiscrete = isDiscrete
        self._envStepCounter = 0
        self.action_space = self._actions()
        self.observation_space = self._observations()
        self._connect()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode."""
        super().reset(seed=seed)
        self._connect()
        self._begin()
        return self.getExtendedObservation(), {}

    @abstractmethod
    def _actions(self) -> gymnasium.spaces.Space[Any]:
        """The space of actions."""

    @abstractmethod
    def _observations(self) -> gymnasium.spaces.Box:
        """The space of observations."""

    @abstractmethod
    def _begin(self) -> None:
        """Builds the world again, at the start of an episode."""

    @abstractmethod
    def getExtendedObservation(self) -> np.ndarray:
        """The present observation."""
