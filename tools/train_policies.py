"""Trains small policies on real PyBullet's environments, and records what they score there.

    env PYTHONPATH=. .oracle/bin/python -m tools.train_policies [TASK ...]

A seeded search by the cross-entropy method (R. Rubinstein, 1999): of many networks drawn around a mean, the
mean moves to those that score best. A policy that is recorded already is not trained again, only played.
"""

from __future__ import annotations

import importlib
import json
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tests.envs.policies import EPISODES, RECORD, TASKS, Task, play
from tests.envs.record import old_gym, without_a_server

_POPULATION, _ELITE = 24, 5
_GENERATIONS = {
    "InvertedPendulum": 10,
    "InvertedDoublePendulum": 25,
    "InvertedPendulumSwingup": 30,
    "Hopper": 30,
    "Walker2D": 10,
    "HalfCheetah": 8,
    "Ant": 8,
    "Humanoid": 8,
}
_SPREAD, _LEAST_SPREAD = 1.0, 0.05
# Episodes of the test begin elsewhere.
_FIRST_SEED = 1000
_DIGITS = 4


def _train(name: str, task: Task, env: Any) -> NDArray[np.float64]:
    random = np.random.default_rng(0)
    mean, spread = np.zeros(task.weights), np.full(task.weights, _SPREAD)
    for generation in range(_GENERATIONS[name]):
        drawn = mean + spread * random.normal(size=(_POPULATION, task.weights))
        seeds = (_FIRST_SEED + 2 * generation, _FIRST_SEED + 2 * generation + 1)
        scores = [sum(play(task, weights, env, env.reset, seed)[1] for seed in seeds) for weights in drawn]
        best = drawn[np.argsort(scores)[-_ELITE:]]
        mean, spread = best.mean(axis=0), np.maximum(best.std(axis=0), _LEAST_SPREAD)
        print(f"{name}, generation {generation}: {max(scores) / len(seeds):.1f}", flush=True)
    return mean.round(_DIGITS)


def main() -> None:
    """Does what the command line says."""
    old_gym()
    without_a_server()
    recorded = json.loads(RECORD.read_text()) if RECORD.exists() else {}
    for name in sys.argv[1:] or TASKS:
        task = TASKS[name]
        module, _, kind = task.environment.partition(":")
        env = getattr(importlib.import_module(f"pybullet_envs.{module}"), kind)()
        known = recorded.get(name)
        weights = np.array(known["weights"]) if known else _train(name, task, env)
        played = [play(task, weights, env, env.reset, seed) for seed in range(EPISODES)]
        recorded[name] = {
            "weights": weights.tolist(),
            "lengths": [length for length, _ in played],
            "returns": [round(total, 6) for _, total in played],
        }
        lines = [f'"{key}": {json.dumps(value)}' for key, value in sorted(recorded.items())]
        RECORD.write_text("{\n" + ",\n".join(lines) + "\n}\n")


if __name__ == "__main__":
    main()
