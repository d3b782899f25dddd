"""The Panda can do what its tasks ask for."""

import gc
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from numpy.testing import assert_allclose

import carom.vector  # noqa: F401  # registers the tasks
from carom.vector.panda import PandaPick, PandaPush, PandaReach
from carom.world.world import World

TASKS = ("carom/PandaReach-v0", "carom/PandaPush-v0", "carom/PandaPick-v0")


@pytest.mark.parametrize("name", TASKS)
def test_each_of_many_is_the_single_one_with_its_seed(name: str):
    many: Any = gymnasium.make_vec(name, num_envs=3, max_episode_steps=12)
    singles: list[Any] = [gymnasium.make(name, max_episode_steps=12) for _ in range(3)]
    observations = [many.reset(seed=5)[0]]
    alone = [[single.reset(seed=5 + k)[0] for k, single in enumerate(singles)]]
    over = False
    for step in range(30):
        actions = np.array(
            [np.sin(0.3 * step * (k + 1) + np.arange(many.action_space.shape[1])) for k in range(3)]
        )
        told = many.step(actions)
        observations.append(told[0])
        if over:
            alone.append([single.reset()[0] for single in singles])
            over = False
            continue
        expected = [single.step(action) for single, action in zip(singles, actions, strict=True)]
        alone.append([e[0] for e in expected])
        assert told[1].tolist() == [e[1] for e in expected]
        assert told[4]["success"].tolist() == [e[4]["success"] for e in expected]
        over = bool(told[3][0])
    assert (np.array(observations) == np.array(alone)).all()


@pytest.mark.parametrize("name", TASKS)
def test_the_single_ones_are_as_gymnasium_wants_them(name: str):
    env: Any = gymnasium.make(name, render_mode="rgb_array")
    check_env(env.unwrapped)
    assert env.unwrapped.render().shape == (240, 320, 3)


def towards(env: Any, places: np.ndarray) -> np.ndarray:
    """Actions that move the tips, pointing down, towards places, by Jacobians found by trying."""
    panda, row = env._panda, env._tip_row
    here, poses = panda.joints.positions.copy(), panda.links.poses[:, row]
    slopes = np.empty((env.num_envs, 7, 7))
    for joint in range(7):
        panda.joints.positions[:, joint] += 1e-4
        slopes[:, :, joint] = (panda.links.poses[:, row] - poses) / 1e-4
        panda.joints.positions[:] = here
    down = np.sign(poses[:, 3:4]) * (1.0, 0.0, 0.0, 0.0)
    way = np.concatenate([places, down], axis=1) - poses
    return np.clip(np.einsum("nij,nj->ni", np.linalg.pinv(slopes, rcond=1e-3), way) / 0.05, -1.0, 1.0)


def test_hands_begin_level_above_the_floor_and_near_one_pose():
    env = PandaReach(400)
    env.reset(seed=3)
    positions, tips = env._panda.joints.positions, env._panda.links.poses[:, env._tip_row]
    mean = positions.mean(axis=0)
    assert (np.abs(positions[:, :7] - mean[:7]) < 0.12).all()
    positions[:] = mean
    # Where they begin on the mean, they point straight down, and fingers open along an axis of the world.
    assert_allclose(np.abs(env._panda.links.poses[0, env._tip_row, 3:]), [1.0, 0.0, 0.0, 0.0], atol=0.01)
    assert (tips[:, 2] > 0.05).all()


def test_the_tips_reach_the_goals():
    env = PandaReach(4)
    env.reset(seed=1)
    for _ in range(60):
        env.step(towards(env, env.goals))
    _, rewards, _, _, infos = env.step(towards(env, env.goals))
    assert infos["success"].all()
    assert (rewards > 0.95).all()


def test_a_pushed_cube_moves_and_one_left_alone_does_not():
    env = PandaPush(2)
    env.reset(seed=2)
    start = env._places.copy()
    behind = start - np.array([0.07, 0.0, 0.0])
    for step in range(100):
        place = behind + np.array([0.0, 0.0, 0.1 if step < 30 else 0.0])
        if step >= 60:
            place = start + np.array([0.05, 0.0, 0.0])
        actions = towards(env, place)
        actions[1] = 0.0
        env.step(actions)
    moved = env._places - start
    assert moved[0, 0] > 0.03
    assert np.abs(moved[1]).max() < 1e-3


def test_the_fingers_pick_the_cube_up_and_bring_it_to_the_goal():
    env = PandaPick(3)
    env.reset(seed=3)
    infos: Any = None
    for step in range(150):
        over = np.array([0.0, 0.0, 0.15 if step < 30 else 0.0])
        carried = step >= 80
        place = env.goals + (env._tips - env._places) if carried else env._places + over
        turns = towards(env, place) * (0.4 if carried else 1.0)
        opening = np.full(3, 1.0 if step < 60 else -1.0)
        infos = env.step(np.column_stack([turns, opening]))[4]
    assert infos["success"].all(), (env._places, env.goals)


def test_an_action_of_one_turns_the_target_of_a_joint_by_a_twentieth_of_a_radian():
    env = PandaReach(1)
    env.reset(seed=0)
    before = env._panda.joints.positions[0, :7].copy()
    env.step(np.full((1, 7), 0.5))
    env.step(np.full((1, 7), 0.5))
    for _ in range(30):
        env.step(np.zeros((1, 7)))
    assert_allclose(env._panda.joints.positions[0, :7] - before, 0.05, atol=0.005)


def worlds_that_are_kept() -> int:
    return sum(isinstance(one, World) for one in gc.get_objects())


def test_everything_is_freed_when_nobody_has_the_environment_any_more():
    gc.collect()
    gc.disable()
    try:
        before = worlds_that_are_kept()
        env = PandaReach(1)
        assert worlds_that_are_kept() > before
        del env
        assert worlds_that_are_kept() == before
    finally:
        gc.enable()
