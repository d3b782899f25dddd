"""What the environments of the KUKA and of the racing car have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

import numpy as np

import pybullet_data
from pybullet_envs._gymnasium import gymnasium
from pybullet_envs.env_bases import BulletEnv


class UrdfEnv(BulletEnv, ABC):
    """A robot among things from the files of a folder, driven by numbers or by one of several choices."""

    picture_size = (960, 720)
    _timeStep: float
    """Of the simulation [s]."""

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
            urdfRoot: The folder of the files; that of `pybullet_data` where not given.
            actionRepeat: Steps of the simulation for each of the environment.
            isEnableSelfCollision: Kept, but of no effect.
            renders: Whether to open a window.
            isDiscrete: Whether the action is one of several choices.
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
        """Builds the world anew, as an episode begins."""

    @abstractmethod
    def getExtendedObservation(self) -> np.ndarray:
        """What is observed now."""
