from __future__ import annotations

import subprocess
import sys
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from tests.rings import few

import pybullet as p
import pybullet_envs

# Numbers, or shape, of an observation, and numbers of an action; none where there is a choice of two.
SIZES: dict[str, tuple[int | tuple[int, ...], int | None]] = {
    "CartPoleBulletEnv-v1": (4, None),
    "CartPoleContinuousBulletEnv-v0": (4, 1),
    "InvertedPendulumBulletEnv-v0": (5, 1),
    "InvertedPendulumSwingupBulletEnv-v0": (5, 1),
    "InvertedDoublePendulumBulletEnv-v0": (9, 1),
    "ReacherBulletEnv-v0": (9, 2),
    "PusherBulletEnv-v0": (55, 7),
    "ThrowerBulletEnv-v0": (48, 7),
    "RacecarBulletEnv-v0": (2, 2),
    "RacecarZedBulletEnv-v0": ((10, 100, 4), 2),
    "KukaBulletEnv-v0": (9, 3),
    "KukaCamBulletEnv-v0": ((256, 341, 4), 3),
    "KukaDiverseObjectGrasping-v0": ((48, 48, 3), 3),
    "MinitaurBulletEnv-v0": (28, 8),
    "MinitaurBulletDuckEnv-v0": (28, 8),
    "MinitaurExtendedEnv-v0": (20, 8),
    "MinitaurReactiveEnv-v0": (12, 8),
    "MinitaurBallGymEnv-v0": (2, 1),
    "MinitaurTrottingEnv-v0": (4, 8),
    "MinitaurStandGymEnv-v0": (28, 1),
    "MinitaurAlternatingLegsEnv-v0": (4, 8),
    "MinitaurFourLegStandEnv-v0": (2, 4),
    "HopperBulletEnv-v0": (15, 3),
    "Walker2DBulletEnv-v0": (22, 6),
    "HalfCheetahBulletEnv-v0": (26, 6),
    "AntBulletEnv-v0": (28, 8),
    "HumanoidBulletEnv-v0": (44, 17),
    "HumanoidFlagrunBulletEnv-v0": (44, 17),
    "HumanoidFlagrunHarderBulletEnv-v0": (44, 17),
}


def rollout(name: str, steps: int) -> tuple[list[np.ndarray], list[float]]:
    env: Any = gymnasium.make(name).unwrapped
    observations, rewards = [env.reset(seed=3)[0]], []
    for number in range(steps):
        shape = env.action_space.shape
        action = np.sin(0.1 * number + np.arange(shape[0])) if shape else number % 2
        observation, reward, done, *_ = env.step(action)
        observations.append(observation)
        rewards.append(reward)
        if done:
            break
    env.close()
    return observations, rewards


def test_all_of_them_are_listed() -> None:
    assert sorted(pybullet_envs.getList()) == sorted(f"- {name}" for name in SIZES)


@pytest.mark.parametrize("name", few(SIZES, 7))
def test_environments_are_what_gymnasium_expects(name: str) -> None:
    env: Any = gymnasium.make(name).unwrapped
    observed, acted = SIZES[name]
    assert env.observation_space.shape == ((observed,) if isinstance(observed, int) else observed)
    assert env.action_space.shape == (() if acted is None else (acted,))
    check_env(env, skip_render_check=True)
    env.close()


@pytest.mark.parametrize("name", few(SIZES, 5))
def test_the_same_seed_gives_the_same_episode(name: str) -> None:
    first, second = rollout(name, 20), rollout(name, 20)
    assert np.array_equal(first[0], second[0])
    assert first[1] == second[1]


@pytest.mark.parametrize("motion", ["Walk", "Backflip"])
def test_what_needs_recorded_motions_says_so(motion: str) -> None:
    with pytest.raises(p.error, match="is not available in this version of Carom: it imitates recorded"):
        gymnasium.make(f"HumanoidDeepMimic{motion}BulletEnv-v1")


def test_a_pole_that_nobody_holds_falls() -> None:
    env = gymnasium.make("InvertedPendulumBulletEnv-v0")
    env.reset(seed=1)
    steps = 0
    while not env.step(np.zeros(1, np.float32))[2]:
        steps += 1
        assert steps < 200
    env.close()


def test_a_pendulum_that_hangs_is_worth_less_than_nothing() -> None:
    env = gymnasium.make("InvertedPendulumSwingupBulletEnv-v0")
    env.reset(seed=1)
    assert float(env.step(np.zeros(1, np.float32))[1]) < -0.9
    env.close()


def test_pictures() -> None:
    env: Any = gymnasium.make("AntBulletEnv-v0", render_mode="rgb_array").unwrapped
    assert env.render().min() == 255
    env.reset(seed=1)
    assert env.render().shape == (240, 320, 3)
    assert env.render().min() < 200
    env.close()


def test_actions_that_are_no_numbers_are_refused() -> None:
    env: Any = gymnasium.make("AntBulletEnv-v0").unwrapped
    env.reset(seed=1)
    with pytest.raises(ValueError, match="not finite"):
        env.step(np.full(8, np.nan))
    env.close()


def test_without_gymnasium_it_says_what_to_install() -> None:
    code = "import sys; sys.modules['gymnasium'] = None\n"
    code += "from pybullet_envs.gym_locomotion_envs import AntBulletEnv; AntBulletEnv()"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "pip install 'carom[envs]'" in run.stderr


def test_pictures_need_no_render_mode() -> None:
    env: Any = gymnasium.make("InvertedPendulumBulletEnv-v0")
    env.reset(seed=1)
    picture = env.render()
    assert picture.shape == (240, 320, 3)
    assert len(np.unique(picture)) > 20
    assert np.array_equal(env.unwrapped.render("rgb_array"), picture)
    assert env.unwrapped.render("human") is None
    env.close()
