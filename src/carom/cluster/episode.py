"""One episode, and the steps from which it is cut."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

_FIRST_ROOM = 64


@dataclass(frozen=True, eq=False)
class Episode:
    """One episode from its beginning to its end.

    Attributes:
        id: Its number; no other of the same `Rollouts` has it.
        seed: Its seed: `env.reset(seed=seed)` of a single environment begins the same episode.
        observations: From the first to the last one, (length + 1, ...); (0, ...) if they were not kept.
        actions: (length, ...); (0, ...) if they were not kept.
        rewards: (length,).
        terminated: Whether the environment says that it is over.
        truncated: Whether it was cut off.
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
        """Number of its steps."""
        return len(self.rewards)

    @property
    def total_reward(self) -> float:
        """The sum of its rewards."""
        return float(self.rewards.sum())

    def copy(self) -> Episode:
        """The same with arrays of its own."""
        return replace(
            self,
            observations=self.observations.copy(),
            actions=self.actions.copy(),
            rewards=self.rewards.copy(),
        )


class StepLog:
    """All steps of a vector environment, in arrays that grow.

    Args:
        keep_steps: Whether observations and actions are kept, besides the rewards.
    """

    def __init__(self, keep_steps: bool) -> None:
        self._keep_steps = keep_steps
        self._length = 0
        self._observations = self._actions = self._rewards = np.zeros((0, 0))

    def add(self, observations: np.ndarray, actions: np.ndarray) -> None:
        """Adds the observations and actions of a step, (num_envs, ...)."""
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
        """The step has ended, with rewards (num_envs,)."""
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
    """What Gymnasium's infos of many environments say of one."""
    found: dict[str, Any] = {}
    for name, values in infos.items():
        told = infos.get(f"_{name}")
        if name.startswith("_") or (told is not None and not told[row]):
            continue
        found[name] = info_of(row, values) if isinstance(values, dict) else values[row]
    return found
