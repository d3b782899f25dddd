"""The vector environment that RSL-RL trains on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode

try:
    import torch
    from rsl_rl.env import VecEnv  # pyright: ignore[reportMissingImports]
    from tensordict import TensorDict  # pyright: ignore[reportMissingImports]
except ImportError as missing:
    raise ImportError(
        "carom.vector.rsl_rl needs RSL-RL; install it with: pip install rsl-rl-lib", name="rsl_rl"
    ) from missing

from carom.vector.worlds_env import WorldsEnv


class RslRlEnv(VecEnv):
    """A `WorldsEnv` as a vector environment of RSL-RL.

    Groups of observations keep their names ("policy", "critic"); an observation without groups is "policy".
    The runner's `obs_groups` says who sees which: `{"actor": ["policy"], "critic": ["policy", "critic"]}`.

    Attributes:
        env: The vector environment, with its wrappers.
        num_envs: Number of environments.
        num_actions: Length of an action.
        max_episode_length: Number of steps of the longest episode.
        episode_length_buf: Steps of each environment in its episode, (num_envs,).
        device: Where tensors are made.
        cfg: An empty dictionary, or what was given.

    Args:
        env: An environment whose `autoreset_mode` is `SAME_STEP`, in any number of wrappers.
        device: Device of observations and rewards.
        cfg: What the runner logs as the configuration.

    Raises:
        ValueError: The environment is not a `WorldsEnv`, its `autoreset_mode` is another, or its actions are
            not a `Box` of one axis.
    """

    def __init__(self, env: Any, *, device: str = "cpu", cfg: Mapping[str, Any] | None = None) -> None:
        inner = env.unwrapped
        if not isinstance(inner, WorldsEnv) or inner.autoreset_mode != AutoresetMode.SAME_STEP:
            raise ValueError(
                "RSL-RL trains on a WorldsEnv that begins episodes in the same step: "
                "make it with autoreset_mode='SameStep'"
            )
        shape = env.single_action_space.shape
        if shape is None or len(shape) != 1:
            raise ValueError(
                f"RSL-RL needs actions that are a Box of one axis, not {env.single_action_space}"
            )
        self.env = env
        self.num_envs: int = env.num_envs
        self.num_actions: int = shape[0]
        self.max_episode_length: int = inner.max_episode_steps or 1_000_000
        self.device: str = device
        self.cfg: dict[str, Any] = dict(cfg or {})
        self._inner = inner
        self._observations, _ = env.reset()

    @property
    def episode_length_buf(self) -> torch.Tensor:
        """Steps of each environment in its episode; settable, so that first episodes end at other times."""
        return torch.from_numpy(self._inner.episode_steps.copy()).to(self.device)

    @episode_length_buf.setter
    def episode_length_buf(self, value: torch.Tensor) -> None:
        self._inner.episode_steps[:] = np.asarray(value.cpu())

    def get_observations(self) -> TensorDict:
        """The present observations, by group."""
        return self._as_tensors(self._observations)

    def reset(self) -> tuple[TensorDict, dict[str, Any]]:
        """Start all episodes."""
        self._observations, _ = self.env.reset()
        return self.get_observations(), {}

    def step(self, actions: torch.Tensor) -> tuple[TensorDict, torch.Tensor, torch.Tensor, dict[str, Any]]:
        """Take a step.

        Returns:
            Observations; rewards (num_envs,); which episodes are over (num_envs,); and `time_outs`, which of
            them were cut off, with `log`, the mean sums of reward terms of those that are over.
        """
        box = self.env.single_action_space
        given = np.clip(actions.detach().cpu().numpy(), box.low, box.high)
        self._observations, rewards, terminated, truncated, infos = self.env.step(given)
        over = terminated | truncated
        log: dict[str, float] = {}
        sums = infos.get("final_info", {}).get("rewards", {}) if over.any() else {}
        for name, values in sums.items():
            log[f"/reward/{name}"] = float(np.asarray(values)[over].mean())
        extras = {"time_outs": self._tensor(truncated & ~terminated), "log": log}
        return self.get_observations(), self._tensor(rewards, torch.float32), self._tensor(over), extras

    def close(self) -> None:
        """Close the environment."""
        self.env.close()

    def _as_tensors(self, observations: Any) -> TensorDict:
        groups = observations if isinstance(observations, Mapping) else {"policy": observations}
        tensors = {name: self._tensor(part) for name, part in groups.items()}
        return TensorDict(tensors, batch_size=[self.num_envs], device=self.device)

    def _tensor(self, values: Any, dtype: torch.dtype | None = None) -> torch.Tensor:
        return torch.as_tensor(np.array(values), dtype=dtype).to(self.device)
