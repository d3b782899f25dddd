"""A single environment made from a vector environment."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode

from carom.vector.worlds_env import WorldsEnv


class SingleEnv(gymnasium.Env[np.ndarray, Any]):
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
        pace = self.many.steps * self.many.worlds.time_step
        self.metadata = {"render_modes": ["rgb_array"], "render_fps": round(1.0 / pace)}
        self.observation_space = self.many.single_observation_space
        self.action_space = self.many.single_action_space
        self.render_mode = self.many.render_mode

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Start an episode."""
        super().reset(seed=seed)
        self.many.random.generators[0] = self.np_random
        observations, infos = self.many.reset()
        return observations[0], _own(infos)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Take a step."""
        observations, rewards, terminations, truncations, infos = self.many.step(np.asarray(action)[None])
        return observations[0], float(rewards[0]), bool(terminations[0]), bool(truncations[0]), _own(infos)

    def render(self) -> np.ndarray | None:  # type: ignore[override]
        """An image (height, width, 3) if `render_mode` is "rgb_array"."""
        pictures = self.many.render()
        return None if pictures is None else pictures[0]

    def close(self) -> None:
        """Close the environment."""
        self.many.close()


def _own(infos: dict[str, Any]) -> dict[str, Any]:
    return {name: values[0] for name, values in infos.items()}
