"""The Minitaur does in each of its environments what it does in PyBullet's own."""

from __future__ import annotations

import importlib
import json
from typing import Any

import numpy as np
import pytest
from tests.envs.record import EvenChance
from tests.envs.record_minitaur import KINDS, RECORD, STEPS, action, kind_of

RECORDED = json.loads(RECORD.read_text())


@pytest.mark.parametrize("name", KINDS)
def test_observations_and_rewards_are_those_of_pybullet(name: str) -> None:
    module, kind = kind_of(name)
    env: Any = getattr(importlib.import_module(module), kind)(**KINDS[name])
    for episode, recorded in enumerate(RECORDED[name]):
        env.np_random = EvenChance()
        observed, rewards = [env.reset()[0]], [0.0]
        for step in range(STEPS):
            observation, reward, *_ = env.step(action(name, step))
            observed.append(observation)
            rewards.append(reward)
        for step in range(STEPS+1):
            d=np.abs(observed[step]-np.array(recorded[step][0]))
            print(name, episode, step, d.max().round(5), d.argmax(), round(rewards[step]-recorded[step][1],6), rewards[step])
    env.close()
