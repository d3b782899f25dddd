"""An environment without physics, whose episodes are decided by their seeds, and policies for it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

if TYPE_CHECKING:
    from carom.cluster import Episode

_ENDLESS = np.full(2, np.inf)


class Dice(VectorEnv[np.ndarray, np.ndarray, np.ndarray]):
    """Rewards are the action and what is thrown; observations the seed and the last throw. 3 to 9 throws."""

    def __init__(self, num_envs: int, mode: AutoresetMode = AutoresetMode.DISABLED) -> None:
        self.num_envs = num_envs
        self.single_observation_space = gymnasium.spaces.Box(-_ENDLESS, _ENDLESS, dtype=np.float64)
        self.single_action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float64)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.metadata = {"autoreset_mode": mode}
        self._dice = [np.random.default_rng() for _ in range(num_envs)]
        self._seen = np.zeros((num_envs, 2))
        self._left = np.zeros(num_envs, dtype=int)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        assert isinstance(seed, list)
        assert options is not None
        for row in np.flatnonzero(options["reset_mask"]):
            own = int(seed[row] or 0)
            self._dice[row] = np.random.default_rng(own)
            self._seen[row] = own, 0.0
            self._left[row] = 3 + own % 7
        return self._seen.copy(), {}

    def step(self, actions: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        assert (self._left > 0).all(), "an episode that is over goes on"
        self._seen[:, 1] = [die.uniform() for die in self._dice]
        self._left -= 1
        over = self._left == 0
        infos = {"left": self._left.copy(), "_left": self._left > 1, "inner": {"seed": self._seen[:, 0]}}
        return self._seen.copy(), self._seen[:, 1] + actions[:, 0], over, np.zeros_like(over), infos


def summed(episodes: list[Episode]) -> dict[str, Any]:
    return {
        "ids": [episode.id for episode in episodes],
        "observations": sum(episode.observations.sum(axis=0) for episode in episodes),
    }


def copy_throws(observations: np.ndarray) -> np.ndarray:
    """A policy: the last throw again."""
    return observations[:, 1:]


class Guess:
    """A policy that draws random numbers of its own and remembers the sum of them."""

    def __init__(self, num_envs: int) -> None:
        self.sums = np.zeros(num_envs)
        self.dice = [np.random.default_rng() for _ in range(num_envs)]

    def begin_episodes(self, rows: np.ndarray, seeds: np.ndarray) -> None:
        self.sums[rows] = 0.0
        for row, seed in zip(rows.tolist(), seeds.tolist(), strict=True):
            self.dice[row] = np.random.default_rng([seed, 1])

    def __call__(self, observations: np.ndarray) -> np.ndarray:
        self.sums += [die.uniform() for die in self.dice]
        return self.sums[:, None]


class Stubborn:
    """A policy that does not let itself be unpacked."""

    def __reduce__(self) -> tuple[Any, ...]:
        return _refuse, ()

    def __call__(self, observations: np.ndarray) -> np.ndarray:
        return observations


def _refuse() -> None:
    raise RuntimeError("not here")


def assert_same(found: Sequence[Any], expected: Sequence[Any]) -> None:
    """Episodes are the same, to the last bit."""
    assert [episode.id for episode in found] == [episode.id for episode in expected]
    for one, other in zip(found, expected, strict=True):
        assert one.seed == other.seed
        assert (one.terminated, one.truncated) == (other.terminated, other.truncated)
        for name in ("observations", "actions", "rewards"):
            assert np.array_equal(getattr(one, name), getattr(other, name)), (one.id, name)
