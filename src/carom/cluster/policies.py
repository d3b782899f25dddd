"""Policies: functions from observations to actions."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np


class Policy(Protocol):
    """A policy: chooses the actions in many environments.

    Each row of the actions has to depend on the same row of the observations only. Ray sends the policy to
    the nodes, so it must be possible to pickle it; a function of the script can be pickled.
    """

    def __call__(self, observations: np.ndarray, /) -> Any:
        """Actions (num_envs, ...) for observations (num_envs, ...)."""
        ...


class PolicyWithMemory(Policy, Protocol):
    """A policy that draws random numbers, or has a memory.

    Its actions in an episode must depend on this episode only, so that a repeated episode is the same:
    `begin_episodes` has to clear the memory and seed a random number generator for each row.
    """

    def begin_episodes(self, rows: np.ndarray, seeds: np.ndarray) -> None:
        """Prepare for new episodes in some environments; called before their first observations are passed.

        Args:
            rows: Indices of the environments, (n,).
            seeds: The seeds of the episodes, (n,). The environment draws from `default_rng(seed)`; for
                independent random numbers use, for example, `default_rng([seed, 1])`.
        """
        ...


def begin_episodes(policy: Policy, rows: np.ndarray, seeds: np.ndarray) -> None:
    """Call `begin_episodes` of a policy, if it has this method."""
    begin = getattr(policy, "begin_episodes", None)
    if begin is not None:
        begin(rows, seeds)
