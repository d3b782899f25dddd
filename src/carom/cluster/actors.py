"""The Ray actors of a rollout, and which of them are idle, busy or lost."""

from __future__ import annotations

import logging
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import ray  # pyright: ignore[reportMissingImports]
from ray.exceptions import RayError, RayTaskError  # pyright: ignore[reportMissingImports]

from carom.cluster.episode import Episode
from carom.cluster.errors import ClusterError
from carom.cluster.nodes import Failed, Failure, Node, living_nodes, unpacked
from carom.cluster.progress import Outcome

_log = logging.getLogger("carom.cluster")
_ALL = "all"
_MAX_LOSSES = 3
"""Number of processes that may die on a node during a collection; after that the node is not used."""
_PATIENCE = 30.0
"""Time without a result after which a warning says for which nodes the rollout is waiting [s]."""


@dataclass(eq=False)
class Member:
    """An actor on a node, by Ray's handle; it is ready when its environment has been made."""

    node: Node
    actor: Any
    is_ready: bool = False


@dataclass(frozen=True)
class Returned:
    """The result of a batch; `outcome` is None if its actor was lost, and `lost` is then the reason."""

    node: Node
    batch: range
    outcome: Outcome | None
    lost: str = ""


@dataclass
class ActorPool:
    """The actors of a rollout, at most one on each node.

    `make_env`, pickled, makes vector environments of `num_envs`; `nodes` is the maximum number, or "all", and
    `cpus` the number of CPUs that Ray reserves for each actor.
    """

    make_env: bytes
    num_envs: int
    max_episode_steps: int | None
    nodes: int | str
    cpus: float
    members: list[Member] = field(default_factory=list)
    idle: list[Member] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)
    _jobs: dict[Any, tuple[Member, range | None]] = field(default_factory=dict)
    _losses: Counter[str] = field(default_factory=Counter)

    def begin(self) -> None:
        """Prepare for a new collection: reset the counts of losses, and update the list of nodes.

        Raises:
            ClusterError: No node has enough CPUs.
        """
        self.lost.clear()
        self._losses.clear()
        # Results of batches of the last collection are ignored; their actors first finish these batches.
        self._jobs = {ref: job for ref, job in self._jobs.items() if job[1] is None}
        self.idle = [member for member in self.members if member.is_ready]
        living = {node.id for node in living_nodes(self.cpus)}
        for member in [member for member in self.members if member.node.id not in living]:
            self._dismiss(member)
        self.fill_up()
        if not self.members:
            raise ClusterError(f"no node of the cluster offers {self.cpus:g} processors")

    def fill_up(self) -> None:
        """Start actors on nodes that have none, up to the maximum number of nodes."""
        taken = {member.node.id for member in self.members}
        for node in living_nodes(self.cpus):
            is_enough = self.nodes != _ALL and len(self.members) >= int(self.nodes)
            if not is_enough and node.id not in taken and self._losses[node.id] < _MAX_LOSSES:
                member = Member(node, node.start(self.cpus))
                self.members.append(member)
                prepared = member.actor.prepare.remote(self.make_env, self.num_envs, self.max_episode_steps)
                self._jobs[prepared] = (member, None)

    def give(
        self, member: Member, batch: range, policy: Any, reduction: Any, seed: int, keep_steps: bool
    ) -> None:
        """Let an idle actor play a batch.

        `policy` and `reduction` are Ray's references to them, pickled; `reduction` may be None. Ray brings
        what they refer to to each node once, from any node that has it.
        """
        self.idle.remove(member)
        self._jobs[member.actor.play.remote(policy, reduction, batch, seed, keep_steps)] = (member, batch)

    def wait(self) -> Returned | None:
        """Wait for the next event; if it is the end of a batch, return its result.

        Raises:
            ClusterError: No node is left, or a node cannot make an environment or unpickle the policy.
        """
        if not self._jobs:
            raise ClusterError("no node is left: " + "; ".join(self.lost))
        done = self._next_done()
        member, batch = self._jobs.pop(done)
        try:
            outcome: Any = ray.get(done)
        except RayTaskError as error:
            # Exceptions of environments and policies are returned, so this one comes from unpickling.
            self.idle.append(member)
            raise ClusterError(f"the policy cannot be sent to {member.node}: {error.cause}") from error
        except RayError as error:
            reason = self._lose(member, error)
            return None if batch is None else Returned(member.node, batch, None, reason)
        if batch is None:
            self._check_prepared(member, outcome)
            member.is_ready = True
        self.idle.append(member)
        return None if batch is None else Returned(member.node, batch, _received(outcome))

    def close(self) -> None:
        """Kill all actors."""
        if ray.is_initialized():
            for member in self.members:
                ray.kill(member.actor)
        self.members, self.idle, self._jobs = [], [], {}

    def _next_done(self) -> Any:
        while True:
            done, _ = ray.wait(list(self._jobs), num_returns=1, timeout=_PATIENCE)
            if done:
                return done[0]
            self._say_what_is_waited_for()

    def _check_prepared(self, member: Member, failure: Failure | None) -> None:
        if failure is not None:
            self._dismiss(member)
            reason = failure.text.strip().splitlines()[-1]
            error = ClusterError(f"no environment could be made on {member.node}: {reason}")
            raise error from failure.cause()

    def _lose(self, member: Member, error: RayError) -> str:
        """Handle the loss of an actor, and return the reason; a new actor may be started on its node."""
        self._dismiss(member)
        self._losses[member.node.id] += 1
        reason = " ".join(str(error).split())
        self.lost.append(f"{member.node}: {reason}")
        _log.warning("lost %s: %s", member.node, reason)
        self.fill_up()
        return reason

    def _dismiss(self, member: Member) -> None:
        self.members.remove(member)
        self.idle = [other for other in self.idle if other is not member]
        self._jobs = {ref: job for ref, job in self._jobs.items() if job[0] is not member}
        # The actor may be alive and only unreachable.
        ray.kill(member.actor)

    def _say_what_is_waited_for(self) -> None:
        starting = [str(member.node) for member in self.members if not member.is_ready]
        if starting:
            _log.warning(
                "waiting for environments on %s; Ray starts them where %g processors are free",
                ", ".join(starting),
                self.cpus,
            )


def _received(outcome: list[Episode] | bytes | Failed) -> Outcome:
    """The result of a batch from another process: an exception, episodes with writable arrays, or a part."""
    if isinstance(outcome, Failed):
        return outcome.error()
    if isinstance(outcome, bytes):
        return [unpacked(outcome)]
    # The received arrays are read-only memory of Ray's object store, which would fill up.
    return [episode.copy() for episode in outcome]
