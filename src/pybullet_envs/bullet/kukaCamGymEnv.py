"""An environment with a grasping KUKA that is observed by a camera."""

from __future__ import annotations

from typing import Any

import numpy as np

from pybullet_envs._gymnasium import gymnasium
from pybullet_envs.bullet.kukaGymEnv import RENDER_HEIGHT, RENDER_WIDTH, KukaGymEnv

__all__ = [
    "RENDER_HEIGHT",
    "RENDER_WIDTH",
    "KukaCamGymEnv",
    "maxSteps",
]

maxSteps = 1000

_VIEW = (
    *(-0.5120397806167603, 0.7171027660369873, -0.47284144163131714, 0.0),
    *(-0.8589617609977722, -0.42747554183006287, 0.28186774253845215, 0.0),
    *(0.0, 0.5504802465438843, 0.8348482847213745, 0.0),
    *(0.1925382763147354, -0.24935829639434814, -0.4401884973049164, 1.0),
)
_PROJECTION = (
    *(0.75, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0),
    *(0.0, 0.0, -1.0000200271606445, -1.0, 0.0, 0.0, -0.02000020071864128, 0.0),
)


class KukaCamGymEnv(KukaGymEnv):
    """Like `KukaGymEnv`, but with images as observations, steps twice as long, and no cost of turning.

    Observation: an image (256, 341, 4) of the tray.
    """

    _step_size = 0.01
    _turn_size = 0.1
    _turn_cost = 0.0
    _success = 1000.0
    _block_ranges = ((0.5, 0.7), (0.0, 0.25), (0.0, 3.1415925438))
    _block_height = -0.1
    _width, _height = 341, 256

    def __init__(
        self,
        urdfRoot: str | None = None,
        actionRepeat: int = 1,
        isEnableSelfCollision: bool = True,
        renders: bool = False,
        isDiscrete: bool = False,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment and its world; see `KukaGymEnv`."""
        super().__init__(
            urdfRoot, actionRepeat, isEnableSelfCollision, renders, isDiscrete, render_mode=render_mode
        )

    def _observations(self) -> gymnasium.spaces.Box:
        return gymnasium.spaces.Box(0, 255, (self._height, self._width, 4), np.uint8)

    def getExtendedObservation(self) -> np.ndarray:
        """The present image of the camera."""
        picture: Any = self._p.getCameraImage(
            self._width, self._height, viewMatrix=_VIEW, projectionMatrix=_PROJECTION
        )[2]
        return np.reshape(picture, (self._height, self._width, 4)).astype(np.uint8)
