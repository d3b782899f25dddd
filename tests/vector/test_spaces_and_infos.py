"""Observations, actions and infos of every kind, in all modes and alone."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from tests.physics.contact_scenes import add_ball, earth

from carom.vector import SingleEnv, WorldsEnv

COUNT, LENGTH = 3, 4
_UNBOUNDED = np.full(2, np.inf, np.float32)


class Falling(WorldsEnv):
    """Balls that fall; environment k's episode is over when its own number of steps has been taken."""

    def __init__(self, num_envs: int = COUNT, *, noise: float = 0.0, **options: Any) -> None:
        world = earth()
        ball = add_ball(world, (0.0, 0.0, 5.0))
        place = gymnasium.spaces.Box(-_UNBOUNDED, _UNBOUNDED)
        spaces = gymnasium.spaces
        super().__init__(
            world,
            num_envs,
            spaces.Dict({"place": place, "pair": spaces.Tuple((place, spaces.Discrete(100)))}),
            spaces.MultiDiscrete([2, 3], start=[0, 1]),
            steps=2,
            **options,
        )
        self.ball, self.noise = self.worlds[ball], noise
        self.lengths = np.full(num_envs, LENGTH)

    def begin(self, worlds: np.ndarray) -> None:
        places = self.random.uniform(worlds, -1.0, 1.0, 3)
        self.ball.set_base_inertial_poses(places[:, :3] + np.array([0.0, 0.0, 5.0]), where=worlds)

    def act(self, actions: np.ndarray) -> None:
        self.chosen = actions

    def observe(self) -> dict[str, Any]:
        noise = self.random.uniform(np.arange(self.num_envs), -1.0, 1.0, 2) * self.noise
        places = np.float32(self.ball.base_inertial_poses[:, :2] + noise)
        return {"place": places, "pair": (places + 1, self.episode_steps.copy())}

    def reward(self, actions: np.ndarray) -> np.ndarray:
        return actions.sum(axis=1).astype(float)

    def terminated(self) -> np.ndarray:
        return self.episode_steps >= self.lengths

    def infos(self) -> dict[str, Any]:
        steps = self.episode_steps.copy()
        return {"steps": steps, "parts": {"twice": 2 * steps, "kind": "ball"}, "rate": 0.5}


ACTIONS = np.tile([1, 3], (COUNT, 1))


def test_dictionaries_are_observed_in_the_same_step() -> None:
    env = Falling(autoreset_mode="SameStep")
    env.lengths[1] = 2
    first, _ = env.reset(seed=0)
    assert env.observation_space.contains(first)
    env.step(ACTIONS)
    now, _, terminations, _, infos = env.step(ACTIONS)
    assert terminations.tolist() == [False, True, False]
    assert infos["_final_obs"].tolist() == infos["_final_info"].tolist() == [False, True, False]
    last = infos["final_obs"][1]
    assert env.single_observation_space.contains(last)
    np.testing.assert_array_equal(last["place"], first["place"][1])
    assert last["pair"][1] == 2
    assert now["pair"][1].tolist() == [2, 0, 2]
    assert (now["place"][1] != first["place"][1]).any()
    # The infos of the last step are those of the episode that is over; the new one has none yet.
    assert infos["final_info"]["steps"][1] == 2
    assert infos["final_info"]["_steps"].tolist() == [False, True, False]
    assert infos["final_info"]["parts"]["twice"][1] == 4
    assert infos["_steps"].tolist() == infos["parts"]["_twice"].tolist() == [True, False, True]


def test_infos_have_masks_and_one_value_is_for_all() -> None:
    env = Falling(max_episode_steps=1)
    env.reset(seed=0)
    infos = env.step(ACTIONS)[4]
    assert infos["_steps"].all()
    assert infos["rate"].tolist() == [0.5] * COUNT
    assert infos["parts"]["kind"].tolist() == ["ball"] * COUNT
    assert infos["_parts"].all()
    begun = env.step(ACTIONS)[4]
    assert not begun["_steps"].any()


def test_infos_of_another_length_are_refused() -> None:
    env = Falling()
    env.infos = lambda: {"few": np.zeros(2)}  # type: ignore[method-assign]
    env.reset(seed=0)
    with pytest.raises(ValueError, match="'few' has 2 entries; it must have one for each of the 3"):
        env.step(ACTIONS)


def test_a_single_environment_has_dictionaries_and_nested_infos() -> None:
    env = SingleEnv(Falling, max_episode_steps=20)
    check_env(env, skip_render_check=True)
    env.reset(seed=1)
    observation, reward, *_, infos = env.step(np.array([1, 3]))
    assert env.observation_space.contains(observation)
    assert reward == 4.0
    assert infos == {"steps": 1, "parts": {"twice": 2, "kind": "ball"}, "rate": 0.5}


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_noise_of_an_environment_depends_on_nothing_but_itself(mode: str) -> None:
    env, twin = (Falling(noise=0.1, autoreset_mode=mode) for _ in range(2))
    env.lengths[[0, 2]] = 2
    env.reset(seed=0)
    twin.reset(seed=0)
    for _ in range(LENGTH):
        one, other = env.step(ACTIONS)[0], twin.step(ACTIONS)[0]
        np.testing.assert_array_equal(one["place"][1], other["place"][1])


def test_noise_stays_in_environments_that_are_not_reset() -> None:
    env, twin = (Falling(noise=0.1, autoreset_mode="Disabled") for _ in range(2))
    env.lengths[:] = twin.lengths[:] = 10
    env.reset(seed=0)
    twin.reset(seed=0)
    before = env.step(ACTIONS)[0]
    twin.step(ACTIONS)
    after, _ = env.reset(options={"reset_mask": np.array([False, True, False])})
    np.testing.assert_array_equal(after["place"][[0, 2]], before["place"][[0, 2]])
    assert (after["place"][1] != before["place"][1]).any()
    assert after["pair"][1].tolist() == [1, 0, 1]
    np.testing.assert_array_equal(env.step(ACTIONS)[0]["place"][0], twin.step(ACTIONS)[0]["place"][0])


def test_a_mask_of_none_resets_none() -> None:
    env = Falling(autoreset_mode="Disabled")
    first, _ = env.reset(seed=0)
    same, _ = env.reset(options={"reset_mask": np.zeros(COUNT, dtype=bool)})
    np.testing.assert_array_equal(same["place"], first["place"])
    assert env.random.uniform(np.zeros(0, dtype=int), -1.0, 1.0, 3).shape == (0, 3)


@pytest.mark.parametrize(
    ("actions", "says"),
    [
        ([[1, 3], [1, 3]], r"have shape \(2, 2\); they must have shape \(3, 2\)"),
        ([[1, 3], [1, 0], [0, 1]], "number 1 of the action of environment 1 is 0; there are 1 to 3"),
        ([[1.0, 3.0]] * 3, "must be integers, not float64"),
    ],
)
def test_choices_that_are_none_are_refused(actions: list[list[float]], says: str) -> None:
    env = Falling()
    env.reset(seed=0)
    with pytest.raises(ValueError, match=says):
        env.step(actions)


def test_the_pace_of_videos_is_known() -> None:
    assert Falling().metadata["render_fps"] == 120
    assert SingleEnv(Falling).metadata["render_fps"] == 120


class CutOff(Falling):
    """The first environment is cut off in each step that it takes."""

    def truncated(self) -> np.ndarray:
        return np.arange(self.num_envs) == 0


def test_what_is_cut_off_is_truncated_but_not_in_the_step_in_which_it_begins():
    env = CutOff()
    env.reset(seed=0)
    actions = env.action_space.sample()
    cut = [env.step(actions)[3].tolist() for _ in range(3)]
    assert cut == [[True, False, False], [False, False, False], [True, False, False]]
