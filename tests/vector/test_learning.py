"""Learning libraries train on the vector environments, and what they train gets better."""

import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest

import pybullet_envs  # noqa: F401  # registers the environments

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def train_ppo(monkeypatch):
    pytest.importorskip("torch")
    monkeypatch.syspath_prepend(str(EXAMPLES))
    yield __import__("train_ppo")
    sys.modules.pop("train_ppo", None)


@pytest.mark.long
def test_ppo_learns_to_balance_the_pole(train_ppo, tmp_path):
    size = ["--envs", "16", "--steps", "25000", "--length", "64"]
    curve = train_ppo.main(
        ["--env", "CartPoleBulletEnv-v1", *size, "--rate", "1e-3", "--seed", "1", "--out", str(tmp_path)]
    )
    first, last = curve[0][2], curve[-1][2]
    assert first < 60.0
    assert last > 100.0
    assert (tmp_path / "learning-curve.svg").stat().st_size > 1000
    assert (tmp_path / "policy.pt").exists()


@pytest.mark.long
def test_ppo_takes_actions_that_are_numbers(train_ppo):
    _, scale, curve = train_ppo.train(
        "InvertedPendulumBulletEnv-v0", envs=8, steps=1024, length=64, quiet=True
    )
    assert scale.mean.shape == (5,)
    assert np.isfinite([row[2] for row in curve]).all()


@pytest.mark.long
def test_stable_baselines_trains_on_it():
    pytest.importorskip("stable_baselines3")
    from stable_baselines3 import PPO
    from stable_baselines3.common.evaluation import evaluate_policy

    from carom.vector.stable_baselines import StableBaselinesEnv

    many = gymnasium.make_vec("CartPoleBulletEnv-v1", num_envs=8, autoreset_mode="SameStep")
    env = StableBaselinesEnv(many)
    model = PPO("MlpPolicy", env, n_steps=128, batch_size=256, learning_rate=1e-3, seed=1, device="cpu")
    before = np.mean(evaluate_policy(model, env, n_eval_episodes=8, warn=False)[0])
    model.learn(15000)
    assert np.mean(evaluate_policy(model, env, n_eval_episodes=8, warn=False)[0]) > 2.0 * before


def test_stable_baselines_is_told_what_the_last_observation_was_and_why_it_ended():
    pytest.importorskip("stable_baselines3")
    from carom.vector.stable_baselines import StableBaselinesEnv

    many = gymnasium.make_vec(
        "ReacherBulletEnv-v0", num_envs=2, max_episode_steps=3, autoreset_mode="SameStep"
    )
    twin = gymnasium.make_vec("ReacherBulletEnv-v0", num_envs=2, autoreset_mode="SameStep")
    env = StableBaselinesEnv(many)
    env.seed(4)
    assert (env.reset() == twin.reset(seed=4)[0]).all()
    actions = np.full((2, 2), 0.5, np.float32)
    for _ in range(2):
        _, _, over, _ = env.step(actions)
        assert not over.any()
        twin.step(actions)
    observations, _, over, infos = env.step(actions)
    expected = twin.step(actions)[0]
    assert over.all()
    assert infos[1]["TimeLimit.truncated"]
    assert (infos[1]["terminal_observation"] == expected[1]).all()
    assert np.any(observations != expected)


def test_stable_baselines_needs_episodes_that_begin_in_the_same_step():
    pytest.importorskip("stable_baselines3")
    from carom.vector.stable_baselines import StableBaselinesEnv

    with pytest.raises(ValueError, match="SameStep"):
        StableBaselinesEnv(gymnasium.make_vec("CartPoleBulletEnv-v1", num_envs=2))


@pytest.fixture
def train_quadruped(train_ppo):
    yield __import__("train_quadruped")
    sys.modules.pop("train_quadruped", None)


@pytest.mark.long
def test_the_quadruped_continues_bit_for_bit_where_its_training_was(train_quadruped, tmp_path):
    size = {"envs": 8, "length": 8, "quiet": True}
    straight = train_quadruped.train(tmp_path / "straight", steps=256, **size)
    train_quadruped.train(tmp_path / "broken", steps=128, **size)
    broken = train_quadruped.train(tmp_path / "broken", steps=256, **size)
    without_times = [0, *range(4, len(train_quadruped.COLUMNS))]
    assert len(straight) == len(broken) == 4
    # The first two rows have been in a file, with six digits.
    found, expected = (np.array(rows)[:, without_times] for rows in (broken, straight))
    np.testing.assert_allclose(found[:2], expected[:2], rtol=1e-5)
    np.testing.assert_array_equal(found[2:], expected[2:])
    train_quadruped.main(["--draw", "--out", str(tmp_path / "broken")])
    assert (tmp_path / "broken" / "learning-curve.svg").stat().st_size > 1000
