"""Environment k of N is the single environment with its seed, over whole episodes."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import pybullet_envs

SEED, COUNT = 7, 3
# Names, and after how many steps episodes are cut off, so that there are several of each.
LENGTHS = {
    "CartPoleBulletEnv-v1": 60,
    "CartPoleContinuousBulletEnv-v0": 60,
    "InvertedPendulumBulletEnv-v0": 40,
    "InvertedPendulumSwingupBulletEnv-v0": 90,
    "InvertedDoublePendulumBulletEnv-v0": 40,
    "ReacherBulletEnv-v0": 60,
    "PusherBulletEnv-v0": 60,
    "HopperBulletEnv-v0": 120,
    "Walker2DBulletEnv-v0": 120,
    "HalfCheetahBulletEnv-v0": 90,
    "AntBulletEnv-v0": 80,
    "HumanoidBulletEnv-v0": 60,
}
STEPS = 200


def action_of(space: Any, world: int, step: int) -> Any:
    """Actions that differ between environments, some beyond what robots take."""
    if isinstance(space, gymnasium.spaces.Discrete):
        return (step // 3 + world) % 2
    wave = np.sin(0.13 * (world + 1) * step + np.arange(space.shape[0]))
    return (1.2 * wave * space.high).astype(np.float32)


def alone(name: str, seed: int, world: int, mode: AutoresetMode) -> list[tuple[Any, ...]]:
    """What the single environment gives, begun anew as the vector environment does."""
    env: Any = gymnasium.make(name, max_episode_steps=LENGTHS[name])
    told: list[tuple[Any, ...]] = [(env.reset(seed=seed)[0],)]
    over = False
    for step in range(STEPS):
        if over and mode == AutoresetMode.NEXT_STEP:
            told.append((env.reset()[0], 0.0, False, False))
            over = False
            continue
        observation, reward, ended, cut, _ = env.step(action_of(env.action_space, world, step))
        over = ended or cut
        if over and mode == AutoresetMode.SAME_STEP:
            told.append((env.reset()[0], reward, ended, cut, observation))
        else:
            told.append((observation, reward, ended, cut))
    env.close()
    return told


def same(told: Any, expected: Any, where: Any) -> None:
    np.testing.assert_allclose(told, expected, rtol=0, atol=1e-12, err_msg=f"at {where}")


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP], ids=lambda m: m.name)
@pytest.mark.parametrize("name", LENGTHS)
def test_each_is_the_single_environment_with_its_seed(name: str, mode: AutoresetMode):
    many: Any = gymnasium.make_vec(
        name, num_envs=COUNT, max_episode_steps=LENGTHS[name], autoreset_mode=mode, threads=2
    )
    singles = [alone(name, SEED + world, world, mode) for world in range(COUNT)]
    observations = many.reset(seed=SEED)[0]
    assert observations.dtype == np.float32
    assert many.observation_space.shape == observations.shape
    same(observations, [told[0][0] for told in singles], "the beginning")
    begun = 0
    for step in range(STEPS):
        actions = [action_of(many.single_action_space, world, step) for world in range(COUNT)]
        observations, rewards, terminations, truncations, infos = many.step(np.array(actions))
        expected = [told[step + 1] for told in singles]
        same(observations, [told[0] for told in expected], step)
        same(rewards, [told[1] for told in expected], step)
        assert terminations.tolist() == [told[2] for told in expected], step
        assert truncations.tolist() == [told[3] for told in expected], step
        begun += int((terminations | truncations).sum())
        last = {world: told[4] for world, told in enumerate(expected) if len(told) == 5}
        assert np.flatnonzero(infos.get("_final_obs", [])).tolist() == list(last)
        for world, observation in last.items():
            same(infos["final_obs"][world], observation, step)
    assert begun >= 2 * COUNT
    many.close()


def test_those_that_can_be_made_many_at_once_are_registered():
    assert set(LENGTHS) <= set(pybullet_envs._VECTORS)
    for name in pybullet_envs._VECTORS:
        assert gymnasium.spec(name).vector_entry_point
