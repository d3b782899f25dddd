"""Bookkeeping of a collection: which episodes are to be played, and which count; each counts once."""

from __future__ import annotations

import heapq
import itertools
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Protocol, TypeAlias

from carom.cluster.errors import ClusterError, EpisodeError, named


class Entry(Protocol):
    """An episode, or the part of a reduction that stands for a whole batch."""

    @property
    def length(self) -> int:
        """Number of steps."""
        ...


Outcome: TypeAlias = Sequence[Entry] | EpisodeError
"""Result of a batch."""


class CollectionProgress:
    """The bookkeeping of one collection: of `episodes`, or of at least `steps`; the other is None.

    Nodes play *batches* of consecutive episodes. Finished batches are counted in the order of their episodes,
    not in the order in which they finish. So the collected episodes do not depend on which node plays which
    batch, and a failure is reported if, and only if, the episodes before it were not enough. The collection
    also fails if a batch loses its process so many times (`attempts`).

    Attributes:
        first: Id of the first episode.
        counted: What counts, in the order of the ids of the episodes, which are consecutive.
        repeated: Number of episodes that were repeated.
    """

    def __init__(
        self, first: int, batch_size: int, *, episodes: int | None, steps: int | None, attempts: int
    ) -> None:
        self.first = first
        self.counted: list[Entry] = []
        self.repeated = 0
        self._end = None if episodes is None else first + episodes
        self._steps, self._attempts = steps, attempts
        self._fresh = _batches(first, batch_size, self._end)
        self._lost: list[tuple[int, range]] = []
        self._losses: Counter[int] = Counter()
        self._early: dict[int, Outcome] = {}
        """Outcomes that are not counted yet because earlier batches are missing, by the batch's first id."""
        self._sizes: dict[int, int] = {}
        self._next = first
        """Id of the first episode that is not counted yet."""
        self._has_failed = False
        self._steps_counted = 0

    @property
    def is_full(self) -> bool:
        """Whether the requested number of episodes or steps is reached."""
        if self._end is not None:
            return self._next >= self._end
        return self._steps is not None and self._steps_counted >= self._steps

    def take(self) -> range | None:
        """The ids of the next batch to play; None if there is no batch to play at present."""
        if self._lost:
            batch = heapq.heappop(self._lost)[1]
            self.repeated += len(batch)
            return batch
        # After a failure no new batches are played: those in progress are enough, or the failure is raised.
        return None if self._has_failed or self.is_full else next(self._fresh, None)

    def finish(self, batch: range, outcome: Outcome) -> bool:
        """Enter the outcome of a batch.

        Returns:
            Whether the outcome is used: it is not if there is an outcome of this batch already.

        Raises:
            EpisodeError: This batch failed, or a later one that could not be counted before it.
        """
        if batch.start < self._next or batch.start in self._early:
            return False
        self._early[batch.start], self._sizes[batch.start] = outcome, len(batch)
        self._has_failed |= isinstance(outcome, EpisodeError)
        while self._next in self._early and not self.is_full:
            self._count(self._early.pop(self._next))
        return True

    def lose(self, batch: range, reason: str) -> None:
        """Enter that the actor that played a batch was lost; the batch will be played again.

        Raises:
            ClusterError: This batch has lost its actor too often.
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
        for entry in outcome:
            if self._steps is not None and self.is_full:
                break
            self.counted.append(entry)
            self._steps_counted += entry.length


def _batches(first: int, size: int, end: int | None) -> Iterator[range]:
    for start in itertools.count(first, size):
        if end is not None and start >= end:
            return
        yield range(start, start + size if end is None else min(start + size, end))
