"""Policies: functions from observations to actions."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np


class Policy(Protocol):
    """Says what to do in each of many environments.

    Each row of the actions has to depend on the same row of the observations alone. Ray sends the policy to
    the nodes, so it has to be something that can be pickled; a function of the script will do.
    """

    def __call__(self, observations: np.ndarray, /) -> Any:
        """Actions (num_envs, ...) for observations (num_envs, ...)."""
        ...


class PolicyWithMemory(Policy, Protocol):
    """A policy that draws random numbers, or has a memory.

    What it does in an episode must depend on nothing but that episode, lest one that is played again turns
    out differently: `begin_episodes` forgets the last one, and seeds a generator of its own for each row.
    """

    def begin_episodes(self, rows: np.ndarray, seeds: np.ndarray) -> None:
        """Episodes begin in some of the environments, before their first observations are shown.

        Args:
            rows: Which ones, (n,).
            seeds: The seeds of the episodes, (n,). The environment draws from `default_rng(seed)`; for
                numbers that have nothing to do with its own take, say, `default_rng([seed, 1])`.
        """
        ...


def begin_episodes(policy: Policy, rows: np.ndarray, seeds: np.ndarray) -> None:
    """Tell a policy that episodes begin, if it wants to know."""
    begin = getattr(policy, "begin_episodes", None)
    if begin is not None:
        begin(rows, seeds)
