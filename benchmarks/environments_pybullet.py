"""Real PyBullet's environments as Stable-Baselines3 runs many of them: a process for each.

python benchmarks/environments_pybullet.py AntBulletEnv-v0 8 2.0     # environment steps a second
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from importlib import import_module
from typing import Any

import gymnasium
import numpy as np
from stable_baselines3.common.vec_env import SubprocVecEnv

SEED = 1
ROUNDS = 64


class Current(gymnasium.Env[np.ndarray, np.ndarray]):
    """An environment of the `gym` that PyBullet was written for, as one of today's Gymnasium."""

    def __init__(self, name: str) -> None:
        gym = import_module("gym")
        import_module("pybullet_envs")  # registers the environments
        spec = gym.spec(name)
        self._env: Any = gym.make(name).unwrapped
        self._steps, self._most = 0, spec.max_episode_steps
        self.observation_space = _box(self._env.observation_space)
        self.action_space = _box(self._env.action_space)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Start an episode."""
        super().reset(seed=seed)
        if seed is not None:
            self._env.seed(seed)
        self._steps = 0
        return self._env.reset(), {}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Take a step."""
        observation, reward, over, _ = self._env.step(action)
        self._steps += 1
        return observation, float(reward), bool(over), self._steps >= self._most, {}


def many(name: str, count: int) -> SubprocVecEnv:
    """So many environments, each in a process of its own."""
    makers: list[Callable[[], gymnasium.Env[Any, Any]]] = [lambda: Current(name) for _ in range(count)]
    return SubprocVecEnv(makers)  # type: ignore[arg-type]


def steps_per_second(env: Any, count: int, seconds: float) -> float:
    """Environment steps a second of random actions, all environments together."""
    env.seed(SEED)
    env.reset()
    random = np.random.default_rng(SEED)
    actions = random.uniform(-1.0, 1.0, (ROUNDS, count, *env.action_space.shape)).astype(np.float32)
    env.step(actions[0])
    start, rounds = time.perf_counter(), 0
    while time.perf_counter() - start < seconds:
        env.step(actions[rounds % ROUNDS])
        rounds += 1
    return rounds * count / (time.perf_counter() - start)


def _box(space: Any) -> gymnasium.spaces.Box:
    return gymnasium.spaces.Box(space.low, space.high, dtype=np.float32)


def main() -> None:
    """Print environment steps a second."""
    name, count, seconds = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
    env = many(name, count)
    print(steps_per_second(env, count, seconds))
    env.close()


if __name__ == "__main__":
    main()
