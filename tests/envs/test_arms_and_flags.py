"""What the arms and the runners after flags do beyond their recorded first steps."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest

from pybullet_envs.gym_locomotion_envs import (
    HalfCheetahBulletEnv,
    HumanoidFlagrunBulletEnv,
    HumanoidFlagrunHarderBulletEnv,
)
from pybullet_envs.gym_manipulator_envs import StrikerBulletEnv, ThrowerBulletEnv

STILL = np.zeros(17)


def test_a_striker_is_there_though_pybullet_does_not_list_it() -> None:
    env = StrikerBulletEnv()
    assert "StrikerBulletEnv-v0" not in gymnasium.registry
    seen, _ = env.reset(seed=4)
    assert env.observation_space.contains(seen)
    _, first, *_ = env.step(np.zeros(7))
    # The ball lies still, so only the goal that sinks and the arm's own motion change what it is worth.
    assert first < 0.0
    env.close()


def test_the_strikers_reward_is_for_coming_near() -> None:
    env: Any = StrikerBulletEnv()
    env.reset(seed=4)
    ball, goal, paddle = (env._position(name) for name in ("object", "target", "fingertip"))
    apart = np.linalg.norm(ball - goal)
    assert env._success(2.0) == pytest.approx(-3.0 * apart - 0.2 - 0.5 * np.linalg.norm(ball - paddle))
    env.strike_threshold = 10.0
    env._success(0.0)
    assert env._struck_at == pytest.approx(paddle)
    env.close()


def test_where_a_thrown_ball_came_down_counts() -> None:
    env: Any = ThrowerBulletEnv()
    env.reset(seed=4)
    ball = env.parts.links["object"].body
    goal = env._position("target")
    env._p.resetBasePositionAndOrientation(ball, (*goal[:2], -0.5), (0, 0, 0, 1))
    assert env._success(0.0) == pytest.approx(0.0, abs=1e-6)
    env._p.resetBasePositionAndOrientation(ball, (3.0, 3.0, 1.0), (0, 0, 0, 1))
    assert env._success(1.0) == pytest.approx(-0.002, abs=1e-6)
    env.close()


def test_a_flag_moves_on_after_150_steps() -> None:
    env: Any = HumanoidFlagrunBulletEnv()
    env.reset(seed=2)
    first = env.goal
    for _ in range(148):
        env.step(STILL)
        assert env.goal == first
    _, reward, *_ = env.step(STILL)
    assert env.goal != first
    assert abs(reward) > 10.0
    assert env._p.getBasePositionAndOrientation(env._flag)[0] == (*env.goal, 0.7)
    env.close()


def test_a_flag_that_is_reached_moves_on() -> None:
    env: Any = HumanoidFlagrunBulletEnv()
    env.reset(seed=2)
    env.goal = env._middle()
    env.step(STILL)
    assert np.hypot(*(a - b for a, b in zip(env.goal, env._middle(), strict=True))) > 1.0
    env.close()


def test_one_who_lies_too_long_is_given_up() -> None:
    env: Any = HumanoidFlagrunHarderBulletEnv()
    env.reset(seed=2)
    steps = 0
    ended = False
    while not ended:
        *_, ended, _, _ = env.step(STILL)
        steps += 1
        assert steps < 300
    assert steps > 170
    env.close()


def test_a_cube_is_hurled_at_one_who_stands() -> None:
    env: Any = HumanoidFlagrunHarderBulletEnv()
    env.reset(seed=2)
    env._steps = 120
    env.step(STILL)
    place, _ = env._p.getBasePositionAndOrientation(env._cube)
    velocity, _ = env._p.getBaseVelocity(env._cube)
    assert np.hypot(place[0], place[1]) == pytest.approx(4.0, abs=1.0)
    assert 18.0 < np.linalg.norm(velocity) < 32.0
    assert np.dot(place[:2], velocity[:2]) < 0.0
    env.close()


def test_a_cheetah_that_lies_goes_on() -> None:
    env: Any = HalfCheetahBulletEnv()
    env.reset(seed=2)
    for _ in range(60):
        *_, ended, _, _ = env.step(np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0]))
        assert not ended
    env.close()
