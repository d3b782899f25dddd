"""Pairs of links whose collisions users switched on or off."""

from __future__ import annotations

from bisect import bisect_left

from carom.model.arrays import ArrayTable

_FIELDS = ("filter_link_a", "filter_link_b", "filter_enabled")


class PairFilters:
    """Rules for pairs of links, in the `filter_` fields of `Shapes`, sorted.

    Args:
        table: Where those fields are.
    """

    def __init__(self, table: ArrayTable) -> None:
        self._table = table
        self._pairs: list[tuple[int, int]] = []

    @property
    def count(self) -> int:
        """How many rules there are."""
        return len(self._pairs)

    @property
    def all(self) -> list[tuple[int, int, bool]]:
        """Rows of two links, and whether they collide, of every rule."""
        enabled = self._table.numpy["filter_enabled"]
        return [(a, b, bool(enabled[row])) for row, (a, b) in enumerate(self._pairs)]

    def set(self, link_a: int, link_b: int, *, enabled: bool) -> bool:
        """Let two links collide, or keep them from it, whatever their groups and masks say.

        Args:
            link_a: Row of a link.
            link_b: Row of the other.
            enabled: They collide.

        Returns:
            Whether arrays were replaced.
        """
        pair = (min(link_a, link_b), max(link_a, link_b))
        at = bisect_left(self._pairs, pair)
        grown = False
        if at == len(self._pairs) or self._pairs[at] != pair:
            grown = self._table.reserve({"filter": len(self._pairs) + 1})
            for name in _FIELDS:
                rows = self._table.numpy[name]
                rows[at + 1 : len(self._pairs) + 1] = rows[at : len(self._pairs)].copy()
            self._pairs.insert(at, pair)
        self._write(at, pair, int(enabled))
        return grown

    def _write(self, at: int, pair: tuple[int, int], enabled: int) -> None:
        for name, value in zip(_FIELDS, (*pair, enabled), strict=True):
            self._table.numpy[name][at] = value

    def forget_links(self, first: int, count: int) -> None:
        """Drop the rules of links that are removed; later links move up."""
        enabled = self._table.numpy["filter_enabled"][: len(self._pairs)].tolist()
        kept = [
            (tuple(link - count if link >= first + count else link for link in pair), rule)
            for pair, rule in zip(self._pairs, enabled, strict=True)
            if not any(first <= link < first + count for link in pair)
        ]
        for name in _FIELDS:
            self._table.numpy[name][: len(self._pairs)] = 0
        self._pairs = [(a, b) for (a, b), _ in kept]
        for at, (pair, (_, rule)) in enumerate(zip(self._pairs, kept, strict=True)):
            self._write(at, pair, rule)
