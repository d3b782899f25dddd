"""Policies trained on PyBullet's environments play ours as they play PyBullet's."""

from __future__ import annotations

import importlib
import json
from typing import Any

import numpy as np
import pytest
from tests.envs.policies import EPISODES, RECORD, TASKS, play

RECORDED = json.loads(RECORD.read_text())


# The share by which sums of rewards may differ, of environments whose episodes can be predicted.
PREDICTABLE = {
    "InvertedPendulum": 1e-3,
    "InvertedDoublePendulum": 1e-3,
    "InvertedPendulumSwingup": 1e-3,
    "Hopper": 1e-2,
}
# Of other environments, how many episodes of the 20 have to be as long.
AS_LONG = {"Humanoid": 15}
# Of two samples of 20 from one distribution, one pair of a hundred is further apart.
FURTHEST = 0.5


def played(name: str) -> tuple[list[int], list[float]]:
    """Lengths and returns of all episodes of a policy."""
    task, weights = TASKS[name], np.array(RECORDED[name]["weights"])
    module, _, kind = task.environment.partition(":")
    env: Any = getattr(importlib.import_module(f"pybullet_envs.{module}"), kind)()
    episodes = [play(task, weights, env, lambda: env.reset()[0], seed) for seed in range(EPISODES)]
    env.close()
    return [length for length, _ in episodes], [total for _, total in episodes]


def apart(ours: list[float], theirs: list[float]) -> float:
    """The statistic of Kolmogorov and Smirnov: the greatest distance of two distributions."""
    places = np.sort([*ours, *theirs])
    shares = [np.searchsorted(np.sort(it), places, side="right") / len(it) for it in (ours, theirs)]
    return float(np.abs(shares[0] - shares[1]).max())


@pytest.mark.parametrize("name", PREDICTABLE)
def test_episodes_are_those_of_pybullet(name: str) -> None:
    lengths, returns = played(name)
    assert lengths == RECORDED[name]["lengths"]
    assert returns == pytest.approx(RECORDED[name]["returns"], rel=PREDICTABLE[name])


@pytest.mark.long
@pytest.mark.parametrize("name", sorted(TASKS.keys() - PREDICTABLE.keys()))
def test_episodes_are_distributed_as_those_of_pybullet(name: str) -> None:
    lengths, returns = played(name)
    assert apart([float(it) for it in lengths], RECORDED[name]["lengths"]) <= FURTHEST
    assert apart(returns, RECORDED[name]["returns"]) <= FURTHEST
    same = sum(ours == theirs for ours, theirs in zip(lengths, RECORDED[name]["lengths"], strict=True))
    assert same >= AS_LONG.get(name, 0)


def test_distributions_are_told_apart() -> None:
    assert apart([1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 3.0, 4.0]) == 0.0
    assert apart([1.0, 2.0, 3.0, 4.0], [3.0, 4.0, 5.0, 6.0]) == 0.5
    assert apart([1.0], [2.0]) == 1.0
