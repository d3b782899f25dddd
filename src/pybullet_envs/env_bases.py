"""What all environments share: a world of their own, and pictures of it."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np

import pybullet
from pybullet_utils.bullet_client import BulletClient

Place = tuple[float, float, float]


class BulletEnv(gymnasium.Env[np.ndarray, Any]):
    """An environment with a world of its own, made at the first `reset`.

    Attributes:
        picture_size: Width and height of the pictures of `render`.
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 60}  # noqa: RUF012  # as Gymnasium has it
    picture_size = (320, 240)
    _camera = (3.0, 0.0, -30.0)
    """Distance [m], yaw and pitch [degrees] of the camera."""

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        """Makes an environment.

        Args:
            render: Whether to open a window, as `render_mode="human"` does.
            render_mode: `human`, `rgb_array` or none.
        """
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(f"render_mode is {render_mode!r}, none of {self.metadata['render_modes']}")
        self.render_mode = "human" if render and render_mode is None else render_mode
        self._p: Any = None

    def _connect(self) -> bool:
        """Makes the world if there is none; tells whether it is new."""
        if self._p is not None:
            return False
        self._p = BulletClient(pybullet.GUI if self.render_mode == "human" else pybullet.DIRECT)
        return True

    def _looked_at(self) -> Place:
        """What the camera looks at."""
        return (0.0, 0.0, 0.0)

    def render(self) -> np.ndarray | None:  # type: ignore[override]
        """A picture (height, width, 3) where `render_mode` is `rgb_array`; white before `reset`."""
        if self.render_mode != "rgb_array":
            return None
        width, height = self.picture_size
        if self._p is None:
            return np.full((height, width, 3), 255, np.uint8)
        distance, yaw, pitch = self._camera
        view = self._p.computeViewMatrixFromYawPitchRoll(self._looked_at(), distance, yaw, pitch, 0.0, 2)
        projection = self._p.computeProjectionMatrixFOV(60.0, width / height, 0.1, 100.0)
        picture = self._p.getCameraImage(width, height, view, projection)[2]
        return np.reshape(picture, (height, width, -1))[:, :, :3].astype(np.uint8)

    def close(self) -> None:
        """Ends the world; the next `reset` makes a new one."""
        if self._p is not None:
            self._p.disconnect()
            self._p = None


def checked(action: Any) -> np.ndarray:
    """The action, held within -1 and 1.

    Raises:
        ValueError: A number is not finite.
    """
    values = np.asarray(action, dtype=float)
    if not np.isfinite(values).all():
        raise ValueError(f"the action {action!r} has a number that is not finite")
    return np.clip(values, -1.0, 1.0)
