"""Rollouts on two nodes, one of which is killed while it plays."""

import threading
import time

import numpy as np
import pytest

pytest.importorskip("ray", reason="needs Ray: make cluster")

from tests.cluster.carts import ENVS, EPISODES, SEED, Diary, lean, make_env
from tests.cluster.dice import Dice, assert_same, copy_throws
from tests.cluster.small_ray import add_node
from tests.patience import PATIENCE, until

from carom.cluster import ClusterError, Rollouts
from carom.cluster.player import Player


def kill_in_the_middle(cluster, node, folder, calls):
    """Kill a node when its policy has been asked so often; returns the thread, and what happened."""
    told = {}

    def asked():
        page = folder / node.node_id
        return page.exists() and page.stat().st_size >= calls

    def watch():
        if until(asked):
            told["calls"] = (folder / node.node_id).stat().st_size
            cluster.remove_node(node, allow_graceful=False)

    thread = threading.Thread(target=watch)
    thread.start()
    return thread, told


def test_no_more_nodes_are_used_than_asked_for(cluster):
    with Rollouts(Dice, 2, nodes=1) as rollouts:
        found = rollouts.collect(copy_throws, episodes=30)
    assert len(found.report.episodes_of_nodes) == 1
    assert np.array_equal(found.ids, np.arange(30))


def test_a_node_is_killed_and_nothing_is_lost_or_counted_twice(cluster, tmp_path):
    expected = Player(make_env(ENVS)).play(lean, range(EPISODES), seed=SEED)
    victim = cluster.worker_nodes.copy().pop()
    with Rollouts(make_env, ENVS, seed=SEED) as rollouts:
        # Both have made their environments, so that both play from the beginning.
        until(lambda: len(rollouts.collect(lean, episodes=8 * ENVS, first=0).report.episodes_of_nodes) == 2)
        thread, told = kill_in_the_middle(cluster, victim, tmp_path, calls=30)
        found = rollouts.collect(Diary(tmp_path), episodes=EPISODES, first=0)
        thread.join(PATIENCE)
        assert told["calls"] >= 30
        assert found.ids.tolist() == list(range(EPISODES))
        assert_same(found, expected)
        # It was in the middle of a batch, which somebody else had to play again.
        report = found.report
        # Ray may hold it for alive a while longer, and a new process may be lost there before it has begun.
        assert report.lost_nodes
        assert all(victim.node_id[:8] in lost for lost in report.lost_nodes)
        assert report.repeated == ENVS
        # The next one makes do with the node that is left.
        after = rollouts.collect(lean, steps=200, first=0)
        assert len(after.report.episodes_of_nodes) == 1
        assert_same(after, expected[: len(after)])


def test_when_the_last_node_is_lost_it_is_said(cluster, tmp_path):
    large = add_node(cluster, num_cpus=2)

    page = tmp_path / large.node_id

    def slow(observations):
        with page.open("a") as written:
            written.write("x")
        time.sleep(0.1)
        return copy_throws(observations)

    with Rollouts(Dice, 1, cpus_per_node=2) as rollouts:
        thread, _ = kill_in_the_middle(cluster, large, tmp_path, calls=3)
        with pytest.raises(ClusterError, match=rf"no node is left: .*{large.node_id[:8]}"):
            rollouts.collect(slow, episodes=100)
        thread.join(PATIENCE)
        with pytest.raises(ClusterError, match="no node of the cluster offers 2 processors"):
            rollouts.collect(slow, episodes=1)
