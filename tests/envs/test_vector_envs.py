"""Environment k of N is the single environment with its seed, over whole episodes."""

from __future__ import annotations

from inspect import signature
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.envs.registration import load_env_creator
from gymnasium.vector import AutoresetMode
from tests.rings import few

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


def steps_of(length: int) -> int:
    """How long to play: beyond the first episodes that are as long as they may be."""
    return max(200, length + 5)


def action_of(space: Any, world: int, step: int) -> Any:
    """Actions that differ between environments, some beyond what robots take."""
    if isinstance(space, gymnasium.spaces.Discrete):
        return (step // 3 + world) % 2
    wave = np.sin(0.13 * (world + 1) * step + np.arange(space.shape[0]))
    return (1.2 * wave * space.high).astype(np.float32)


def alone(name: str, seed: int, world: int, mode: AutoresetMode, length: int) -> list[tuple[Any, ...]]:
    """What the single environment gives, begun anew as the vector environment does."""
    env: Any = gymnasium.make(name, max_episode_steps=length)
    told: list[tuple[Any, ...]] = [(env.reset(seed=seed)[0],)]
    over = False
    for step in range(steps_of(length)):
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
@pytest.mark.parametrize("name", few(LENGTHS, 3))
def test_each_is_the_single_environment_with_its_seed(name: str, mode: AutoresetMode):
    assert episodes_that_agree(name, mode, LENGTHS[name]) >= 2 * COUNT


@pytest.mark.long
def test_an_episode_of_a_thousand_steps_agrees_to_its_end():
    assert episodes_that_agree("HalfCheetahBulletEnv-v0", AutoresetMode.NEXT_STEP, 1000) == COUNT


def episodes_that_agree(name: str, mode: AutoresetMode, length: int) -> int:
    """Compares many environments with single ones; how many episodes have ended."""
    many: Any = gymnasium.make_vec(
        name, num_envs=COUNT, max_episode_steps=length, autoreset_mode=mode, threads=2
    )
    singles = [alone(name, SEED + world, world, mode, length) for world in range(COUNT)]
    observations = many.reset(seed=SEED)[0]
    assert observations.dtype == np.float32
    assert many.observation_space.shape == observations.shape
    same(observations, [told[0][0] for told in singles], "the beginning")
    begun = 0
    for step in range(steps_of(length)):
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
    many.close()
    return begun


def test_those_that_can_be_made_many_at_once_are_registered():
    assert set(LENGTHS) <= set(pybullet_envs._VECTORS)
    for name in pybullet_envs._VECTORS:
        assert gymnasium.spec(name).vector_entry_point


@pytest.mark.parametrize("name", [*LENGTHS, "KukaBulletEnv-v0"])
def test_there_is_one_unless_more_are_asked_for(name: str):
    made = load_env_creator(str(gymnasium.spec(name).vector_entry_point))
    assert signature(made).parameters["num_envs"].default == 1


def test_a_kuka_repeats_its_actions_as_the_single_one_does():
    options = {"isDiscrete": True, "actionRepeat": 3}
    many: Any = gymnasium.make_vec("KukaBulletEnv-v0", num_envs=1, **options)
    single: Any = gymnasium.make("KukaBulletEnv-v0", **options)
    same(many.reset(seed=SEED)[0][0], single.reset(seed=SEED)[0], "the beginning")
    for step in range(3):
        same(many.step(np.array([step]))[0][0], single.step(step)[0], step)
    many.close()
    single.close()


@pytest.mark.long
@pytest.mark.parametrize("options", [{}, {"isDiscrete": True, "actionRepeat": 3}], ids=["numbers", "choices"])
def test_each_kuka_is_the_single_one_with_its_seed(options: dict[str, Any]):
    """Their episodes end in a thousand steps of grasping and lifting."""
    many: Any = gymnasium.make_vec("KukaBulletEnv-v0", num_envs=2, **options)
    singles: list[Any] = [gymnasium.make("KukaBulletEnv-v0", **options) for _ in range(2)]
    expected: list[Any] = [(single.reset(seed=SEED + k)[0],) for k, single in enumerate(singles)]
    same(many.reset(seed=SEED)[0], [told[0] for told in expected], "the beginning")
    begun = 0
    for step in range(999):
        actions = [action_of(many.single_action_space, world, step) for world in range(2)]
        observations, rewards, terminations, _, _ = many.step(np.array(actions))
        for world, single in enumerate(singles):
            if len(expected[world]) > 1 and expected[world][2]:
                expected[world] = (single.reset()[0], 0.0, False)
                begun += 1
            else:
                expected[world] = single.step(actions[world])
        same(observations, [told[0] for told in expected], step)
        same(rewards, [told[1] for told in expected], step)
        assert terminations.tolist() == [told[2] for told in expected], step
        if begun == 2:
            break
    assert begun == 2
    many.close()
