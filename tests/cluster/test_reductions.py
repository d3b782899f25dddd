"""Reductions on the nodes: only what is made of the episodes is sent."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("ray", reason="needs Ray: make cluster")

import ray  # pyright: ignore[reportMissingImports]
from tests.cluster.dice import Dice, Guess, copy_throws, summed

from carom.cluster import Episode, EpisodeError, Rollouts
from carom.cluster.player import Player

pytestmark = pytest.mark.usefixtures("laptop")


@pytest.fixture(scope="module")
def rollouts(laptop):
    with Rollouts(Dice, 3, batch_size=4, seed=20) as made:
        yield made


def alone(ids: range) -> list[Episode]:
    return Player(Dice(3)).play(copy_throws, ids, seed=20)


def test_each_batch_becomes_one_value_in_order(rollouts):
    found = rollouts.reduce(copy_throws, summed, episodes=10, first=0)
    assert [value["ids"] for value in found] == [[0, 1, 2, 3], [4, 5, 6, 7], [8, 9]]
    for value, ids in zip(found, (range(4), range(4, 8), range(8, 10)), strict=True):
        assert (value["observations"] == summed(alone(ids))["observations"]).all()
        assert value["observations"].flags.writeable
    assert found.episode_count == 10
    assert found.step_count == sum(episode.length for episode in alone(range(10)))
    assert sum(found.report.episodes_of_nodes.values()) == 10
    assert rollouts.next_id == 10
    assert found[1]["ids"] == [4, 5, 6, 7]
    assert len(found[:2]) == 2


def test_whole_batches_are_played_until_there_are_so_many_steps(rollouts):
    found = rollouts.reduce(copy_throws, len, steps=30, first=2)
    lengths = [part.length for part in found.parts]
    assert sum(lengths) >= 30 > sum(lengths[:-1])
    assert found.values == (4,) * len(lengths)
    assert rollouts.next_id == 2 + found.episode_count
    assert rollouts.collect(copy_throws, episodes=1)[0].id == 2 + found.episode_count


def test_a_reduction_that_fails_is_named_with_its_episodes(rollouts):
    def fails(episodes: list[Episode]) -> float:
        return 1.0 / (episodes[0].id - 4)

    with pytest.raises(EpisodeError, match=r"the reduction failed in episodes 4 to 7 .*ZeroDivision") as told:
        rollouts.reduce(copy_throws, fails, episodes=12, first=0)
    assert told.value.seeds == (24, 25, 26, 27)
    assert isinstance(told.value.__cause__, ZeroDivisionError)
    with pytest.raises(EpisodeError, match="the result of the reduction cannot be sent"):
        rollouts.reduce(copy_throws, lambda episodes: (each for each in episodes), episodes=4, first=0)
    assert rollouts.reduce(copy_throws, len, episodes=4, first=0).values == (4,)


def test_the_policy_is_sent_once_for_a_collection(rollouts, monkeypatch):
    put, sent = ray.put, []
    monkeypatch.setattr(ray, "put", lambda value: sent.append(len(value)) or put(value))
    policy: Any = Guess(3)
    policy.weights = np.zeros(1_000_000, np.uint8)
    rollouts.collect(policy, episodes=20)
    assert len(sent) == 1
    assert sent[0] > 1_000_000
    rollouts.reduce(policy, len, episodes=20)
    assert [size > 1_000_000 for size in sent] == [True, True, False]


def test_losing_a_node_changes_no_value(cluster):
    from tests.cluster.small_ray import add_node

    doomed = add_node(cluster)
    with Rollouts(Dice, 3, batch_size=4, seed=20) as rollouts:
        first = rollouts.reduce(copy_throws, summed, episodes=40)
        cluster.remove_node(doomed)
        again = rollouts.reduce(copy_throws, summed, episodes=40, first=0)
    for one, other in zip(first, again, strict=True):
        assert one["ids"] == other["ids"]
        assert (one["observations"] == other["observations"]).all()
