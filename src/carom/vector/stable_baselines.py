"""The vector environment that Stable-Baselines3 trains on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode

try:
    from stable_baselines3.common.vec_env import VecEnv
except ImportError as missing:
    raise ImportError(
        "carom.vector.stable_baselines needs Stable-Baselines3; install it with: pip install 'carom[train]'",
        name="stable_baselines3",
    ) from missing

from carom.vector.worlds_env import WorldsEnv


class StableBaselinesEnv(VecEnv):
    """A `WorldsEnv` as a vector environment of Stable-Baselines3.

    Attributes:
        env: The vector environment.

    Args:
        env: An environment whose `autoreset_mode` is `SAME_STEP`, from its class or `gymnasium.make_vec`.

    Raises:
        ValueError: The environment is not a `WorldsEnv`, or its `autoreset_mode` is another.
    """

    def __init__(self, env: Any) -> None:
        inner = env.unwrapped
        if not isinstance(inner, WorldsEnv) or inner.autoreset_mode != AutoresetMode.SAME_STEP:
            raise ValueError(
                "Stable-Baselines3 trains on a WorldsEnv that begins episodes in the same step: "
                "make it with autoreset_mode='SameStep'"
            )
        self.env = inner
        self.render_mode = inner.render_mode
        self._actions = np.zeros(0)
        super().__init__(inner.num_envs, inner.single_observation_space, inner.single_action_space)

    def reset(self) -> np.ndarray:  # type: ignore[override]
        """Start all episodes. Seeds set by `seed` are used once."""
        seeds: list[int | None] = list(self._seeds)
        observations, _ = self.env.reset(seed=seeds)
        self._reset_seeds()
        self._reset_options()
        return observations

    def step_async(self, actions: np.ndarray) -> None:
        """Keep the actions for `step_wait`."""
        self._actions = actions

    def step_wait(self) -> Any:
        """Take a step; return observations, rewards, a mask of ended episodes, and a list of infos."""
        observations, rewards, terminations, truncations, told = self.env.step(self._actions)
        over = terminations | truncations
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for world in np.flatnonzero(over):
            infos[world]["terminal_observation"] = told["final_obs"][world]
            infos[world]["TimeLimit.truncated"] = bool(truncations[world] and not terminations[world])
        return observations, rewards.astype(np.float32), over, infos

    def close(self) -> None:
        """Close the environment."""
        self.env.close()

    def get_images(self) -> Sequence[np.ndarray | None]:
        """The images of `render`, one for each environment."""
        pictures = self.env.render()
        return [None] * self.num_envs if pictures is None else list(pictures)

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """An attribute of the vector environment, once for each index."""
        return [getattr(self.env, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Set an attribute of the vector environment; `indices` must select all environments."""
        self._require_all(indices, attr_name)
        setattr(self.env, attr_name, value)

    def env_method(
        self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any
    ) -> list[Any]:
        """Call a method of the vector environment once; `indices` must select all environments."""
        self._require_all(indices, method_name)
        return [getattr(self.env, method_name)(*method_args, **method_kwargs)] * self.num_envs

    def env_is_wrapped(self, wrapper_class: type, indices: Any = None) -> list[bool]:
        """False for all: there are no single environments to wrap."""
        return [False] * len(list(self._get_indices(indices)))

    def _require_all(self, indices: Any, name: str) -> None:
        if len(list(self._get_indices(indices))) != self.num_envs:
            raise ValueError(f"{name} belongs to all environments at once; leave indices out")
