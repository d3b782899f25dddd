"""Rollouts on one machine."""

import os
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

pytest.importorskip("ray", reason="needs Ray: make cluster")

from tests.cluster.dice import Dice, Guess, Stubborn, assert_same, copy_throws

from carom.cluster import ClusterError, EpisodeError, Rollouts
from carom.cluster.player import Player

pytestmark = pytest.mark.usefixtures("laptop")


@pytest.fixture(scope="module")
def rollouts(laptop):
    with Rollouts(Dice, 3, batch_size=4, seed=20) as made:
        yield made


def alone(policy, ids):
    return Player(Dice(3)).play(policy, ids, seed=20)


def test_so_many_episodes_are_collected_and_the_next_collection_goes_on(rollouts):
    found = rollouts.collect(copy_throws, episodes=10, first=0)
    assert_same(found, alone(copy_throws, range(10)))
    assert rollouts.next_id == 10
    assert_same(rollouts.collect(copy_throws, episodes=3), alone(copy_throws, range(10, 13)))
    (share,) = found.report.episodes_of_nodes.values()
    assert (share, found.report.lost_nodes, found.report.repeated) == (10, [], 0)
    assert found[3].rewards.flags.writeable
    assert found.step_count == found.lengths.sum() == len(found.steps().rewards)
    assert found.returns[2] == found[2].total_reward


def test_so_many_steps_are_collected(rollouts):
    found = rollouts.collect(copy_throws, steps=50, first=2)
    assert found.step_count >= 50 > found.lengths[:-1].sum()
    assert_same(found, alone(copy_throws, range(2, 2 + len(found))))
    assert rollouts.next_id == 2 + len(found)


def test_policies_that_draw_numbers_of_their_own(rollouts):
    found = rollouts.collect(Guess(3), episodes=9, first=1)
    assert_same(found, alone(Guess(3), range(1, 10)))


def test_a_policy_that_fails_is_named_with_its_episodes_and_the_next_collection_is_well(rollouts):
    def fails(observations):
        if (observations[:, 0] == 20 + 6).any():
            raise ZeroDivisionError("the policy is bad")
        return copy_throws(observations)

    with pytest.raises(
        EpisodeError, match=r"the policy failed in episodes 4 to 6 \(seeds 24 to 26\)"
    ) as failure:
        rollouts.collect(fails, episodes=100, first=0)
    assert isinstance(failure.value.__cause__, ZeroDivisionError)
    assert "in fails" in str(failure.value.__cause__.__cause__)
    assert_same(rollouts.collect(copy_throws, episodes=2, first=0), alone(copy_throws, range(2)))


def test_an_exception_that_cannot_be_sent_is_shown_as_text(rollouts):
    class HoldsAFile(Exception):
        def __init__(self):
            super().__init__("cannot be sent")
            self.file = open(os.devnull)  # noqa: SIM115

    def fails(observations):
        raise HoldsAFile

    with pytest.raises(EpisodeError, match="HoldsAFile: cannot be sent") as failure:
        rollouts.collect(fails, episodes=1)
    assert "in fails" in str(failure.value.__cause__)


def test_a_process_that_dies_is_replaced_and_its_episodes_are_played_again(rollouts, tmp_path):
    flag = tmp_path / "died"

    def dies_once(observations):
        if (observations[:, 0] == 20 + 5).any() and not flag.exists():
            flag.touch()
            os._exit(1)
        return copy_throws(observations)

    found = rollouts.collect(dies_once, episodes=12, first=0)
    assert_same(found, alone(copy_throws, range(12)))
    assert found.report.repeated == 4
    assert len(found.report.lost_nodes) == 1


def test_episodes_of_which_processes_die_are_named(rollouts):
    def dies(observations):
        if (observations[:, 0] == 20 + 5).any():
            os._exit(1)
        return copy_throws(observations)

    with pytest.raises(ClusterError, match="3 processes died while they played episodes 4 to 7"):
        rollouts.collect(dies, episodes=12, first=0)


def test_an_environment_that_cannot_be_made_is_explained():
    def broken(count):
        raise OSError("no robot here")

    def on_its_own(count):
        return Dice(count, AutoresetMode.NEXT_STEP)

    def fewer(count):
        return Dice(count - 1)

    for make_env, reason in (
        (broken, "OSError: no robot here"),
        (on_its_own, "ValueError: .*AutoresetMode.DISABLED"),
        (fewer, r"make_env\(2\) made 1"),
    ):
        with (
            Rollouts(make_env, 2, cpus_per_node=0) as rollouts,
            pytest.raises(ClusterError, match=f"no environment could be made on .*{reason}"),
        ):
            rollouts.collect(copy_throws, episodes=1)


def test_what_cannot_be_unpacked_on_the_node_is_explained(rollouts):
    with pytest.raises(ClusterError, match=r"the policy cannot be sent to .*: not here"):
        rollouts.collect(Stubborn(), episodes=1)
    assert len(rollouts.collect(copy_throws, episodes=1)) == 1


def test_what_cannot_be_packed_is_explained(rollouts):
    lock = threading.Lock()
    with pytest.raises(TypeError, match=r"the policy cannot be sent to other processes.*lock"):
        rollouts.collect(lambda observations: lock, episodes=1)
    with pytest.raises(TypeError, match="make_env cannot be sent to other processes"):
        Rollouts(lambda count: lock, 1)  # type: ignore[arg-type]


def test_bad_numbers_are_refused(rollouts):
    for arguments in ({}, {"episodes": 1, "steps": 1}):
        with pytest.raises(ValueError, match="either episodes or steps"):
            rollouts.collect(copy_throws, **arguments)
    for name, number in (("episodes", 0), ("steps", -1)):
        with pytest.raises(ValueError, match=f"{name} must be at least 1, not {number}"):
            rollouts.collect(copy_throws, **{name: number})
    with pytest.raises(ValueError, match="first must be at least 0"):
        rollouts.collect(copy_throws, episodes=1, first=-1)
    for name in ("num_envs_per_node", "nodes", "batch_size", "max_episode_steps", "attempts"):
        with pytest.raises(ValueError, match=f"{name} must be at least 1, not 0"):
            Rollouts(Dice, **{"num_envs_per_node": 1, name: 0})
    with pytest.raises(ValueError, match="nodes must be a number or 'all', not 'some'"):
        Rollouts(Dice, 1, nodes="some")
    with (
        Rollouts(Dice, 1, cpus_per_node=64) as too_many,
        pytest.raises(ClusterError, match="no node of the cluster offers 64 processors"),
    ):
        too_many.collect(copy_throws, episodes=1)


def test_closing_ends_the_processes(tmp_path):
    class Writes(Dice):
        def __init__(self, count):
            super().__init__(count)
            (tmp_path / "process").write_text(str(os.getpid()))

    with Rollouts(Writes, 2, cpus_per_node=0) as rollouts:
        rollouts.collect(copy_throws, episodes=1)
        process = Path("/proc") / (tmp_path / "process").read_text()
    give_up = time.monotonic() + 60.0
    while process.exists() and time.monotonic() < give_up:
        time.sleep(0.05)
    assert not process.exists()
    assert np.isfinite(rollouts.next_id)
