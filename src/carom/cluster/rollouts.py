"""`Rollouts`: collecting episodes on all nodes of a cluster."""

from __future__ import annotations

from collections import Counter
from typing import Any

import ray  # pyright: ignore[reportMissingImports]

from carom.cluster.actors import ActorPool
from carom.cluster.collection import Collection, Part, Reduction, Report
from carom.cluster.episode import Episode
from carom.cluster.nodes import MakeEnv, Reduce, packed
from carom.cluster.policies import Policy
from carom.cluster.progress import CollectionProgress


class Rollouts:
    """Plays episodes on the nodes of Ray's cluster, one vector environment on each.

    Every episode has an id, counted from 0, and the seed `seed + id`, which determines it. So it is the same
    on every node; if a node is lost, the remaining nodes repeat the episodes that it was playing. The
    collected episodes do not depend on the number of nodes, or on which of them die.

    If Ray is not running, `ray.init()` is called: it joins an existing cluster, or starts one on this machine
    only.

    Attributes:
        next_id: The id of the next episode.

    Args:
        make_env: Called on a node with a number of environments; returns a vector environment with so many.
            It must not reset environments itself (`autoreset_mode=AutoresetMode.DISABLED`).
        num_envs_per_node: Number of environments on each node.
        nodes: Maximum number of nodes, or "all" nodes present when a collection begins.
        batch_size: Number of episodes given to a node at a time, and repeated if the node is lost; None for
            its number of environments. Some environments are idle while the last episodes of a batch end;
            the larger the batches, the smaller the idle share.
        max_episode_steps: Number of steps after which episodes are truncated; None: as in the environment.
        cpus_per_node: Number of CPUs that Ray reserves on each node. `make_env` determines how many an
            environment really uses.
        seed: Seed of episode 0.
        attempts: Maximum number of processes that may die while they play the same batch.

    Raises:
        ValueError: A number is too small.
        TypeError: `make_env` refers to something that cannot be sent to other processes.
    """

    def __init__(
        self,
        make_env: MakeEnv,
        num_envs_per_node: int,
        *,
        nodes: int | str = "all",
        batch_size: int | None = None,
        max_episode_steps: int | None = None,
        cpus_per_node: float = 1.0,
        seed: int = 0,
        attempts: int = 3,
    ) -> None:
        if isinstance(nodes, str) and nodes != "all":
            raise ValueError(f"nodes must be a number or 'all', not {nodes!r}")
        _check(num_envs_per_node=num_envs_per_node, attempts=attempts)
        _check(nodes=nodes, batch_size=batch_size, max_episode_steps=max_episode_steps)
        _check(0, seed=seed, cpus_per_node=cpus_per_node)
        self.next_id = 0
        self._seed, self._attempts = seed, attempts
        self._batch_size = batch_size or num_envs_per_node
        sent = packed(make_env, "make_env")
        self._actors = ActorPool(sent, num_envs_per_node, max_episode_steps, nodes, cpus_per_node)

    def collect(
        self,
        policy: Policy,
        *,
        episodes: int | None = None,
        steps: int | None = None,
        first: int | None = None,
        keep_steps: bool = True,
    ) -> Collection:
        """Play episodes.

        Args:
            policy: Called with observations (num_envs, ...), returns actions (num_envs, ...). A policy that
                draws random numbers or has a memory needs `begin_episodes`; see `PolicyWithMemory`.
            episodes: Number of episodes.
            steps: Minimum total number of steps, instead of `episodes`; the episode that reaches it is the
                last one.
            first: Id of the first episode. Collections with the same `first` play the same episodes, to
                compare policies. None continues after the last collection.
            keep_steps: Whether to keep observations and actions, besides the rewards.

        Returns:
            The episodes, in the order of their ids.

        Raises:
            ValueError: Both or neither of `episodes` and `steps` are given, or a number is too small.
            TypeError: The policy refers to something that cannot be sent to other processes.
            EpisodeError: The policy or the environment failed; its exception is the cause of this one.
            ClusterError: No node is left, an environment cannot be made, or processes die repeatedly while
                they play the same episodes.
        """
        progress, players = self._play(policy, None, episodes, steps, first, keep_steps)
        found = tuple(entry for entry in progress.counted if isinstance(entry, Episode))
        self.next_id = progress.first + len(found)
        return Collection(found, self._report(progress, [players[episode.id] for episode in found]))

    def reduce(
        self,
        policy: Policy,
        function: Reduce,
        *,
        episodes: int | None = None,
        steps: int | None = None,
        first: int | None = None,
        keep_steps: bool = True,
    ) -> Reduction:
        """Play episodes, and let the nodes make something small of them, such as a sum or a gradient.

        Only this is sent, and not the episodes. The batches are the same for any number of nodes, and so are
        the values and their order.

        Args:
            policy: As for `collect`.
            function: Called on the nodes with the list of the episodes of a batch, in the order of their ids;
                what it returns is sent, so it must be possible to pickle it.
            episodes: Number of episodes.
            steps: Minimum total number of steps, instead of `episodes`; the batch that reaches it is the last
                one.
            first: Id of the first episode; None continues after the last collection.
            keep_steps: Whether the episodes have observations and actions, besides the rewards.

        Returns:
            The values of the batches, in the order of the episodes.

        Raises:
            ValueError: Both or neither of `episodes` and `steps` are given, or a number is too small.
            TypeError: The policy or the function refers to something that cannot be sent.
            EpisodeError: The policy, the environment or the function failed; its exception is the cause.
            ClusterError: As for `collect`.
        """
        progress, players = self._play(policy, function, episodes, steps, first, keep_steps)
        parts = tuple(entry for entry in progress.counted if isinstance(entry, Part))
        self.next_id = parts[-1].ids.stop
        played = [players[number] for part in parts for number in part.ids]
        return Reduction(parts, self._report(progress, played))

    def _play(
        self,
        policy: Policy,
        function: Reduce | None,
        episodes: int | None,
        steps: int | None,
        first: int | None,
        keep_steps: bool,
    ) -> tuple[CollectionProgress, dict[int, str]]:
        """Play; returns the books, and the node that played each episode, counted or not."""
        if (episodes is None) == (steps is None):
            raise ValueError("give either episodes or steps")
        _check(episodes=episodes, steps=steps)
        _check(0, first=first)
        first = self.next_id if first is None else first
        if not ray.is_initialized():
            ray.init()
        progress = CollectionProgress(
            first, self._batch_size, episodes=episodes, steps=steps, attempts=self._attempts
        )
        players: dict[int, str] = {}
        self._actors.begin()
        # They are sent once for a collection, and not with each batch.
        sent = ray.put(packed(policy, "the policy"))
        reduction = None if function is None else ray.put(packed(function, "the reduction"))
        while not progress.is_full:
            self._hand_out(progress, sent, reduction, keep_steps)
            back = self._actors.wait()
            if back is None:
                continue
            if back.outcome is None:
                progress.lose(back.batch, back.lost)
            elif progress.finish(back.batch, back.outcome):
                players.update(dict.fromkeys(back.batch, str(back.node)))
        return progress, players

    def _report(self, progress: CollectionProgress, played: list[str]) -> Report:
        return Report(dict(Counter(played)), list(self._actors.lost), progress.repeated)

    def _hand_out(self, progress: CollectionProgress, policy: Any, reduction: Any, keep_steps: bool) -> None:
        for member in list(self._actors.idle):
            batch = progress.take()
            if batch is None:
                return
            self._actors.give(member, batch, policy, reduction, self._seed, keep_steps)

    def close(self) -> None:
        """End the processes on the nodes; Ray keeps running."""
        self._actors.close()

    def __enter__(self) -> Rollouts:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _check(least: int = 1, **numbers: Any) -> None:
    """Raise `ValueError` for numbers less than `least`; None and strings are ignored."""
    for name, number in numbers.items():
        if not isinstance(number, (str, type(None))) and number < least:
            raise ValueError(f"{name} must be at least {least}, not {number}")
