"""Trains small policies on real PyBullet's environments, and records what they score there.

    env PYTHONPATH=. .oracle/bin/python -m tools.train_policies [TASK ...]

A seeded search by the cross-entropy method (R. Rubinstein, 1999): of many networks drawn around a mean, the
mean moves to those that score best. The humanoid, whose network has many more weights, is trained by
augmented random search (H. Mania, A. Guy, B. Recht, 2018): the network moves along random directions by as
much as a step forward scores better than one back. A policy that is recorded already is not trained again,
only played.
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
}
# For a random search: generations between two looks at the score, number of looks, episodes in each,
# directions, how many of the best of them are used, their length, and the rate of learning. Each search goes
# on where the one before scored best.
_SEARCHES = {"Humanoid": ((10, 4, 6, 16, 8, 0.03, 0.03), (8, 10, 10, 24, 12, 0.02, 0.015))}
_SPREAD, _MIN_SPREAD = 1.0, 0.05
# Episodes of the test begin elsewhere.
_FIRST_SEED, _SEEDS = 1000, 400
_SCORED_SEED = 500
_DIGITS = 4


def _train(name: str, task: Task, env: Any) -> NDArray[np.float64]:
    random = np.random.default_rng(0)
    mean, spread = np.zeros(task.weights), np.full(task.weights, _SPREAD)
    for generation in range(_GENERATIONS[name]):
        drawn = mean + spread * random.normal(size=(_POPULATION, task.weights))
        seeds = (_FIRST_SEED + 2 * generation, _FIRST_SEED + 2 * generation + 1)
        scores = [sum(play(task, weights, env, env.reset, seed)[1] for seed in seeds) for weights in drawn]
        best = drawn[np.argsort(scores)[-_ELITE:]]
        mean, spread = best.mean(axis=0), np.maximum(best.std(axis=0), _MIN_SPREAD)
        print(f"{name}, generation {generation}: {max(scores) / len(seeds):.1f}", flush=True)
    return mean.round(_DIGITS)


def _search(name: str, task: Task, env: Any) -> NDArray[np.float64]:
    """A policy found by augmented random search, from the networks that score best on the way."""
    best: NDArray[np.float64] | None = None
    for number, (looks, rounds, scored, directions, used, length, rate) in enumerate(_SEARCHES[name]):
        random = np.random.default_rng(number)
        drawn = _almost_still(task, random)
        weights, best_score = drawn if best is None else best, -np.inf
        for generation in range(looks * rounds):
            steps = random.normal(size=(directions, task.weights))
            scores = np.empty((directions, 2))
            for place, step in enumerate(steps):
                seed = _FIRST_SEED + (generation * directions + place) % _SEEDS
                for side, sign in enumerate((1.0, -1.0)):
                    scores[place, side] = play(task, weights + sign * length * step, env, env.reset, seed)[1]
            chosen = np.argsort(-scores.max(axis=1))[:used]
            slope = (scores[chosen, 0] - scores[chosen, 1]) @ steps[chosen]
            weights = weights + rate / (used * (scores[chosen].std() + 1e-6)) * slope
            if generation % looks == looks - 1:
                tried = weights.round(_DIGITS)
                seeds = range(_SCORED_SEED, _SCORED_SEED + scored)
                score = float(np.mean([play(task, tried, env, env.reset, seed)[1] for seed in seeds]))
                print(f"{name}, generation {generation}: {score:.1f}", flush=True)
                if score > best_score:
                    best, best_score = tried, score
    assert best is not None
    return best


def _almost_still(task: Task, random: np.random.Generator) -> NDArray[np.float64]:
    """A network with a hidden node for each action, which it follows, and small random weights before it."""
    inner = (task.observed + 1) * task.hidden
    first = 0.3 / np.sqrt(task.observed) * random.normal(size=inner)
    return np.concatenate([first, np.eye(task.actions, task.hidden + 1).ravel()])


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
        train = _search if name in _SEARCHES else _train
        weights = np.array(known["weights"]) if known else train(name, task, env)
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
