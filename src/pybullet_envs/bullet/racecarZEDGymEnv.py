"""An environment with a racing car that has a camera in front."""

from __future__ import annotations

from typing import Any

import numpy as np

from pybullet_envs._gymnasium import gymnasium
from pybullet_envs.bullet.racecarGymEnv import RENDER_HEIGHT, RENDER_WIDTH, RacecarGymEnv

__all__ = [
    "RENDER_HEIGHT",
    "RENDER_WIDTH",
    "RacecarZEDGymEnv",
]

_NEAR, _FAR, _HEIGHT = 0.3, 1.0, 0.3
_PROJECTION = (
    *(0.7499999403953552, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0),
    *(0.0, 0.0, -1.0000200271606445, -1.0, 0.0, 0.0, -0.02000020071864128, 0.0),
)


class RacecarZEDGymEnv(RacecarGymEnv):
    """Like `RacecarGymEnv`, but with images as observations.

    Observation: an image (10, 100, 4) of the view ahead.
    """

    _ball_file = "sphere2red.urdf"
    _stadium_height = 0.1
    _width, _height = 100, 10

    def __init__(
        self,
        urdfRoot: str | None = None,
        actionRepeat: int = 10,
        isEnableSelfCollision: bool = True,
        isDiscrete: bool = False,
        renders: bool = False,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment and its world; see `RacecarGymEnv`. PyBullet opens a window by default."""
        super().__init__(urdfRoot, actionRepeat, isEnableSelfCollision, isDiscrete, renders, render_mode)

    def _observations(self) -> gymnasium.spaces.Box:
        return gymnasium.spaces.Box(0, 255, (self._height, self._width, 4), np.uint8)

    def getExtendedObservation(self) -> np.ndarray:
        """The present image of the camera."""
        position, orientation = self._p.getBasePositionAndOrientation(self._racecar.racecarUniqueId)
        matrix = np.reshape(self._p.getMatrixFromQuaternion(orientation), (3, 3))
        x, y, z = position
        above = np.array((x, y, z + _HEIGHT))
        eye, target = above + _NEAR * matrix[:, 0], above + _FAR * matrix[:, 0]
        view = self._p.computeViewMatrix(eye, target, matrix[:, 2])
        picture: Any = self._p.getCameraImage(
            self._width, self._height, viewMatrix=view, projectionMatrix=_PROJECTION
        )[2]
        return np.reshape(picture, (self._height, self._width, 4)).astype(np.uint8)
