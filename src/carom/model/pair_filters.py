"""Pairs of links whose collisions the user has enabled or disabled."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from functools import partial

import numpy as np

from carom.native.tables import ArrayTable

_FIELDS = ("filter_link_a", "filter_link_b", "filter_enabled")


class PairFilters:
    """Rules for pairs of links, kept sorted in the `filter_` fields of a table of `Shapes`."""

    def __init__(self, table: ArrayTable) -> None:
        self._table = table
        self._pairs: list[tuple[int, int]] = []

    @property
    def count(self) -> int:
        """Number of rules."""
        return len(self._pairs)

    @property
    def all(self) -> list[tuple[int, int, bool]]:
        """All rules: the rows of both links, and whether they collide."""
        enabled = self._table.numpy["filter_enabled"]
        return [(a, b, bool(enabled[row])) for row, (a, b) in enumerate(self._pairs)]

    def set(self, link_a: int, link_b: int, *, enabled: bool) -> None:
        """Enable or disable collisions of two links, by row, overriding their groups and masks."""
        pair = (min(link_a, link_b), max(link_a, link_b))
        at = bisect_left(self._pairs, pair)
        if at == len(self._pairs) or self._pairs[at] != pair:
            self._table.reserve({"filter": len(self._pairs) + 1})
            for name in _FIELDS:
                rows = self._table.numpy[name]
                rows[at + 1 : len(self._pairs) + 1] = rows[at : len(self._pairs)].copy()
            self._pairs.insert(at, pair)
        for name, value in zip(_FIELDS, (*pair, int(enabled)), strict=True):
            self._table.numpy[name][at] = value

    def way_back(self) -> Callable[[], None]:
        """A function that restores the present rules."""
        if not self._pairs:
            return self._forget_all
        enabled = self._table.numpy["filter_enabled"][: len(self._pairs)].copy()
        return partial(self._write_all, self._pairs.copy(), enabled)

    def _forget_all(self) -> None:
        self._write_all([], np.zeros(0))

    def removal(self, first: int, count: int) -> Callable[[], None]:
        """Prepare to drop the rules of removed links; later links move up. It can be called again."""
        after = first + count
        kept, enabled = [], []
        for a, b, rule in self.all:
            if not (first <= a < after or first <= b < after):
                kept.append((a - count if a >= after else a, b - count if b >= after else b))
                enabled.append(rule)
        return partial(self._write_all, kept, np.array(enabled))

    def _write_all(self, pairs: list[tuple[int, int]], enabled: np.ndarray) -> None:
        if not pairs and not self._pairs:
            return
        columns = (*np.array(pairs).reshape(-1, 2).T, enabled)
        for name, column in zip(_FIELDS, columns, strict=True):
            rows = self._table.numpy[name]
            rows[: len(pairs)] = column
            rows[len(pairs) :] = 0
        # Assigned last, so that a call after an interruption repeats everything.
        self._pairs = pairs.copy()
