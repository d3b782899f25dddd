"""A racing car that drives to a ball."""

from __future__ import annotations

import os
import time
from math import cos, sin
from typing import Any

import gymnasium
import numpy as np

import pybullet_data
from pybullet_envs.bullet.racecar import Racecar
from pybullet_envs.env_bases import BulletEnv

_MOST_STEPS = 1000
_LOCK = 0.6


class RacecarGymEnv(BulletEnv):
    """A ball lies 5 to 7 m away; the nearer the car comes, the better.

    Observation: where the ball is, as the car sees it, forward and to the left [m]. Action: throttle and
    steering, within -1 and 1, or one of 9 choices: backward, stop, forward, each with left, straight, right.
    Reward: the distance of car and ball, negative.
    """

    picture_size = (960, 720)
    _camera = (3.0, 0.0, -30.0)
    _ball_file = "sphere2.urdf"
    _stadium_height = 0.0

    def __init__(
        self,
        urdfRoot: str | None = None,
        actionRepeat: int = 50,
        isEnableSelfCollision: bool = True,
        isDiscrete: bool = False,
        renders: bool = False,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment and its world.

        Args:
            urdfRoot: The folder of the files; that of `pybullet_data` where not given.
            actionRepeat: Steps of the simulation for each of the environment.
            isEnableSelfCollision: Kept, but of no effect.
            isDiscrete: Whether the action is one of 9 choices.
            renders: Whether to open a window.
            render_mode: `human`, `rgb_array` or none.
        """
        super().__init__(renders, render_mode)
        self._timeStep = 0.01
        self._urdfRoot = pybullet_data.getDataPath() if urdfRoot is None else urdfRoot
        self._actionRepeat = actionRepeat
        self._isEnableSelfCollision = isEnableSelfCollision
        self._isDiscrete = isDiscrete
        self._ballUniqueId = -1
        self._envStepCounter = 0
        self.action_space: gymnasium.spaces.Space[Any] = (
            gymnasium.spaces.Discrete(9) if isDiscrete else gymnasium.spaces.Box(-1.0, 1.0, (2,), np.float32)
        )
        self.observation_space = self._observations()
        self._connect()

    def _observations(self) -> gymnasium.spaces.Box:
        return gymnasium.spaces.Box(-1000.0, 1000.0, (2,), np.float32)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode with the ball in some direction."""
        super().reset(seed=seed)
        self._connect()
        bullet = self._p
        bullet.resetSimulation()
        bullet.setTimeStep(self._timeStep)
        for body in bullet.loadSDF(os.path.join(self._urdfRoot, "stadium.sdf")):
            (x, y, z), turn = bullet.getBasePositionAndOrientation(body)
            bullet.resetBasePositionAndOrientation(body, [x, y, z + self._stadium_height], turn)
        distance = self.np_random.uniform(5.0, 7.0)
        angle = self.np_random.uniform(0.0, 2.0 * 3.1415925438)
        self._ballUniqueId = bullet.loadURDF(
            os.path.join(self._urdfRoot, self._ball_file), [distance * sin(angle), distance * cos(angle), 1]
        )
        bullet.setGravity(0, 0, -10)
        self._racecar = Racecar(bullet, self._urdfRoot, self._timeStep)
        self._envStepCounter = 0
        for _ in range(100):
            bullet.stepSimulation()
        return self.getExtendedObservation(), {}

    def getExtendedObservation(self) -> np.ndarray:
        """What is observed now."""
        car = self._p.getBasePositionAndOrientation(self._racecar.racecarUniqueId)
        ball = self._p.getBasePositionAndOrientation(self._ballUniqueId)
        position, _ = self._p.multiplyTransforms(*self._p.invertTransform(*car), *ball)
        return np.array(position[:2], np.float32)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Drives on."""
        if self._isDiscrete:
            throttle, lock = divmod(int(action), 3)
            self._racecar.applyAction([throttle - 1, _LOCK * (lock - 1)])
        else:
            self._racecar.applyAction([float(value) for value in action])
        for _ in range(self._actionRepeat):
            self._p.stepSimulation()
            if self.render_mode == "human":
                time.sleep(self._timeStep)
            if self._termination():
                break
            self._envStepCounter += 1
        return self.getExtendedObservation(), self._reward(), self._termination(), False, {}

    def _looked_at(self) -> tuple[float, float, float]:
        return self._p.getBasePositionAndOrientation(self._racecar.racecarUniqueId)[0]

    def _termination(self) -> bool:
        return self._envStepCounter > _MOST_STEPS

    def _reward(self) -> float:
        points = self._p.getClosestPoints(self._racecar.racecarUniqueId, self._ballUniqueId, 10000)
        return -min(point[8] for point in points) if points else -1000.0
