"""Pairs of links with rules of their own: whether they collide, and how their contacts are."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from functools import partial

import numpy as np

from carom.description.compliance import Compliance, PairContact
from carom.native.tables import ArrayTable

_FIELDS = (
    "filter_link_a",
    "filter_link_b",
    "filter_enabled",
    "filter_reference",
    "filter_impedance",
    "filter_friction",
    "filter_lateral",
)
_OF_CONTACTS = _FIELDS[3:]


class PairFilters:
    """Rules for pairs of links, kept sorted in the `filter_` fields of a table of `Shapes`.

    Attributes:
        has_contacts: Some pair has stated how its contacts are.
    """

    def __init__(self, table: ArrayTable) -> None:
        self._table = table
        self._pairs: list[tuple[int, int]] = []
        self.has_contacts: bool = False

    @property
    def count(self) -> int:
        """Number of rules."""
        return len(self._pairs)

    @property
    def all(self) -> list[tuple[int, int, bool, PairContact | None]]:
        """All rules: the rows of both links, whether they collide, and how their contacts are, if stated."""
        enabled = self._table.numpy["filter_enabled"]
        return [(a, b, bool(enabled[row]), self._contact(row)) for row, (a, b) in enumerate(self._pairs)]

    def contact(self, link_a: int, link_b: int) -> PairContact | None:
        """How the contacts of two links are, by row, if their pair states it."""
        pair = (min(link_a, link_b), max(link_a, link_b))
        at = bisect_left(self._pairs, pair)
        return self._contact(at) if at < len(self._pairs) and self._pairs[at] == pair else None

    def set(self, link_a: int, link_b: int, *, enabled: bool, contact: PairContact | None = None) -> None:
        """Enable or disable collisions of two links, by row, overriding their groups and masks.

        With `contact` their contacts are as it says, whatever the links say; without, that stays as it is.
        """
        pair = (min(link_a, link_b), max(link_a, link_b))
        at = bisect_left(self._pairs, pair)
        if at == len(self._pairs) or self._pairs[at] != pair:
            self._table.reserve({"filter": len(self._pairs) + 1})
            for name in _FIELDS:
                rows = self._table.numpy[name]
                rows[at + 1 : len(self._pairs) + 1] = rows[at : len(self._pairs)].copy()
                rows[at] = 0
            self._pairs.insert(at, pair)
        for name, value in zip(_FIELDS, (*pair, int(enabled)), strict=False):
            self._table.numpy[name][at] = value
        if contact is not None:
            self._write(at, contact)

    def _contact(self, row: int) -> PairContact | None:
        if not self.has_contacts:
            return None
        reference, impedance, friction, lateral = (
            self._table.numpy[name][row].tolist() for name in _OF_CONTACTS
        )
        if impedance[1] <= 0.0:
            return None
        compliance = Compliance(*reference[:2], *impedance[:3], *reference[2:])
        return PairContact(compliance, tuple(friction), impedance[3], tuple(lateral[:2]))

    def _write(self, row: int, contact: PairContact) -> None:
        yielding = contact.compliance
        values = (
            yielding.reference,
            (*yielding.impedance[:3], contact.margin),
            contact.friction,
            (*contact.lateral_reference, 0.0, 0.0),
        )
        for name, value in zip(_OF_CONTACTS, values, strict=True):
            self._table.numpy[name][row] = value
        margins, twists = (self._table.numpy[f"link_pair_{name}"] for name in ("margin", "twists"))
        for link in self._pairs[row]:
            margins[link] = max(margins[link], contact.margin)
            twists[link] |= max(contact.friction[1:]) > 0.0
        self.has_contacts = True

    def way_back(self) -> Callable[[], None]:
        """A function that restores the present rules."""
        if not self._pairs:
            return self._forget_all
        return partial(self._write_all, self._pairs.copy(), self._columns(range(len(self._pairs))))

    def _forget_all(self) -> None:
        self._write_all([], self._columns(range(0)))

    def removal(self, first: int, count: int) -> Callable[[], None]:
        """Prepare to drop the rules of removed links; later links move up. It can be called again."""
        after = first + count
        kept, rows = [], []
        for row, (a, b) in enumerate(self._pairs):
            if not (first <= a < after or first <= b < after):
                kept.append((a - count if a >= after else a, b - count if b >= after else b))
                rows.append(row)
        return partial(self._write_all, kept, self._columns(rows))

    def _columns(self, rows: range | list[int]) -> list[np.ndarray]:
        """Copies of some rows of all fields but those of the links."""
        return [self._table.numpy[name][list(rows)].copy() for name in _FIELDS[2:]]

    def _write_all(self, pairs: list[tuple[int, int]], columns: list[np.ndarray]) -> None:
        if not pairs and not self._pairs:
            return
        links = np.array(pairs, dtype=np.int32).reshape(-1, 2).T
        for name, column in zip(_FIELDS, (*links, *columns), strict=True):
            rows = self._table.numpy[name]
            rows[: len(pairs)] = column
            rows[len(pairs) :] = 0
        # Assigned last, so that a call after an interruption repeats everything.
        self._pairs = pairs.copy()
