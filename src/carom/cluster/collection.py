"""The data collected by a rollout."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, overload

import numpy as np

from carom.cluster.episode import Episode


@dataclass(frozen=True)
class Report:
    """Statistics of a collection; its data do not depend on them.

    Attributes:
        episodes_of_nodes: Number of its episodes that each node played.
        lost_nodes: Nodes that died during the collection, or on which a process died, with Ray's message.
        repeated: Number of episodes that were repeated because their node or process died.
    """

    episodes_of_nodes: dict[str, int] = field(default_factory=dict)
    lost_nodes: list[str] = field(default_factory=list)
    repeated: int = 0


@dataclass(frozen=True, eq=False)
class Steps:
    """The steps of many episodes, one after the other.

    Attributes:
        observations: Observations before each step, (steps, ...).
        actions: Actions, (steps, ...).
        rewards: Rewards, (steps,).
        next_observations: Observations after each step, (steps, ...).
        terminations: Whether the environment ended the episode at the step, (steps,).
        truncations: Whether the episode was truncated at the step, (steps,).
        ids: Id of the episode of each step, (steps,).
    """

    observations: np.ndarray
    actions: np.ndarray
    rewards: np.ndarray
    next_observations: np.ndarray
    terminations: np.ndarray
    truncations: np.ndarray
    ids: np.ndarray


@dataclass(frozen=True, eq=False)
class Collection(Sequence[Episode]):
    """Episodes in the order of their ids, which are consecutive.

    Attributes:
        episodes: The episodes.
        report: Statistics: which nodes played them, and which were lost.
    """

    episodes: tuple[Episode, ...]
    report: Report

    def __len__(self) -> int:
        return len(self.episodes)

    @overload
    def __getitem__(self, index: int) -> Episode: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Episode, ...]: ...

    def __getitem__(self, index: int | slice) -> Episode | tuple[Episode, ...]:
        return self.episodes[index]

    @property
    def ids(self) -> np.ndarray:
        """The ids of the episodes, (episodes,)."""
        return np.array([episode.id for episode in self.episodes])

    @property
    def lengths(self) -> np.ndarray:
        """Number of steps of each episode, (episodes,)."""
        return np.array([episode.length for episode in self.episodes])

    @property
    def returns(self) -> np.ndarray:
        """Sum of the rewards of each episode, (episodes,)."""
        return np.array([episode.total_reward for episode in self.episodes])

    @property
    def step_count(self) -> int:
        """Number of steps of all episodes."""
        return int(self.lengths.sum())

    def steps(self) -> Steps:
        """All steps as arrays, for learning.

        Raises:
            ValueError: Observations and actions were not kept.
        """
        if not len(self.episodes[0].actions):
            raise ValueError("the steps were not kept: collect with keep_steps=True")
        episodes, lengths = self.episodes, self.lengths
        ends = np.cumsum(lengths) - 1
        terminations, truncations = np.zeros((2, self.step_count), dtype=bool)
        terminations[ends] = [episode.terminated for episode in episodes]
        truncations[ends] = [episode.truncated for episode in episodes]
        return Steps(
            observations=np.concatenate([episode.observations[:-1] for episode in episodes]),
            actions=np.concatenate([episode.actions for episode in episodes]),
            rewards=np.concatenate([episode.rewards for episode in episodes]),
            next_observations=np.concatenate([episode.observations[1:] for episode in episodes]),
            terminations=terminations,
            truncations=truncations,
            ids=np.repeat(self.ids, lengths),
        )


@dataclass(frozen=True)
class Part:
    """What a reduction made of one batch of episodes.

    Attributes:
        ids: Ids of the episodes.
        value: What the function returned.
        length: Number of steps of the episodes.
    """

    ids: range
    value: Any
    length: int


@dataclass(frozen=True, eq=False)
class Reduction(Sequence[Any]):
    """What reductions on the nodes returned, one value for each batch, in the order of the episodes.

    Attributes:
        parts: The batches.
        report: Statistics: which nodes played them, and which were lost.
    """

    parts: tuple[Part, ...]
    report: Report

    def __len__(self) -> int:
        return len(self.parts)

    @overload
    def __getitem__(self, index: int) -> Any: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Any, ...]: ...

    def __getitem__(self, index: int | slice) -> Any:
        return self.values[index]

    @property
    def values(self) -> tuple[Any, ...]:
        """The values of the batches."""
        return tuple(part.value for part in self.parts)

    @property
    def episode_count(self) -> int:
        """Number of episodes."""
        return sum(len(part.ids) for part in self.parts)

    @property
    def step_count(self) -> int:
        """Number of steps of all episodes."""
        return sum(part.length for part in self.parts)
