"""Environments from terms: what terms add up to, what resets clear, and that worlds do not mix."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from tests.vector.managers.balls import COUNT, STEP, Balls, actions, changed, wanted

from carom.vector import SingleEnv
from carom.vector.managers import Command, Curriculum, Event, Observation, Reward, Task, Termination
from carom.vector.managers.observing import Observer

MODES = ("NextStep", "SameStep", "Disabled")


def played(env: Balls, steps: int, first: int = 0) -> list[Any]:
    """Steps with fixed actions; episodes that are over are begun by hand where that is needed."""
    told = []
    for step in range(first, first + steps):
        told.append(env.step(actions(env.num_envs, step)))
        over = told[-1][2] | told[-1][3]
        if env.autoreset_mode.value == "Disabled" and over.any():
            env.reset(options={"reset_mask": over})
    return told


def test_it_keeps_the_rules_of_gymnasium():
    check_env(SingleEnv(Balls, max_episode_steps=5), skip_render_check=True)


def test_the_observation_is_all_terms_side_by_side_scaled():
    silent = changed(observations={
        "height": Observation(lambda env: env.ball.base_inertial_poses[:, 2], scale=3.0),
        "velocity": Observation(lambda env: env.ball.base_velocities[:, :3], clip=(-0.02, 0.0)),
    })  # fmt: skip
    env = Balls(task=silent)
    env.reset(seed=0)
    observation = env.step(actions(COUNT, 0))[0]
    assert env.single_observation_space.shape == (4,)
    assert isinstance(env.observer, Observer)
    assert env.observer.columns == {"height": slice(0, 1), "velocity": slice(1, 4)}
    np.testing.assert_allclose(observation[:, 0], 3.0 * env.ball.base_inertial_poses[:, 2], rtol=1e-6)
    assert (observation[:, 3] == np.float32(-0.02)).all()


def test_noise_is_uniform_and_before_the_scale():
    env = Balls(400)
    env.reset(seed=0)
    noise = 2.0 * env.observe()[:, 1:4] - env.ball.base_velocities[:, :3]
    assert np.abs(noise).max() <= 0.1 + 1e-6
    assert np.abs(noise.mean()) < 0.01
    assert noise.std() == pytest.approx(0.1 / np.sqrt(3.0), rel=0.05)
    assert (env.observe()[:, 0] == np.float32(env.ball.base_inertial_poses[:, 2])).all()


def test_a_history_begins_with_the_first_value_and_looking_twice_changes_nothing():
    height = Observation(lambda env: env.ball.base_inertial_poses[:, 2], history=3)
    env = Balls(task=changed(observations={"height": height}), autoreset_mode="Disabled")
    first = env.reset(seed=0)[0]
    assert (first == first[:, :1]).all()
    one = env.step(actions(COUNT, 0))[0]
    two = env.step(actions(COUNT, 1))[0]
    assert (one[:, :2] == first[:, :2]).all()
    assert (two[:, :2] == one[:, 1:]).all()
    assert (two[:, 2] == np.float32(env.ball.base_inertial_poses[:, 2])).all()
    assert (env.observe() == two).all()
    began = env.reset(options={"reset_mask": np.array([True, False, False, False])})[0]
    assert (began[0] == began[0, 0]).all()
    assert (began[1:] == two[1:]).all()


def test_rewards_are_sums_of_weighted_terms_and_the_infos_have_each():
    env = Balls()
    env.reset(seed=0)
    total = {"height": np.zeros(COUNT), "effort": np.zeros(COUNT)}
    for step in range(3):
        chosen = actions(COUNT, step)
        _, reward, _, _, infos = env.step(chosen)
        terms = {
            "height": 2.0 * STEP * env.ball.base_inertial_poses[:, 2],
            "effort": -STEP * chosen[:, 0] ** 2,
        }
        np.testing.assert_allclose(reward, terms["height"] + terms["effort"], rtol=1e-12)
        for name, term in terms.items():
            total[name] = total[name] + term
            np.testing.assert_allclose(infos["rewards"][name], total[name], rtol=1e-12)


def test_a_reset_clears_the_sums_and_actions_of_its_worlds_alone():
    env = Balls(autoreset_mode="Disabled")
    env.reset(seed=0)
    played(env, 3)
    sums, before = env.reward_sums["height"].copy(), env.actions.copy()
    env.reset(options={"reset_mask": np.array([False, True, False, False])})
    assert env.reward_sums["height"][1] == env.actions[1, 0] == env.last_actions[1, 0] == 0.0
    others = [0, 2, 3]
    assert (env.reward_sums["height"][others] == sums[others]).all()
    assert (env.actions[others] == before[others]).all()


def test_time_outs_are_truncations():
    low = np.array([True, False, False, False])
    late = np.array([False, False, True, False])
    ends = {"low": Termination(lambda env: low), "late": Termination(lambda env: late, time_out=True)}
    env = Balls(task=changed(terminations=ends))
    env.reset(seed=0)
    _, _, terminations, truncations, infos = env.step(actions(COUNT, 0))
    assert (terminations == low).all()
    assert (truncations == late).all()
    assert (infos["terminations"]["late"] == late).all()
    # The first observation of the next episode is no end, whatever the terms say.
    _, rewards, terminations, truncations, _ = env.step(actions(COUNT, 1))
    assert not (terminations | truncations).any()
    assert (rewards[[0, 2]] == 0.0).all()
    assert (env.reward_sums["height"][[0, 2]] == 0.0).all()


def test_the_infos_of_an_episode_that_began_at_once_are_those_of_its_end():
    env = Balls(autoreset_mode="SameStep", max_episode_steps=3)
    env.reset(seed=0)
    infos = played(env, 3)[-1][4]
    last = infos["final_info"]["rewards"]["height"]
    assert infos["final_info"]["_rewards"].all()
    assert (last > 3.0 * STEP).all()
    assert (env.reward_sums["height"] == 0.0).all()


def test_events_of_the_start_happen_once_until_a_new_seed():
    env = Balls(max_episode_steps=2)
    env.reset(seed=0)
    masses = env.ball.dynamics(-1)["mass"]
    assert len(np.unique(masses)) == COUNT
    played(env, 6)
    env.reset()
    assert (env.ball.dynamics(-1)["mass"] == masses).all()
    env.reset(seed=1)
    assert (env.ball.dynamics(-1)["mass"] != masses).all()
    env.reset(seed=0)
    assert (env.ball.dynamics(-1)["mass"] == masses).all()


def test_intervals_and_commands_come_within_their_times():
    ends: dict[str, Termination] = {}
    env = Balls(50, task=changed(terminations=ends))
    env.reset(seed=0)
    commands, seen = [env.commands["wanted"][:, 0].copy()], [env.kicks.copy()]
    for step in range(240):
        env.step(actions(50, step))
        commands.append(env.commands["wanted"][:, 0].copy())
        seen.append(env.kicks.copy())
    # Two seconds: kicks 0.05 to 0.1 s apart, commands 0.1 to 0.2 s.
    assert env.kicks.min() >= 19
    assert env.kicks.max() <= 41
    for times, least, most in (
        (np.diff(seen, axis=0) != 0, 0.05, 0.1),
        (np.diff(commands, axis=0) != 0, 0.1, 0.2),
    ):
        gaps = np.concatenate([np.diff(np.flatnonzero(column)) for column in times.T]) * STEP
        assert gaps.min() >= least - STEP
        assert gaps.max() <= most + STEP
        assert gaps.std() > 0.01


def test_the_curriculum_sees_the_worlds_as_the_episode_left_them():
    falls = {"low": Termination(lambda env: env.ball.base_inertial_poses[:, 2] < 0.9)}
    env = Balls(task=changed(terminations=falls, events={"lift": Event(lambda env, worlds: None)}))
    env.reset(seed=0)
    told = played(env, 60)
    ended = np.sum([step[2] for step in told], axis=0)
    assert ended.min() >= 1
    assert (env.levels == ended).all()
    assert told[-1][4]["curriculum"]["level"][0] == ended.sum()


@pytest.mark.parametrize("mode", MODES)
def test_a_world_depends_on_its_own_seed_and_actions_alone(mode: str):
    many, one = Balls(COUNT, autoreset_mode=mode), Balls(1, autoreset_mode=mode)
    all_first, first = many.reset(seed=10)[0], one.reset(seed=12)[0]
    assert (all_first[2] == first[0]).all()
    ends = 0
    for step in range(200):
        chosen = actions(COUNT, step)
        together, alone = many.step(chosen), one.step(chosen[2:3])
        for all_of_them, own in zip(together[:4], alone[:4], strict=True):
            assert (all_of_them[2] == own[0]).all()
        ends += int(alone[2][0] | alone[3][0])
        if mode == "Disabled":
            for env, told in ((many, together), (one, alone)):
                over = told[2] | told[3]
                if over.any():
                    env.reset(options={"reset_mask": over})
    assert ends >= 2


FLAT = np.zeros(COUNT)


@pytest.mark.parametrize(
    ("terms", "says"),
    [
        ({"observations": {}}, "at least one observation"),
        ({"observations": {"o": Observation(lambda env: 1.0)}}, r"observation 'o' .* shape \(\); .*\(4, n\)"),
        ({"observations": {"o": Observation(lambda env: FLAT, noise=(1.0, 2.0))}}, "'o': noise and scale"),
        ({"observations": {"o": Observation(lambda env: FLAT, history=0)}}, "'o': history must be at least"),
        ({"commands": {"c": Command(lambda env, worlds: FLAT)}}, r"command 'c' .*\(4,\); .*\(4, n\)"),
        ({"commands": {"c": Command(wanted, seconds=(2.0, 1.0))}}, "command 'c': seconds"),
        ({"events": {"e": Event(lambda env, worlds: None, "interval", (0.0, 1.0))}}, "event 'e': seconds"),
    ],
)
def test_terms_that_do_not_fit_are_named_when_the_environment_is_made(terms: dict[str, Any], says: str):
    with pytest.raises(ValueError, match=says):
        Balls(task=changed(**terms))


@pytest.mark.parametrize(
    ("terms", "says"),
    [
        ({"rewards": {"r": Reward(lambda env: env.actions, 1.0)}}, r"reward 'r' .*\(4, 1\); .*\(4,\)"),
        ({"terminations": {"t": Termination(lambda env: True)}}, r"termination 't' .*\(\); .*\(4,\)"),
    ],
)
def test_results_of_a_wrong_shape_are_named_in_a_step(terms: dict[str, Any], says: str):
    env = Balls(task=changed(**terms))
    env.reset(seed=0)
    with pytest.raises(ValueError, match=says):
        env.step(actions(COUNT, 0))


def test_an_observation_that_changes_its_shape_is_named():
    heights = [np.zeros((COUNT, 2)), np.zeros((COUNT, 3))]
    env = Balls(task=changed(observations={"o": Observation(lambda env: heights.pop(0))}))
    with pytest.raises(ValueError, match=r"observation 'o' .*\(4, 3\); .*\(4, 2\)"):
        env.reset(seed=0)


def test_a_task_needs_no_more_than_observations_and_rewards():
    height = Observation(lambda env: env.ball.base_inertial_poses[:, 2])
    env = Balls(task=Task({"height": height}, {}))
    env.reset(seed=0)
    _, rewards, terminations, truncations, infos = env.step(actions(COUNT, 0))
    assert not rewards.any()
    assert not (terminations | truncations).any()
    assert infos["rewards"] == {}


def test_a_curriculum_that_has_not_spoken_tells_nothing():
    env = Balls(task=changed(curriculum={"level": Curriculum(lambda env, worlds: 1.0)}))
    env.reset(seed=0)
    assert env.step(actions(COUNT, 0))[4]["curriculum"] == {}
