"""The vector environment that Stable-Baselines3 trains on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv, VectorWrapper

try:
    from stable_baselines3.common.vec_env import VecEnv
except ImportError as missing:
    raise ImportError(
        "carom.vector.stable_baselines needs Stable-Baselines3; install it with: pip install 'carom[train]'",
        name="stable_baselines3",
    ) from missing

from carom.vector.infos import own_infos
from carom.vector.worlds_env import WorldsEnv


class StableBaselinesEnv(VecEnv):
    """A `WorldsEnv` as a vector environment of Stable-Baselines3.

    Gymnasium's vector wrappers around it stay in place: what they do to actions, observations, rewards and
    infos is what Stable-Baselines3 trains on. Those that do not know episodes that begin in the same step
    refuse such an environment themselves (`NormalizeObservation`); Stable-Baselines3's `VecNormalize` does
    the same on the outside.

    Each environment's infos are its own entries of the vector environment's: those of an episode's last step
    are of that step.

    Attributes:
        env: The vector environment, with its wrappers.

    Args:
        env: An environment whose `autoreset_mode` is `SAME_STEP`, from its class or `gymnasium.make_vec`, in
            any number of wrappers.

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
        self.env: VectorEnv[Any, Any, Any] = env
        self.render_mode = env.render_mode
        self._actions = np.zeros(0)
        super().__init__(env.num_envs, env.single_observation_space, env.single_action_space)

    def reset(self) -> np.ndarray:  # type: ignore[override]
        """Start all episodes. Seeds set by `seed` are used once."""
        seeds: list[int | None] = list(self._seeds)
        # Lists of seeds are typed in Gymnasium's own vector environments only.
        observations, reported = self.env.reset(seed=seeds)  # type: ignore[arg-type]
        self.reset_infos = [own_infos(reported, world) for world in range(self.num_envs)]
        self._reset_seeds()
        self._reset_options()
        return observations

    def step_async(self, actions: np.ndarray) -> None:
        """Keep the actions for `step_wait`."""
        self._actions = actions

    def step_wait(self) -> Any:
        """Take a step; return observations, rewards, a mask of ended episodes, and a list of infos."""
        observations, rewards, terminations, truncations, reported = self.env.step(self._actions)
        over = terminations | truncations
        infos = [own_infos(reported, world) for world in range(self.num_envs)]
        for world in np.flatnonzero(over):
            last = infos[world]
            last.update(last.pop("final_info", {}))
            last["terminal_observation"] = last.pop("final_obs")
            infos[world]["TimeLimit.truncated"] = bool(truncations[world] and not terminations[world])
        return observations, np.asarray(rewards, dtype=np.float32), over, infos

    def close(self) -> None:
        """Close the environment."""
        self.env.close()

    def get_images(self) -> Sequence[np.ndarray | None]:
        """The images of `render`, one for each environment."""
        pictures: Any = self.env.render()
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
        """Whether one of the wrappers around the vector environment is of a class, once for each index."""
        layer: Any = self.env
        while isinstance(layer, VectorWrapper) and not isinstance(layer, wrapper_class):
            layer = layer.env
        return [isinstance(layer, wrapper_class)] * len(list(self._get_indices(indices)))

    def _require_all(self, indices: Any, name: str) -> None:
        if len(list(self._get_indices(indices))) != self.num_envs:
            raise ValueError(f"{name} belongs to all environments at once; leave indices out")
