"""What happens in Carom's own tasks, in few numbers, to see that they stay the same tasks.

`python -m tests.vector.record_tasks` records it in `tasks.json`.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import carom.vector  # noqa: F401  # registers the tasks
from carom.vector.quadruped.terrain import random_terrain

RECORDED = Path(__file__).with_name("tasks.json")
TASKS = ("carom/PandaReach-v0", "carom/PandaPush-v0", "carom/PandaPick-v0", "carom/QuadrupedWalk-v0")
_WORLDS, _STEPS, _EPISODE = 3, 16, 10


def played(task: str) -> dict[str, list[list[float]]]:
    """Rewards, and a number of each observation that depends on all its entries, by steps and worlds."""
    env: Any = gymnasium.make_vec(task, num_envs=_WORLDS, max_episode_steps=_EPISODE)
    observations, _ = env.reset(seed=7)
    told, rewards = [_mixed(observations)], []
    width = env.action_space.shape[1]
    for step in range(_STEPS):
        phases = 0.4 * step * (1.0 + np.arange(_WORLDS))[:, None]
        observations, reward, *_ = env.step(np.sin(phases + np.arange(width)))
        told.append(_mixed(observations))
        rewards.append(np.asarray(reward, dtype=float).tolist())
    env.close()
    return {"observations": told, "rewards": rewards}


def ground(seed: int) -> list[float]:
    """A number of each row of the heights of a terrain, which depends on all of them."""
    heights = random_terrain(seed).heights
    return (heights @ np.cos(np.arange(heights.shape[1]))).tolist()


def _mixed(observations: Any) -> list[float]:
    numbers = np.asarray(observations, dtype=float)
    return (numbers @ np.cos(np.arange(numbers.shape[1]))).tolist()


if __name__ == "__main__":
    known = {"tasks": {task: played(task) for task in TASKS}, "ground": ground(0)}
    rounded = json.loads(json.dumps(known), parse_float=lambda text: round(float(text), 9))
    RECORDED.write_text(json.dumps(rounded) + "\n", encoding="utf-8")
