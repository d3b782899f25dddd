"""The Minitaur does in each of its environments what it does in PyBullet's own."""

from __future__ import annotations

import importlib
import json
from typing import Any

import numpy as np
import pytest
from tests.envs.record import EvenChance
from tests.envs.record_minitaur import KINDS, RECORD, STEPS, action, kind_of

from pybullet_envs.bullet import MinitaurBulletEnv
from pybullet_envs.minitaur.envs import MinitaurTrottingEnv

RECORDED = json.loads(RECORD.read_text())
MOVING = slice(8, 24)


def tolerances(name: str, size: int) -> np.ndarray:
    """How far numbers of an observation may be off; feet on the ground slip and stick.

    Speeds of joints change by whole radians a second in the step in which a foot comes down.
    """
    in_the_air = "on_rack" in KINDS[name]
    allowed = np.full(size, 1e-5 if in_the_air else 0.015)
    if size == 28 and not in_the_air:
        allowed[MOVING] = 0.3
    return allowed


@pytest.mark.parametrize("name", KINDS)
def test_spaces_observations_and_rewards_are_those_of_pybullet(name: str) -> None:
    module, kind = kind_of(name)
    env: Any = getattr(importlib.import_module(module), kind)(**KINDS[name])
    for space, (low, high) in zip(
        (env.action_space, env.observation_space), RECORDED[name]["spaces"], strict=True
    ):
        assert space.low == pytest.approx(low, rel=1e-6)
        assert space.high == pytest.approx(high, rel=1e-6)
    for recorded in RECORDED[name]["episodes"]:
        env.np_random = EvenChance()
        observation, reward = env.reset()[0], 0.0
        for step, (expected, expected_reward) in enumerate(recorded):
            if step:
                observation, reward, *_ = env.step(action(name, step - 1))
            assert (np.abs(observation - expected) < tolerances(name, len(expected))).all()
            # The robot that stands is rewarded by one over how much it leans.
            assert reward == pytest.approx(expected_reward, rel=0.08, abs=3e-4)
    env.close()


def test_as_many_steps_are_recorded_as_are_compared() -> None:
    assert all(
        len(episode) == STEPS + 1 for recorded in RECORDED.values() for episode in recorded["episodes"]
    )


def gait(step: int) -> np.ndarray:
    """Legs at opposite corners move together."""
    wave = np.sin(0.2 * step)
    return wave * np.array((0.4, -0.4, -0.4, 0.4, 0.5, -0.5, -0.5, 0.5))


def test_it_walks_as_far_as_in_pybullet() -> None:
    env = MinitaurBulletEnv(env_randomizer=None, motor_kp=1.2)
    env.reset(seed=1)
    total = sum(env.step(gait(step))[1] for step in range(200))
    assert env.minitaur.GetBasePosition() == pytest.approx((0.9514, 0.0687, 0.1998), abs=0.02)
    assert total == pytest.approx(0.8924, abs=0.02)
    env.close()


def test_it_trots_as_far_as_in_pybullet() -> None:
    env = MinitaurTrottingEnv()
    env.reset(seed=1)
    for _ in range(200):
        assert not env.step(np.zeros(8))[2]
    assert env.minitaur.GetBasePosition() == pytest.approx((0.3725, -0.0021, 0.2161), abs=0.02)
    env.close()
