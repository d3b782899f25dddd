"""What every `WorldsEnv` does, shown on the cart-pole."""

from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.error import ResetNeeded

import pybullet_envs  # noqa: F401  # registers the environments
from carom.errors import SimulationWarning
from pybullet_envs.vector.cartpole import CartPoleContinuousVectorEnv, CartPoleVectorEnv

RIGHT = np.ones(3, dtype=np.int64)


def played(env: Any, steps: int) -> list[np.ndarray]:
    return [env.step(RIGHT)[0] for _ in range(steps)]


def test_an_environment_depends_on_its_own_seed_alone():
    few, many = CartPoleVectorEnv(1), CartPoleVectorEnv(5)
    (alone,), together = few.reset(seed=12)[0], many.reset(seed=10)[0]
    assert (alone == together[2]).all()
    assert len(np.unique(together[:, 0])) == 5
    listed = many.reset(seed=[12, None, 10, 11, 14])[0]
    assert (listed[0] == alone).all()
    assert (listed[2] == together[0]).all()
    assert many.np_random_seed[3] == 11


def test_without_a_seed_random_numbers_go_on():
    env = CartPoleVectorEnv(3)
    first, second = env.reset(seed=1)[0], env.reset()[0]
    assert (first != second).any()
    assert (env.reset(seed=1)[0] == first).all()
    assert (env.reset()[0] == second).all()


def test_as_many_seeds_as_environments():
    with pytest.raises(ValueError, match="2 seeds for 3 environments"):
        CartPoleVectorEnv(3).reset(seed=[1, 2])


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_the_number_of_threads_changes_nothing(threads: int):
    one, other = CartPoleVectorEnv(3, threads=1), CartPoleVectorEnv(3, threads=threads)
    one.reset(seed=3)
    other.reset(seed=3)
    assert (np.array(played(one, 60)) == np.array(played(other, 60))).all()


def test_episodes_are_cut_off_when_they_are_long_enough():
    env = CartPoleVectorEnv(3, max_episode_steps=4)
    env.reset(seed=0)
    told = [env.step(RIGHT) for _ in range(6)]
    assert [step[3].all() for step in told] == [False, False, False, True, False, False]
    assert [float(step[1].sum()) for step in told] == [3.0, 3.0, 3.0, 3.0, 0.0, 3.0]


def test_begun_by_hand_only_those_of_the_mask_begin():
    env = CartPoleVectorEnv(3, max_episode_steps=4, autoreset_mode="Disabled")
    env.reset(seed=0)
    last = played(env, 4)[-1]
    with pytest.raises(ResetNeeded, match="environment 0 is over"):
        env.step(RIGHT)
    begun = env.reset(options={"reset_mask": np.array([True, False, True])})[0]
    assert (begun[1] == last[1]).all()
    assert (np.abs(begun[[0, 2]]) <= 0.05).all()
    with pytest.raises(ResetNeeded, match="environment 1 is over"):
        env.step(RIGHT)
    env.reset(options={"reset_mask": np.array([False, True, False])})
    env.step(RIGHT)


@pytest.mark.parametrize("mask", [[1, 0, 1], np.array([True])])
def test_a_mask_that_does_not_fit_is_refused(mask: Any):
    env = CartPoleVectorEnv(3)
    with pytest.raises(ValueError, match="booleans of shape"):
        env.reset(options={"reset_mask": mask})


def test_steps_need_a_beginning():
    with pytest.raises(ResetNeeded, match="call reset first"):
        CartPoleVectorEnv(3).step(RIGHT)


@pytest.mark.parametrize(
    ("actions", "says"),
    [
        (np.ones(2, int), r"shape \(2,\); they must have shape \(3,\)"),
        (np.ones(3), "must be integers"),
        (np.array([0, 2, 1]), "environment 1 is 2; there are 0 to 1"),
    ],
)
def test_choices_that_are_none_are_refused(actions: np.ndarray, says: str):
    env = CartPoleVectorEnv(3)
    start = env.reset(seed=0)[0]
    with pytest.raises(ValueError, match=says):
        env.step(actions)
    assert (env.observe() == start).all()


def test_actions_that_are_not_finite_are_refused():
    env = CartPoleContinuousVectorEnv(3)
    env.reset(seed=0)
    with pytest.raises(ValueError, match="environment 2 is not finite"):
        env.step(np.array([[0.0], [1.0], [np.nan]]))


def test_a_world_that_goes_wrong_ends_its_episode_and_no_other():
    env, twin = CartPoleVectorEnv(3), CartPoleVectorEnv(3)
    env.reset(seed=0)
    twin.reset(seed=0)
    env.worlds[0].joints.velocities[1] = np.nan
    with pytest.warns(SimulationWarning, match="world 1 is halted"):
        _, _, terminations, truncations, infos = env.step(RIGHT)
    assert infos["halted"].tolist() == truncations.tolist() == [False, True, False]
    assert not terminations.any()
    twin.step(RIGHT)
    observations, rewards, _, truncations, infos = env.step(RIGHT)
    assert np.isfinite(observations).all()
    assert rewards.tolist() == [1.0, 0.0, 1.0]
    assert not truncations.any()
    assert "halted" not in infos
    assert (observations[[0, 2]] == twin.step(RIGHT)[0][[0, 2]]).all()


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"num_envs": 0}, "count must be at least 1"),
        ({"max_episode_steps": 0}, "max_episode_steps must be at least 1"),
        ({"render_mode": "human"}, "render_mode must be one of"),
        ({"autoreset_mode": "never"}, "never"),
        ({"threads": 0}, "threads must be at least 1"),
    ],
)
def test_bad_arguments_are_refused(options: dict[str, Any], says: str):
    with pytest.raises(ValueError, match=says):
        CartPoleVectorEnv(**{"num_envs": 2, **options})


def test_pictures_are_those_of_the_single_environment():
    many: Any = gymnasium.make_vec("ReacherBulletEnv-v0", num_envs=2, render_mode="rgb_array")
    single: Any = gymnasium.make("ReacherBulletEnv-v0", render_mode="rgb_array")
    many.reset(seed=1)
    single.reset(seed=2)
    first, second = many.render()
    assert first.shape == (240, 320, 3)
    assert (first != second).any()
    expected = single.render().astype(int)
    # The light is another; where things are is not.
    assert np.corrcoef(second.astype(int).ravel(), expected.ravel())[0, 1] > 0.8
    single.close()
    many.close()


def test_gymnasiums_wrappers_work_on_it():
    env: Any = gymnasium.make_vec("CartPoleBulletEnv-v1", num_envs=3, max_episode_steps=5)
    env = gymnasium.wrappers.vector.RecordEpisodeStatistics(env)
    env.reset(seed=0)
    infos: Any = [env.step(RIGHT)[4] for _ in range(5)][-1]
    assert infos["episode"]["l"].tolist() == [5, 5, 5]
    assert infos["episode"]["r"].tolist() == [5.0, 5.0, 5.0]
