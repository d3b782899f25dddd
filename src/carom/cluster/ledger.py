"""Which episodes are still to be played, are being played, and have been: each counts once."""

from __future__ import annotations

import heapq
import itertools
from collections import Counter
from collections.abc import Iterator
from typing import TypeAlias

from carom.cluster.episode import Episode
from carom.cluster.errors import ClusterError, EpisodeError, named

Outcome: TypeAlias = list[Episode] | EpisodeError
"""What came of a batch."""


class Ledger:
    """The account of one collection.

    Work is handed out in *batches*, runs of consecutive episodes, and counted in the order of the episodes,
    whatever the order in which it comes back. So what is collected does not depend on who plays what, and a
    failure is reported if, and only if, all episodes before it were not enough.

    Attributes:
        counted: The episodes that count, in the order of their ids, without a gap.
        repeated: Number of episodes that were repeated.

    Args:
        first: The id of the first episode.
        batch_size: Episodes of a batch.
        episodes: Number of episodes; None if the number of steps is given.
        steps: Minimum number of steps of all together; the last episode is the one that reaches it.
        attempts: Number of attempts after which a batch is believed to kill its processes.
    """

    def __init__(
        self, first: int, batch_size: int, *, episodes: int | None, steps: int | None, attempts: int
    ) -> None:
        self.counted: list[Episode] = []
        self.repeated = 0
        self._episodes, self._steps, self._attempts = episodes, steps, attempts
        self._fresh = _batches(first, batch_size, None if episodes is None else first + episodes)
        self._lost: list[tuple[int, range]] = []
        self._losses: Counter[int] = Counter()
        self._early: dict[int, Outcome] = {}
        """Outcomes by the first id of their batch, while batches before them are missing."""
        self._sizes: dict[int, int] = {}
        self._next = first
        """The first episode that is not counted yet."""
        self._has_failed = False
        self._steps_counted = 0

    @property
    def is_full(self) -> bool:
        """Whether there is as much as was asked for."""
        if self._episodes is not None:
            return len(self.counted) >= self._episodes
        return self._steps is not None and self._steps_counted >= self._steps

    def take(self) -> range | None:
        """The ids of the next batch to play; None if there is none now."""
        if self._lost:
            batch = heapq.heappop(self._lost)[1]
            self.repeated += len(batch)
            return batch
        # What comes after a failure is not wanted unless what is out there turns out to be enough.
        return None if self._has_failed or self.is_full else next(self._fresh, None)

    def finish(self, batch: range, outcome: Outcome) -> bool:
        """A batch has come back.

        Returns:
            Whether it counts: it does not if it has come back before.

        Raises:
            EpisodeError: It, or one after it that was waiting for it, has failed.
        """
        if batch.start < self._next or batch.start in self._early:
            return False
        self._early[batch.start], self._sizes[batch.start] = outcome, len(batch)
        self._has_failed |= isinstance(outcome, EpisodeError)
        while self._next in self._early and not self.is_full:
            self._count(self._early.pop(self._next))
        return True

    def lose(self, batch: range, reason: str) -> None:
        """The actor of a batch was lost.

        Raises:
            ClusterError: It has happened to this batch too often.
        """
        if batch.start < self._next or batch.start in self._early:
            return
        self._losses[batch.start] += 1
        if self._losses[batch.start] >= self._attempts:
            raise ClusterError(
                f"{self._attempts} processes died while they played {named(batch)}, the last one for this "
                f"reason: {reason}"
            )
        heapq.heappush(self._lost, (batch.start, batch))

    def _count(self, outcome: Outcome) -> None:
        if isinstance(outcome, EpisodeError):
            raise outcome
        self._next += self._sizes.pop(self._next)
        for episode in outcome:
            if self.is_full:
                break
            self.counted.append(episode)
            self._steps_counted += episode.length


def _batches(first: int, size: int, end: int | None) -> Iterator[range]:
    for start in itertools.count(first, size):
        if end is not None and start >= end:
            return
        yield range(start, start + size if end is None else min(start + size, end))
