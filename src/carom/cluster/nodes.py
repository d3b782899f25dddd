"""The nodes of the Ray cluster, and the actor that plays episodes on a node."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import ray  # pyright: ignore[reportMissingImports]
import ray.cloudpickle as cloudpickle  # pyright: ignore[reportMissingImports]
from gymnasium.vector import VectorEnv
from ray.util.scheduling_strategies import (  # pyright: ignore[reportMissingImports]
    NodeAffinitySchedulingStrategy,
)

from carom.cluster.collection import Part
from carom.cluster.episode import Episode
from carom.cluster.errors import EpisodeError
from carom.cluster.player import Player
from carom.cluster.policies import Policy

MakeEnv = Callable[[int], VectorEnv]
"""Makes a vector environment with the given number of environments."""
Reduce = Callable[[list[Episode]], Any]
"""Makes something small of the episodes of a batch."""


def packed(value: Any, name: str) -> bytes:
    """An object as bytes, to be sent. If Ray itself pickled it, its arrays would be read-only on arrival.

    Raises:
        TypeError: The object cannot be pickled; the message calls it `name`.
    """
    try:
        return cloudpickle.dumps(value)  # type: ignore[reportPrivateImportUsage]
    except Exception as error:
        raise TypeError(
            f"{name} cannot be sent to other processes; something it refers to cannot be pickled: {error}"
        ) from error


def unpacked(sent: bytes) -> Any:
    """The object that `packed` has converted to bytes."""
    return cloudpickle.loads(sent)


@dataclass(frozen=True)
class Failure:
    """An exception that is sent from another process.

    Attributes:
        error: The exception; None if it cannot be pickled.
        text: Its traceback in the process that raised it.
    """

    error: Exception | None
    text: str

    @classmethod
    def of(cls, error: BaseException) -> Failure:
        """The failure that describes an exception."""
        text = "".join(traceback.format_exception(error))
        try:
            copy = unpacked(packed(error, "the exception"))
        except Exception:
            copy = None
        return cls(copy if isinstance(copy, Exception) else None, text)

    def cause(self) -> Exception:
        """The exception, to be used as a cause; its own cause is the traceback of the other process."""
        elsewhere = RemoteError(self.text)
        if self.error is None:
            return elsewhere
        self.error.__cause__ = elsewhere
        return self.error


class RemoteError(Exception):
    """The traceback of an exception that was raised in another process."""

    def __str__(self) -> str:
        return f"in a process of the cluster:\n\n{self.args[0]}"


@dataclass(frozen=True)
class Failed:
    """A batch that failed: the arguments of `EpisodeError`, and the exception that caused it."""

    what: str
    ids: tuple[int, ...]
    seeds: tuple[int, ...]
    reason: str
    failure: Failure

    def error(self) -> EpisodeError:
        """The exception to raise in the process of the rollout."""
        error = EpisodeError(self.what, self.ids, self.seeds, self.reason)
        error.__cause__ = self.failure.cause()
        return error


class NodePlayer:
    """The actor that plays episodes. It keeps its environment, because making one may take long."""

    def __init__(self) -> None:
        self._player: Player | None = None

    def prepare(self, make_env: bytes, num_envs: int, max_episode_steps: int | None) -> Failure | None:
        """Make the environment with the pickled function `make_env`; return the failure if it raises."""
        try:
            env = unpacked(make_env)(num_envs)
            if env.num_envs != num_envs:
                raise ValueError(f"make_env({num_envs}) made {env.num_envs} environments")
            self._player = Player(env, max_episode_steps)
        except Exception as error:
            return Failure.of(error)
        return None

    def play(
        self, policy: bytes, reduction: bytes | None, ids: range, seed: int, keep_steps: bool
    ) -> list[Episode] | bytes | Failed:
        """Play episodes with a pickled policy; see `Player.play`.

        Returns:
            The episodes; or, with a pickled function of a list of episodes, a pickled `Part`.
        """
        assert self._player is not None
        fresh: Policy = unpacked(policy)
        try:
            episodes = self._player.play(fresh, ids, seed, keep_steps=keep_steps)
            return episodes if reduction is None else _reduced(reduction, episodes, ids, seed)
        except EpisodeError as error:
            failure = Failure.of(error.__cause__ or error)
            return Failed(error.what, error.ids, error.seeds, error.reason, failure)


def _reduced(reduction: bytes, episodes: list[Episode], ids: range, seed: int) -> bytes:
    """The `Part` that a pickled function makes of a batch, pickled.

    Raises:
        EpisodeError: The function cannot be unpickled or failed, or its result cannot be pickled.
    """
    try:
        function: Reduce = unpacked(reduction)
        length = sum(episode.length for episode in episodes)
        return packed(Part(ids, function(episodes), length), "the result of the reduction")
    except Exception as error:
        seeds = [seed + number for number in ids]
        raise EpisodeError("the reduction", ids, seeds, f"{type(error).__name__}: {error}") from error


@dataclass(frozen=True)
class Node:
    """A live node of the cluster: Ray's id of the node, and its network address."""

    id: str
    address: str

    def __str__(self) -> str:
        return f"{self.address} (node {self.id[:8]})"

    def start(self, cpus: float) -> Any:
        """Start an actor on this node only; return its handle."""
        # No restarts by Ray: a restarted actor would have no environment, and would repeat a lost batch.
        options = {"num_cpus": cpus, "max_restarts": 0, "max_task_retries": 0}
        here = NodeAffinitySchedulingStrategy(self.id, soft=False)
        actor = ray.remote(NodePlayer).options(scheduling_strategy=here, **options)
        return actor.remote()


def living_nodes(cpus: float) -> list[Node]:
    """The live nodes with at least so many CPUs, free or in use, sorted by id."""
    found = [
        Node(node["NodeID"], node["NodeManagerAddress"])
        for node in ray.nodes()
        if node["Alive"] and node["Resources"].get("CPU", 0.0) >= cpus
    ]
    return sorted(found, key=lambda node: node.id)
