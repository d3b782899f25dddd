"""What the arms and the runners after flags do beyond their recorded first steps."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest

from pybullet_envs.gym_locomotion_envs import (
    HalfCheetahBulletEnv,
    HumanoidBulletEnv,
    HumanoidFlagrunBulletEnv,
    HumanoidFlagrunHarderBulletEnv,
)
from pybullet_envs.gym_manipulator_envs import StrikerBulletEnv, ThrowerBulletEnv

STILL = np.zeros(17)


def goal(env: Any) -> tuple[float, float]:
    return env.robot.walk_target_x, env.robot.walk_target_y


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
    robot = env.robot
    ball, goal, paddle = (part.pose().xyz() for part in (robot.object, robot.target, robot.fingertip))
    apart = np.linalg.norm(ball - goal)
    assert env._success(2.0) == pytest.approx(-3.0 * apart - 0.2 - 0.5 * np.linalg.norm(ball - paddle))
    env.strike_threshold = 10.0
    env._success(0.0)
    assert env._struck_at == pytest.approx(paddle)
    env.close()


def test_where_a_thrown_ball_came_down_counts() -> None:
    env: Any = ThrowerBulletEnv()
    env.reset(seed=4)
    ball, goal = env.robot.object.body, env.robot.target.pose().xyz()
    env._p.resetBasePositionAndOrientation(ball, (*goal[:2], -0.5), (0, 0, 0, 1))
    assert env._success(0.0) == pytest.approx(0.0, abs=1e-6)
    env._p.resetBasePositionAndOrientation(ball, (3.0, 3.0, 1.0), (0, 0, 0, 1))
    assert env._success(1.0) == pytest.approx(-0.002, abs=1e-6)
    env.close()


def test_a_flag_moves_on_after_150_steps() -> None:
    env: Any = HumanoidFlagrunBulletEnv()
    env.reset(seed=2)
    first = goal(env)
    for _ in range(148):
        env.step(STILL)
        assert goal(env) == first
    _, reward, *_ = env.step(STILL)
    assert goal(env) != first
    assert abs(reward) > 10.0
    assert env.robot.flag.current_position().tolist() == [*goal(env), 0.7]
    env.close()


def test_a_flag_that_is_reached_moves_on() -> None:
    env: Any = HumanoidFlagrunBulletEnv()
    env.reset(seed=2)
    env.robot.walk_target_x, env.robot.walk_target_y = env.robot.body_xyz[:2]
    env.step(STILL)
    assert env.robot.walk_target_dist > 1.0
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
    env.robot.frame = 120
    env.step(STILL)
    place, velocity = env.robot.aggressive_cube.current_position(), env.robot.aggressive_cube.speed()
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


def test_a_person_may_begin_lying_down_in_any_direction() -> None:
    env: Any = HumanoidBulletEnv()
    env.robot.random_yaw = env.robot.random_lean = True
    heights, turns = set(), []
    for seed in range(8):
        env.reset(seed=seed)
        heights.add(round(float(env.robot.body_real_xyz[2]), 2))
        turns.append(env.robot.body_rpy[2])
    assert heights == {1.4, 0.45, 0.25}
    assert max(turns) - min(turns) > 1.0
    env.close()
