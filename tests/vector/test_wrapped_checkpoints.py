"""Checkpoints of environments in Gymnasium's wrappers."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.wrappers.vector import NormalizeReward, RecordEpisodeStatistics
from tests.vector.managers.balls import Balls

import carom.vector


def wrapped() -> Any:
    return NormalizeReward(RecordEpisodeStatistics(Balls(max_episode_steps=7)))


def run(env: Any, steps: int) -> np.ndarray:
    found = [env.step(np.zeros(env.action_space.shape, np.float32)) for _ in range(steps)]
    return np.array([np.concatenate([each[0].ravel(), each[1]]) for each in found])


def test_what_wrappers_have_learnt_is_kept(tmp_path: Any) -> None:
    env, other = wrapped(), wrapped()
    env.reset(seed=1)
    other.reset(seed=2)
    run(env, 20)
    carom.vector.save(env, tmp_path / "checkpoint")
    wanted = run(env, 10)
    run(other, 3)
    carom.vector.restore(other, tmp_path / "checkpoint")
    assert np.array_equal(run(other, 10), wanted)
    assert other.return_rms.count == env.return_rms.count
    assert list(other.env.return_queue) == list(env.env.return_queue)


def test_other_wrappers_are_refused(tmp_path: Any) -> None:
    env = wrapped()
    env.reset(seed=1)
    carom.vector.save(env, tmp_path / "checkpoint")
    with pytest.raises(ValueError, match=r"of the wrappers \['NormalizeReward', 'RecordEpisodeStatistics'\]"):
        carom.vector.restore(env.env, tmp_path / "checkpoint")
    env.unwrapped.save(tmp_path / "plain")
    with pytest.raises(ValueError, match=r"env\.unwrapped\.restore"):
        carom.vector.restore(env, tmp_path / "plain")
    with pytest.raises(TypeError, match=r"carom\.vector\.WorldsEnv in wrappers"):
        carom.vector.save(gymnasium.make("CartPole-v1"), tmp_path / "x")
