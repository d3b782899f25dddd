"""Exceptions of rollouts."""

from __future__ import annotations

from collections.abc import Sequence

from carom.errors import CaromError

_MAX_NAMED = 8


class ClusterError(CaromError):
    """A rollout cannot continue: no node is left, or a node cannot play at all."""


class EpisodeError(ClusterError):
    """The policy, the environment or a reduction failed; its exception is the cause of this one.

    Attributes:
        what: "the policy", "the environment" or "the reduction".
        ids: Ids of the episodes that were being played.
        seeds: Seeds of these episodes.
    """

    def __init__(self, what: str, ids: Sequence[int], seeds: Sequence[int], reason: str) -> None:
        self.what = what
        self.ids = tuple(ids)
        self.seeds = tuple(seeds)
        self.reason = reason
        super().__init__(what, self.ids, self.seeds, reason)

    def __str__(self) -> str:
        seeds = _counted("seed", self.seeds)
        return f"{self.what} failed in {named(self.ids)} ({seeds}): {self.reason}"


def named(ids: Sequence[int]) -> str:
    """Ids of episodes as text, such as "episodes 3 to 7"."""
    return _counted("episode", ids)


def _counted(word: str, numbers: Sequence[int]) -> str:
    return f"{word}{'s' if len(numbers) > 1 else ''} {_listed(numbers)}"


def _listed(numbers: Sequence[int]) -> str:
    first, last = numbers[0], numbers[-1]
    if len(numbers) > 2 and list(numbers) == list(range(first, last + 1)):
        return f"{first} to {last}"
    shown = ", ".join(map(str, numbers[:_MAX_NAMED]))
    left = len(numbers) - _MAX_NAMED
    return f"{shown} and {left} more" if left > 0 else shown
