"""Observations and rewards are those of PyBullet's own environments."""

from __future__ import annotations

import importlib
import json
from typing import Any

import pytest
from tests.envs.record import ACTIONS, FIRST_DRAW, RECORD, STEPS, EvenChance, action

RECORDED = json.loads(RECORD.read_text())


@pytest.mark.parametrize("name", ACTIONS)
def test_observations_and_rewards_are_those_of_pybullet(name: str) -> None:
    module, _, kind = name.partition(":")
    env: Any = getattr(importlib.import_module(f"pybullet_envs.{module}"), kind)()
    for number, recorded in enumerate(RECORDED[name]):
        env.np_random = EvenChance(FIRST_DRAW[name])
        observation, _ = env.reset()
        assert observation == pytest.approx(recorded[0][0], abs=1e-4)
        for step in range(STEPS[name]):
            observation, reward, *_ = env.step(action(name, step))
            expected, expected_reward = recorded[step + 1]
            # The hopper's foot lands: contacts need not agree to the last digit.
            assert observation == pytest.approx(expected, abs=1e-3)
            # In its first episode PyBullet takes the floor into the middle of the robot after the first step.
            if number or step or "locomotion" not in name:
                assert reward == pytest.approx(expected_reward, abs=2e-3)
    env.close()
