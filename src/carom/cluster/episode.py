"""Episodes, and the recording of steps from which they are extracted."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

_FIRST_ROOM = 64


@dataclass(frozen=True, eq=False)
class Episode:
    """One complete episode.

    Attributes:
        id: Number of the episode, unique within its `Rollouts`.
        seed: Its seed: `env.reset(seed=seed)` of a single environment begins the same episode.
        observations: From the first to the last one, (length + 1, ...); (0, ...) if they were not kept.
        actions: Actions, (length, ...); (0, ...) if they were not kept.
        rewards: Rewards, (length,).
        terminated: Whether the environment ended the episode.
        truncated: Whether the episode was truncated.
        info: The environment's info of the last step.
    """

    id: int
    seed: int
    observations: np.ndarray
    actions: np.ndarray
    rewards: np.ndarray
    terminated: bool
    truncated: bool
    info: dict[str, Any]

    @property
    def length(self) -> int:
        """Number of steps."""
        return len(self.rewards)

    @property
    def total_reward(self) -> float:
        """Sum of the rewards."""
        return float(self.rewards.sum())

    def copy(self) -> Episode:
        """A copy of the episode, with copies of its arrays."""
        return replace(
            self,
            observations=self.observations.copy(),
            actions=self.actions.copy(),
            rewards=self.rewards.copy(),
        )


class StepLog:
    """Records all steps of a vector environment, in growing arrays; only the rewards unless `keep_steps`."""

    def __init__(self, keep_steps: bool) -> None:
        self._keep_steps = keep_steps
        self._length = 0
        self._observations = self._actions = self._rewards = np.zeros((0, 0))

    def add(self, observations: np.ndarray, actions: np.ndarray) -> None:
        """Add the observations and actions of a new step, (num_envs, ...)."""
        if self._length == 0:
            room = _FIRST_ROOM if self._keep_steps else 0
            self._observations = np.empty((room, *observations.shape), observations.dtype)
            self._actions = np.empty((room, *actions.shape), actions.dtype)
            self._rewards = np.zeros((_FIRST_ROOM, len(observations)))
        elif self._length == len(self._rewards):
            self._observations, self._actions, self._rewards = (
                np.concatenate([array, np.empty_like(array)])
                for array in (self._observations, self._actions, self._rewards)
            )
        if self._keep_steps:
            self._observations[self._length] = observations
            self._actions[self._length] = actions
        self._length += 1

    def reward(self, rewards: np.ndarray) -> None:
        """Set the rewards of the step added last, (num_envs,)."""
        self._rewards[self._length - 1] = rewards

    def last(
        self, row: int, length: int, last_observation: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Copies of the observations, actions and rewards of the last `length` steps of one environment."""
        steps = slice(self._length - length, self._length)
        rewards = self._rewards[steps, row].copy()
        if not self._keep_steps:
            return self._observations[:, row], self._actions[:, row], rewards
        observations = np.concatenate([self._observations[steps, row], last_observation[None]])
        return observations, self._actions[steps, row].copy(), rewards


def info_of(row: int, infos: dict[str, Any]) -> dict[str, Any]:
    """The infos of one environment, from Gymnasium's infos of a vector environment."""
    found: dict[str, Any] = {}
    for name, values in infos.items():
        given = infos.get(f"_{name}")
        if name.startswith("_") or (given is not None and not given[row]):
            continue
        found[name] = info_of(row, values) if isinstance(values, dict) else values[row]
    return found
