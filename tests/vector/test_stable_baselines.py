"""What Stable-Baselines3 is given of a `WorldsEnv` in Gymnasium's wrappers."""

from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.wrappers.vector import NormalizeReward, RecordEpisodeStatistics, RescaleAction, TransformReward

import carom.vector  # noqa: F401  # registers the environments
import pybullet_envs  # noqa: F401  # registers the environments

pytest.importorskip("stable_baselines3")

from carom.vector.stable_baselines import StableBaselinesEnv

COUNT = 2


def reacher(**options: Any) -> Any:
    return gymnasium.make_vec(
        "ReacherBulletEnv-v0", num_envs=COUNT, autoreset_mode="SameStep", max_episode_steps=4, **options
    )


def panda(**options: Any) -> Any:
    return gymnasium.make_vec("carom/PandaReach-v0", num_envs=COUNT, autoreset_mode="SameStep", **options)


def test_a_wrapper_of_rewards_stays() -> None:
    env = StableBaselinesEnv(TransformReward(reacher(), lambda rewards: np.full_like(rewards, 7.0)))
    env.reset()
    rewards = env.step(np.zeros((COUNT, 2), np.float32))[1]
    assert rewards.tolist() == [7.0, 7.0]
    assert rewards.dtype == np.float32


def test_a_wrapper_that_normalises_stays() -> None:
    env, twin = StableBaselinesEnv(NormalizeReward(reacher())), NormalizeReward(reacher())
    env.seed(0)
    env.reset()
    twin.reset(seed=0)
    actions = np.full((COUNT, 2), 0.5, np.float32)
    for _ in range(3):
        np.testing.assert_array_equal(env.step(actions)[1], np.float32(twin.step(actions)[1]))


def test_a_wrapper_of_actions_stays() -> None:
    ten = np.full(2, 10.0, np.float32)
    wrapped = RescaleAction(reacher(), -ten, ten)
    env, twin = StableBaselinesEnv(wrapped), reacher()
    assert env.action_space == wrapped.single_action_space
    env.seed(0)
    env.reset()
    twin.reset(seed=0)
    observations = env.step(np.full((COUNT, 2), 5.0, np.float32))[0]
    np.testing.assert_array_equal(observations, twin.step(np.full((COUNT, 2), 0.5, np.float32))[0])


def test_it_can_be_asked_which_wrappers_there_are() -> None:
    env = StableBaselinesEnv(RecordEpisodeStatistics(NormalizeReward(reacher())))
    assert env.env_is_wrapped(NormalizeReward) == [True, True]
    assert env.env_is_wrapped(RescaleAction, indices=[1]) == [False]


def test_infos_of_each_environment_arrive() -> None:
    many = panda(max_episode_steps=3)
    env = StableBaselinesEnv(many)
    env.reset()
    goals = many.unwrapped.goals
    actions = np.zeros((COUNT, 7), np.float32)
    env.step(actions)
    goals[0] = many.unwrapped.moved()[0]
    infos = env.step(actions)[3]
    assert [bool(info["success"]) for info in infos] == [True, False]
    # In the last step as well, they are of that step and not of the episode that begins.
    *_, over, infos = env.step(actions)
    assert over.all()
    assert [bool(info["success"]) for info in infos] == [True, False]
    assert not any(name.startswith("_") or "final" in name for name in infos[0])


def test_statistics_of_gymnasium_arrive() -> None:
    env = StableBaselinesEnv(RecordEpisodeStatistics(reacher()))
    env.reset()
    actions = np.zeros((COUNT, 2), np.float32)
    told = [env.step(actions)[3] for _ in range(4)]
    assert "episode" not in told[2][0]
    assert told[3][1]["episode"]["l"] == 4
