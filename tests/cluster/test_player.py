"""An episode is decided by its seed, whoever plays it, beside whom, and after what."""

import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv

pytest.importorskip("ray", reason="needs Ray: make cluster")

from tests.cluster.dice import Dice, Guess, assert_same, copy_throws

from carom.cluster import Collection, EpisodeError, Report
from carom.cluster.player import Player


def test_an_episode_is_what_its_environment_gave():
    (episode,) = Player(Dice(1)).play(copy_throws, range(4, 5), seed=100)
    throws = np.random.default_rng(104).uniform(size=3 + 104 % 7)
    assert (episode.id, episode.seed, episode.length) == (4, 104, len(throws))
    assert (episode.observations[:, 0] == 104).all()
    assert (episode.observations[1:, 1] == throws).all()
    assert (episode.actions[:, 0] == episode.observations[:-1, 1]).all()
    assert (episode.rewards == throws + episode.actions[:, 0]).all()
    assert episode.total_reward == episode.rewards.sum()
    assert (episode.terminated, episode.truncated) == (True, False)
    # `_left` says that there is nothing to tell at the end.
    assert episode.info == {"inner": {"seed": 104}}


@pytest.mark.parametrize("count", [1, 2, 5, 16])
@pytest.mark.parametrize("ids", [range(11), range(3, 9), range(7, 8)])
def test_episodes_are_the_same_in_any_seat_and_in_any_company(count, ids):
    alone = Player(Dice(1))
    expected = [alone.play(Guess(1), range(k, k + 1), seed=5)[0] for k in ids]
    player = Player(Dice(count))
    player.play(Guess(count), range(50, 53), seed=5)
    assert_same(player.play(Guess(count), ids, seed=5), expected)


def test_episodes_are_cut_off_after_so_many_steps():
    episodes = Player(Dice(3), max_episode_steps=5).play(copy_throws, range(14), seed=0)
    for episode in episodes:
        whole = 3 + episode.seed % 7
        assert episode.length == min(whole, 5)
        assert (episode.terminated, episode.truncated) == (whole <= 5, whole >= 5)
        assert episode.observations.shape == (episode.length + 1, 2)


def test_long_episodes_are_kept_whole():
    class Endless(Dice):
        def step(self, actions):
            self._left[:] = 100
            return super().step(actions)

    (episode,) = Player(Endless(1), max_episode_steps=1000).play(copy_throws, range(1), seed=0)
    throws = np.random.default_rng(0).uniform(size=1000)
    assert (episode.observations[1:, 1] == throws).all()
    assert (episode.rewards[1:] == throws[1:] + throws[:-1]).all()


def test_rewards_alone_can_be_kept():
    player = Player(Dice(2))
    whole, short = (player.play(copy_throws, range(5), 0, keep_steps=keep) for keep in (True, False))
    for one, other in zip(whole, short, strict=True):
        assert (one.rewards == other.rewards).all()
        assert other.observations.shape == (0, 2)
        assert other.actions.shape == (0, 1)
    with pytest.raises(ValueError, match="keep_steps=True"):
        Collection(tuple(short), Report()).steps()


def test_all_steps_as_arrays():
    episodes = Player(Dice(2)).play(copy_throws, range(3), seed=0)
    steps = Collection(tuple(episodes), Report()).steps()
    assert steps.ids.tolist() == [0] * 3 + [1] * 4 + [2] * 5
    assert np.flatnonzero(steps.terminations).tolist() == [2, 6, 11]
    assert not steps.truncations.any()
    assert (steps.next_observations[:2] == steps.observations[1:3]).all()
    assert (steps.actions[:, 0] == steps.observations[:, 1]).all()
    assert len(steps.rewards) == 12


def test_what_fails_is_named_with_its_episodes():
    def fails_late(observations):
        if observations[0, 1] > 0.0:
            raise ZeroDivisionError("the policy is bad")
        return observations[:, 1:]

    with pytest.raises(
        EpisodeError, match=r"the policy failed in episodes 2 to 4 \(seeds 12 to 14\): ZeroDiv"
    ) as failure:
        Player(Dice(4)).play(fails_late, range(2, 5), seed=10)
    assert failure.value.ids == (2, 3, 4)
    assert failure.value.seeds == (12, 13, 14)
    assert isinstance(failure.value.__cause__, ZeroDivisionError)
    with pytest.raises(
        EpisodeError, match=r"the policy failed in episode 0 \(seed 0\): .*shape \(1, 2\).*\(1, 1\)"
    ):
        Player(Dice(1)).play(lambda observations: observations, range(1), seed=0)


def test_an_environment_that_begins_episodes_on_its_own_is_refused():
    with pytest.raises(ValueError, match=r"autoreset_mode=AutoresetMode\.DISABLED"):
        Player(Dice(1, AutoresetMode.NEXT_STEP))


def test_gymnasiums_own_vector_environments_will_do():
    import gymnasium

    def make(count):
        one = [lambda: gymnasium.make("CartPole-v1", max_episode_steps=20)] * count
        return SyncVectorEnv(one, autoreset_mode=AutoresetMode.DISABLED)

    def lean(observations):
        return (observations[:, 2] > 0).astype(int)

    expected = Player(make(1)).play(lean, range(5), seed=3)
    assert_same(Player(make(3)).play(lean, range(5), seed=3), expected)
    assert max(episode.length for episode in expected) == 20
