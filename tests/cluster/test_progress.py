"""Whatever is lost, late or comes twice: each episode counts once, and in order."""

import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("ray", reason="needs Ray: make cluster")

from carom.cluster import ClusterError, Episode, EpisodeError
from carom.cluster.progress import CollectionProgress

NOTHING = np.zeros((0, 1))


def length_of(number: int) -> int:
    return 1 + number % 4


def played(ids: range) -> list[Episode]:
    return [
        Episode(number, number, NOTHING, NOTHING, np.ones(length_of(number)), True, False, {})
        for number in ids
    ]


@given(
    st.randoms(use_true_random=False),
    st.integers(0, 20),
    st.integers(1, 7),
    st.integers(1, 40),
    st.booleans(),
    st.integers(1, 5),
)
def test_each_episode_counts_once(chance: random.Random, first, size, amount, by_steps, nodes):
    wanted = {"episodes": None, "steps": amount} if by_steps else {"episodes": amount, "steps": None}
    progress = CollectionProgress(first, size, **wanted, attempts=10**6)
    out: list[range] = []
    late: list[range] = []
    back: set[int] = set()
    while not progress.is_full:
        while len(out) < nodes and (batch := progress.take()) is not None:
            out.append(batch)
        batch = out.pop(chance.randrange(len(out)))
        event = chance.choice(["finished", "lost", "believed lost", "twice"])
        if "lost" in event:
            progress.lose(batch, "")
            late += [batch] if event == "believed lost" else []
        else:
            assert progress.finish(batch, played(batch)) == (batch.start not in back)
            back.add(batch.start)
            late += [batch] if event == "twice" else []
        if late and chance.random() < 0.5:
            # What was given up, or has been counted, comes in after all.
            again = late.pop()
            assert progress.finish(again, played(again)) == (again.start not in back)
            back.add(again.start)
    ids = [episode.id for episode in progress.counted if isinstance(episode, Episode)]
    assert ids == list(range(first, first + len(ids)))
    if by_steps:
        lengths = [length_of(number) for number in ids]
        assert sum(lengths) >= amount > sum(lengths[:-1])
    else:
        assert len(ids) == amount


def test_a_batch_that_kills_those_who_play_it_is_given_up():
    progress = CollectionProgress(0, 4, episodes=8, steps=None, attempts=3)
    for _ in range(2):
        batch = progress.take()
        assert batch == range(4)
        progress.lose(range(4), "out of memory")
    assert progress.repeated == 4
    progress.take()
    with pytest.raises(ClusterError, match=r"3 processes died while they played episodes 0 to 3.*of memory"):
        progress.lose(range(4), "out of memory")


def test_a_failure_counts_if_the_episodes_before_it_were_not_enough():
    def failure() -> EpisodeError:
        return EpisodeError("the policy", [4, 5], [4, 5], "it is bad")

    enough = CollectionProgress(0, 2, episodes=None, steps=6, attempts=3)
    batches = [enough.take() for _ in range(3)]
    assert batches == [range(2), range(2, 4), range(4, 6)]
    enough.finish(range(4, 6), failure())
    assert enough.take() is None
    enough.finish(range(2), played(range(2)))
    enough.finish(range(2, 4), played(range(2, 4)))
    assert enough.is_full

    missing = CollectionProgress(0, 2, episodes=6, steps=None, attempts=3)
    for _ in range(3):
        missing.take()
    missing.finish(range(4, 6), failure())
    missing.finish(range(2), played(range(2)))
    missing.lose(range(2, 4), "")
    assert missing.take() == range(2, 4)
    with pytest.raises(EpisodeError, match="episodes 4, 5"):
        missing.finish(range(2, 4), played(range(2, 4)))
