"""The nodes of Ray's cluster, and an actor on each that plays episodes."""

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

from carom.cluster.episode import Episode
from carom.cluster.errors import EpisodeError
from carom.cluster.player import Player
from carom.cluster.policies import Policy

MakeEnv = Callable[[int], VectorEnv]
"""Makes a vector environment of as many as it is told."""


def packed(value: Any, name: str) -> bytes:
    """Something to be sent. Packed by Ray itself it would arrive with arrays that must not be written.

    Raises:
        TypeError: It cannot be sent; the message calls it `name`.
    """
    try:
        return cloudpickle.dumps(value)  # type: ignore[reportPrivateImportUsage]
    except Exception as error:
        raise TypeError(
            f"{name} cannot be sent to other processes; something it refers to cannot be pickled: {error}"
        ) from error


def unpacked(sent: bytes) -> Any:
    """Unpacks an object that was sent."""
    return cloudpickle.loads(sent)


@dataclass(frozen=True)
class Failure:
    """An exception on its way from another process.

    Attributes:
        error: The exception; None if it cannot be sent.
        text: How it would have been printed where it was raised.
    """

    error: Exception | None
    text: str

    @classmethod
    def of(cls, error: BaseException) -> Failure:
        """What can be sent of an exception."""
        text = "".join(traceback.format_exception(error))
        try:
            copy = unpacked(packed(error, "the exception"))
        except Exception:
            copy = None
        return cls(copy if isinstance(copy, Exception) else None, text)

    def cause(self) -> Exception:
        """An exception to raise others from, which shows where it came from."""
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
    """A batch that failed: what `EpisodeError` says, and why."""

    what: str
    ids: tuple[int, ...]
    seeds: tuple[int, ...]
    reason: str
    failure: Failure

    def error(self) -> EpisodeError:
        """The exception to be raised here."""
        error = EpisodeError(self.what, self.ids, self.seeds, self.reason)
        error.__cause__ = self.failure.cause()
        return error


class NodePlayer:
    """The actor. It keeps its environment, which may take long to make, for as long as it lives."""

    def __init__(self) -> None:
        self._player: Player | None = None

    def prepare(self, make_env: bytes, num_envs: int, max_episode_steps: int | None) -> Failure | None:
        """Makes the environment from packed arguments; returns what went wrong."""
        try:
            env = unpacked(make_env)(num_envs)
            if env.num_envs != num_envs:
                raise ValueError(f"make_env({num_envs}) made {env.num_envs} environments")
            self._player = Player(env, max_episode_steps)
        except Exception as error:
            return Failure.of(error)
        return None

    def play(self, policy: bytes, ids: range, seed: int, keep_steps: bool) -> list[Episode] | Failed:
        """Play episodes, with a policy that is packed; see `Player.play`."""
        assert self._player is not None
        fresh: Policy = unpacked(policy)
        try:
            return self._player.play(fresh, ids, seed, keep_steps=keep_steps)
        except EpisodeError as error:
            failure = Failure.of(error.__cause__ or error)
            return Failed(error.what, error.ids, error.seeds, error.reason, failure)


@dataclass(frozen=True)
class Node:
    """A machine of the cluster that is alive.

    Attributes:
        id: Ray's name for it.
        address: Where it is.
    """

    id: str
    address: str

    def __str__(self) -> str:
        return f"{self.address} (node {self.id[:8]})"

    def start(self, cpus: float) -> Any:
        """Start an actor there, and nowhere else; returns its handle."""
        # Ray does not restart it: it would have no environment, and play a lost batch twice.
        options = {"num_cpus": cpus, "max_restarts": 0, "max_task_retries": 0}
        here = NodeAffinitySchedulingStrategy(self.id, soft=False)
        actor = ray.remote(NodePlayer).options(scheduling_strategy=here, **options)
        return actor.remote()


def living_nodes(cpus: float) -> list[Node]:
    """The nodes that offer so many processors, whether taken or not, in an order that stays."""
    found = [
        Node(node["NodeID"], node["NodeManagerAddress"])
        for node in ray.nodes()
        if node["Alive"] and node["Resources"].get("CPU", 0.0) >= cpus
    ]
    return sorted(found, key=lambda node: node.id)
