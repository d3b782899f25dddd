"""An environment with a racing car that drives to a ball."""

from __future__ import annotations

import os
import time
from math import cos, sin
from typing import Any

import numpy as np

from pybullet_envs._gymnasium import gymnasium
from pybullet_envs.bullet.racecar import Racecar
from pybullet_envs.bullet.urdf_env import RENDER_HEIGHT, RENDER_WIDTH, UrdfEnv

__all__ = [
    "RENDER_HEIGHT",
    "RENDER_WIDTH",
    "RacecarGymEnv",
]

_MAX_STEPS = 1000
_LOCK = 0.6


class RacecarGymEnv(UrdfEnv):
    """A racing car drives to a ball 5 to 7 m away.

    Observation: position of the ball in the car's frame, forward and to the left [m]. Action: throttle and
    steering, from -1 to 1, or one of 9 choices: backward, stop, forward, each with left, straight, right.
    Reward: the negative distance of car and ball [m].
    """

    _timeStep = 0.01
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
        """Makes the environment and its world; see `UrdfEnv`.

        Args:
            urdfRoot: Folder of the files.
            actionRepeat: Number of simulation steps per environment step.
            isEnableSelfCollision: No effect.
            isDiscrete: Whether the action is one of 9 choices.
            renders: Whether to open a window.
            render_mode: `human`, `rgb_array` or none.
        """
        super().__init__(urdfRoot, actionRepeat, isEnableSelfCollision, renders, isDiscrete, render_mode)
        self._ballUniqueId = -1

    def _actions(self) -> gymnasium.spaces.Space[Any]:
        if self._isDiscrete:
            return gymnasium.spaces.Discrete(9)
        return gymnasium.spaces.Box(-1.0, 1.0, (2,), np.float32)

    def _observations(self) -> gymnasium.spaces.Box:
        return gymnasium.spaces.Box(-1000.0, 1000.0, (2,), np.float32)

    def _begin(self) -> None:
        """Builds the world, with the ball in a random direction."""
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

    def getExtendedObservation(self) -> np.ndarray:
        """The present observation."""
        car = self._p.getBasePositionAndOrientation(self._racecar.racecarUniqueId)
        ball = self._p.getBasePositionAndOrientation(self._ballUniqueId)
        position, _ = self._p.multiplyTransforms(*self._p.invertTransform(*car), *ball)
        return np.array(position[:2], np.float32)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Applies an action for one step."""
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
        return self._envStepCounter > _MAX_STEPS

    def _reward(self) -> float:
        points = self._p.getClosestPoints(self._racecar.racecarUniqueId, self._ballUniqueId, 10000)
        return -points[0][8] if points else -1000.0
