"""Small policies for environments, and episodes that they play on PyBullet's environments and on ours."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
from numpy.typing import NDArray

RECORD = Path(__file__).with_name("policies.json")
EPISODES = 20


@dataclass(frozen=True)
class Task:
    """An environment, and a network of one hidden layer that plays it.

    Attributes:
        environment: Module and class.
        observed: Numbers of an observation.
        hidden: Nodes of the hidden layer.
        actions: Numbers of an action.
        limit: Steps after which an episode ends.
    """

    environment: str
    observed: int
    hidden: int
    actions: int
    limit: int

    @property
    def weights(self) -> int:
        """How many numbers the network has."""
        return (self.observed + 1) * self.hidden + (self.hidden + 1) * self.actions


TASKS = {
    "InvertedPendulum": Task("gym_pendulum_envs:InvertedPendulumBulletEnv", 5, 4, 1, 300),
    "InvertedDoublePendulum": Task("gym_pendulum_envs:InvertedDoublePendulumBulletEnv", 9, 4, 1, 300),
    "InvertedPendulumSwingup": Task("gym_pendulum_envs:InvertedPendulumSwingupBulletEnv", 5, 8, 1, 300),
    "Hopper": Task("gym_locomotion_envs:HopperBulletEnv", 15, 4, 3, 300),
    "Walker2D": Task("gym_locomotion_envs:Walker2DBulletEnv", 22, 4, 6, 300),
    "HalfCheetah": Task("gym_locomotion_envs:HalfCheetahBulletEnv", 26, 4, 6, 300),
    "Ant": Task("gym_locomotion_envs:AntBulletEnv", 28, 4, 8, 300),
    "Humanoid": Task("gym_locomotion_envs:HumanoidBulletEnv", 44, 17, 17, 300),
}


class Starts:
    """Numbers that an environment draws, the same wherever it is played."""

    def __init__(self, seed: int) -> None:
        self._random = Random(seed)

    def uniform(self, low: float = 0.0, high: float = 1.0, size: Any = None) -> Any:
        """As NumPy's generators have it."""
        if size is None:
            return self._random.uniform(low, high)
        count = int(np.prod(size))
        return np.array([self._random.uniform(low, high) for _ in range(count)]).reshape(size)


def action(task: Task, weights: NDArray[np.float64], observation: NDArray[np.float64]) -> NDArray[np.float64]:
    """What the network does: tangents of weighted sums, twice."""
    inner = (task.observed + 1) * task.hidden
    first = weights[:inner].reshape(task.hidden, task.observed + 1)
    second = weights[inner:].reshape(task.actions, task.hidden + 1)
    hidden = np.tanh(first[:, :-1] @ np.clip(observation, -5.0, 5.0) + first[:, -1])
    return np.tanh(second[:, :-1] @ hidden + second[:, -1])


def play(
    task: Task, weights: NDArray[np.float64], env: Any, reset: Callable[[], Any], seed: int
) -> tuple[int, float]:
    """Plays an episode.

    Args:
        task: The task.
        weights: Of the network.
        env: The environment, whose steps begin with observation, reward and whether it is over.
        reset: Begins an episode and returns its observation.
        seed: Decides where it begins.

    Returns:
        The number of steps, and the sum of the rewards.
    """
    env.np_random = Starts(seed)
    if hasattr(env, "robot"):
        env.robot.np_random = env.np_random
    observation, total = np.asarray(reset(), dtype=float), 0.0
    for step in range(task.limit):
        observation, reward, done, *_ = env.step(action(task, weights, np.asarray(observation, dtype=float)))
        total += float(reward)
        if done:
            return step + 1, total
    return task.limit, total
