"""A single environment made from a vector environment."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode

from carom.vector.infos import own_infos
from carom.vector.observations import own_observation
from carom.vector.worlds_env import WorldsEnv


class SingleEnv(gymnasium.Env[Any, Any]):
    """A `WorldsEnv` of one environment as a single `gymnasium.Env`.

    With the seed s + k it behaves like environment k of a vector environment with the seed s.

    Attributes:
        many: The vector environment.

    Args:
        make: A subclass of `WorldsEnv`, or a function that makes a `WorldsEnv`.
        options: Its arguments, except `num_envs`, `autoreset_mode` and `threads`.
    """

    def __init__(self, make: Any, **options: Any) -> None:
        self.many: WorldsEnv = make(num_envs=1, autoreset_mode=AutoresetMode.DISABLED, threads=1, **options)
        self.metadata = {name: self.many.metadata[name] for name in ("render_modes", "render_fps")}
        self.observation_space = self.many.single_observation_space
        self.action_space = self.many.single_action_space
        self.render_mode = self.many.render_mode

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start an episode."""
        super().reset(seed=seed)
        self.many.random.generators[0] = self.np_random
        observations, infos = self.many.reset()
        return own_observation(observations, 0), own_infos(infos, 0)

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Take a step."""
        observations, rewards, terminations, truncations, infos = self.many.step(np.asarray(action)[None])
        return (
            own_observation(observations, 0),
            float(rewards[0]),
            bool(terminations[0]),
            bool(truncations[0]),
            own_infos(infos, 0),
        )

    def render(self) -> np.ndarray | None:  # type: ignore[override]
        """An image (height, width, 3) if `render_mode` is "rgb_array"."""
        pictures = self.many.render()
        return None if pictures is None else pictures[0]

    def close(self) -> None:
        """Close the environment."""
        self.many.close()
