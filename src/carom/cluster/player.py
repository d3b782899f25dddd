"""Playing episodes in a vector environment; each episode depends on its seed and the policy only."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv

from carom.cluster.episode import Episode, StepLog, info_of
from carom.cluster.errors import EpisodeError
from carom.cluster.policies import Policy, begin_episodes

_NOBODY = -1


class Player:
    """Plays batches of episodes, in parallel in the environments of a vector environment.

    Args:
        env: A vector environment that does not reset itself (`AutoresetMode.DISABLED`), and whose `reset`
            takes `options={"reset_mask": mask}` and a list of seeds.
        max_episode_steps: Number of steps after which episodes are truncated; None: as in the environment.

    Raises:
        ValueError: The environment resets itself.
    """

    def __init__(self, env: VectorEnv, max_episode_steps: int | None = None) -> None:
        mode = env.metadata.get("autoreset_mode")
        if mode != AutoresetMode.DISABLED:
            raise ValueError(
                "the environment must not reset itself, because the rollout does: make it with "
                f"autoreset_mode=AutoresetMode.DISABLED, not {mode}"
            )
        self._env = env
        self._longest = np.inf if max_episode_steps is None else max_episode_steps

    def play(self, policy: Policy, ids: range, seed: int, *, keep_steps: bool = True) -> list[Episode]:
        """Play episodes, at least one, by their ids; they do not depend on episodes played before.

        Episode k has the seed `seed + k`. Only with `keep_steps` are observations and actions kept.

        Raises:
            EpisodeError: The policy or the environment failed.
        """
        seats = _Seats(self._env.num_envs, ids, seed)
        log, played = StepLog(keep_steps), []
        observations = self._begin(policy, seats, np.ones(seats.count, dtype=bool))
        while seats.are_taken:
            actions = self._act(policy, seats, observations)
            log.add(observations, actions)
            with _blaming("the environment", seats):
                seen, rewards, terminations, truncations, infos = self._env.step(actions)
            log.reward(rewards)
            seats.steps += 1
            truncations = truncations | (seats.steps >= self._longest)
            over = terminations | truncations
            for row in np.flatnonzero(over & (seats.ids != _NOBODY)).tolist():
                steps = log.last(row, int(seats.steps[row]), seen[row])
                ends = bool(terminations[row]), bool(truncations[row])
                who = int(seats.ids[row]), int(seats.seeds[row])
                played.append(Episode(*who, *steps, *ends, info_of(row, infos)))
            if over.any():
                seats.call_next(over)
                seen = self._begin(policy, seats, over) if seats.are_taken else seen
            observations = seen
        return sorted(played, key=lambda episode: episode.id)

    def close(self) -> None:
        """Close the environment."""
        self._env.close()

    def _begin(self, policy: Policy, seats: _Seats, where: np.ndarray) -> np.ndarray:
        with _blaming("the environment", seats):
            # New options and a copy of the mask, because environments take the mask out of the options.
            options = {"reset_mask": where.copy()}
            observations, _ = self._env.reset(seed=seats.seeds.tolist(), options=options)
        with _blaming("the policy", seats):
            begin_episodes(policy, np.flatnonzero(where), seats.seeds[where])
        return observations

    def _act(self, policy: Policy, seats: _Seats, observations: np.ndarray) -> np.ndarray:
        with _blaming("the policy", seats):
            actions, shape = np.asarray(policy(observations)), self._env.action_space.shape
            if actions.shape != shape:
                raise ValueError(f"the actions have shape {actions.shape}; they must have shape {shape}")
        return actions


class _Seats:
    """Which episode is played in which environment (row); rows without one repeat their last episode."""

    def __init__(self, count: int, ids: range, seed: int) -> None:
        self.count = count
        self._seed = seed
        self._waiting = iter(ids)
        self.ids = np.full(count, _NOBODY)
        self.seeds = np.full(count, seed + ids.start)
        self.steps = np.zeros(count, dtype=np.int64)
        self.call_next(np.ones(count, dtype=bool))

    @property
    def are_taken(self) -> bool:
        return bool((self.ids != _NOBODY).any())

    def call_next(self, where: np.ndarray) -> None:
        """Assign the next episodes to the rows of a mask."""
        self.steps[where] = 0
        for row in np.flatnonzero(where).tolist():
            number = next(self._waiting, None)
            self.ids[row] = _NOBODY if number is None else number
            if number is not None:
                self.seeds[row] = self._seed + number


@contextmanager
def _blaming(what: str, seats: _Seats) -> Iterator[None]:
    """Turn an exception into an `EpisodeError` with the ids of the episodes being played."""
    try:
        yield
    except Exception as error:
        taken = seats.ids != _NOBODY
        reason = f"{type(error).__name__}: {error}"
        raise EpisodeError(what, seats.ids[taken].tolist(), seats.seeds[taken].tolist(), reason) from error
