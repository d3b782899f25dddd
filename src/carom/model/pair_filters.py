"""Pairs of links with rules of their own: whether they collide, and how their contacts are."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from carom.native.change import Change
from carom.native.tables import ArrayTable

if TYPE_CHECKING:
    from carom.description.compliance import PairContact

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
        change = Change()
        self.note(change, link_a, link_b, enabled=enabled, contact=contact)
        change.commit()

    def note(
        self, change: Change, link_a: int, link_b: int, *, enabled: bool, contact: PairContact | None = None
    ) -> None:
        """The same with a change, which has no other rule."""
        pair = (min(link_a, link_b), max(link_a, link_b))
        count = len(self._pairs)
        at = bisect_left(self._pairs, pair)
        numpy = self._table.numpy
        if at == count or self._pairs[at] != pair:
            numpy = {**numpy, **self._table.grow(change, {"filter": count + 1})}
            for name in _FIELDS:
                change.write(numpy[name][at + 1 : count + 1], self._table.numpy[name][at:count])
                change.write(numpy[name][at : at + 1], 0)
            change.set(self, "_pairs", [*self._pairs[:at], pair, *self._pairs[at:]])
        for name, value in zip(_FIELDS, (*pair, int(enabled)), strict=False):
            change.write(numpy[name][at : at + 1], value)
        if contact is not None:
            self._note_contact(change, numpy, pair, at, contact)

    def _contact(self, row: int) -> PairContact | None:
        if not self.has_contacts:
            return None
        reference, impedance, friction, lateral = (
            self._table.numpy[name][row].tolist() for name in _OF_CONTACTS
        )
        if impedance[1] <= 0.0:
            return None
        from carom.description.compliance import Compliance, PairContact

        compliance = Compliance(*reference[:2], *impedance[:3], *reference[2:])
        return PairContact(compliance, tuple(friction), impedance[3], tuple(lateral[:2]))

    def _note_contact(
        self,
        change: Change,
        numpy: Mapping[str, np.ndarray],
        pair: tuple[int, int],
        row: int,
        contact: PairContact,
    ) -> None:
        yielding = contact.compliance
        values = (
            yielding.reference,
            (*yielding.impedance[:3], contact.margin),
            contact.friction,
            (*contact.lateral_reference, 0.0, 0.0),
        )
        for name, value in zip(_OF_CONTACTS, values, strict=True):
            change.write(numpy[name][row], value)
        margins, twists = (numpy[f"link_pair_{name}"] for name in ("margin", "twists"))
        for link in pair:
            change.write(margins[link : link + 1], max(margins[link], contact.margin))
            change.write(twists[link : link + 1], twists[link] | (max(contact.friction[1:]) > 0.0))
        change.set(self, "has_contacts", True)

    def remove(self, change: Change, first: int, count: int) -> None:
        """Drop the rules of links that are removed with a change; later links move up."""
        if not self._pairs:
            return
        after = first + count
        kept, rows = [], []
        for row, (a, b) in enumerate(self._pairs):
            if not (first <= a < after or first <= b < after):
                kept.append((a - count if a >= after else a, b - count if b >= after else b))
                rows.append(row)
        links = np.array(kept, dtype=np.int32).reshape(-1, 2).T
        for name, column in zip(_FIELDS, (*links, *self._columns(rows)), strict=True):
            target = self._table.numpy[name]
            change.write(target[: len(kept)], column)
            change.write(target[len(kept) : len(self._pairs)], 0)
        change.set(self, "_pairs", kept)

    def _columns(self, rows: range | list[int]) -> list[np.ndarray]:
        """Copies of some rows of all fields but those of the links."""
        return [self._table.numpy[name][list(rows)].copy() for name in _FIELDS[2:]]
