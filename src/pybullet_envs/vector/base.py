"""Base class of the vector environments: copies of the world of a single environment."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode

from carom.camera import Camera
from carom.vector.worlds_env import WorldsEnv
from carom.world.world import World
from pybullet._clients.clients import client_of
from pybullet_envs.env_bases import BulletEnv

# The same as in `BulletEnv.render`.
_FIELD_OF_VIEW, _NEAR, _FAR = 60.0, 0.1, 100.0
LARGEST_ACTION = 1.0


class BulletVectorEnv(WorldsEnv):
    """Copies of the world of a single environment.

    Args:
        single: A single environment; it is closed, unless it is needed later.
        num_envs: Number of environments.
        max_episode_steps: Number of steps after which an episode is truncated; None for never.
        autoreset_mode: When environments are reset after an episode; see `carom.vector.WorldsEnv`.
        threads: Number of threads; None for the number of processors.
        render_mode: "rgb_array" or None.
    """

    def __init__(
        self,
        single: BulletEnv,
        num_envs: int = 1,
        *,
        max_episode_steps: int | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
        render_mode: str | None = None,
    ) -> None:
        # Any seed will do: each episode sets again whatever depends on it.
        single.reset(seed=0)
        super().__init__(
            world_of(single),
            num_envs,
            single.observation_space,  # type: ignore[arg-type]
            single.action_space,
            max_episode_steps=max_episode_steps,
            autoreset_mode=autoreset_mode,
            threads=threads,
            render_mode=render_mode,
            camera=_camera_of(single) if render_mode is not None else None,
        )
        self.take(single)
        if not self._asks:
            single.close()

    _asks = False
    """Whether the single environment is kept, for computations that exist for one world only."""

    @abstractmethod
    def take(self, single: Any) -> None:
        """Take the parameters, bodies and joints that are needed from the single environment."""


def world_of(single: BulletEnv) -> World:
    """The world of a single environment."""
    return client_of(single._p._client).world


def held(actions: np.ndarray) -> np.ndarray:
    """Actions, clipped to -1 and 1."""
    return np.clip(actions, -LARGEST_ACTION, LARGEST_ACTION)


def _camera_of(single: BulletEnv) -> Camera:
    """A camera with the initial view of the single environment's `render`."""
    width, height = single.picture_size
    distance, yaw, pitch = single._camera
    target = single._looked_at()
    view = np.reshape(
        single._p.computeViewMatrixFromYawPitchRoll(target, distance, yaw, pitch, 0.0, 2), (4, 4)
    ).T
    eye = -view[:3, :3].T @ view[:3, 3]
    camera = Camera.with_field_of_view(width, height, _FIELD_OF_VIEW, near=_NEAR, far=_FAR)
    return camera.look_at(eye, target)
