"""Contact arrays: shapes, contacts, user constraints, soft bodies."""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy
from typing import Any

import numpy as np

from carom.engine.lost_contacts import Rows, counts_of, island_of, kept_rows, renumber
from carom.layouts.contacts import (
    CONTACT_COLUMNS,
    HELD_BEFORE,
    HOLDING,
    KNOWN,
    MAX_RESETS,
    OVERLAPS,
    RESETS,
    RESETS_SEEN,
    SORTED,
    THERE,
    Contacts,
)
from carom.layouts.pair_rows import UserConstraints
from carom.model.body_rows import TreeRows
from carom.model.builder import WorldArrays
from carom.model.shape_arrays import ShapeArrays
from carom.model.soft_arrays import SoftArrays
from carom.native.change import Change
from carom.native.tables import ArrayTable

# Initial number of contacts in each of many worlds.
_MIN_CONTACTS = 4


def cold_start(counters: np.ndarray) -> np.ndarray:
    """Counters of contacts that were `counters`, after a body was moved; as in `bodies.cpp`."""
    return ((counters == HOLDING) | (counters == HELD_BEFORE)) * HELD_BEFORE


class ContactArrays:
    """Shapes, contacts, user constraints and soft bodies."""

    def __init__(self, arrays: WorldArrays) -> None:
        self._arrays = arrays
        self.shapes: ShapeArrays = ShapeArrays()
        self.contacts: ArrayTable = ArrayTable(Contacts, arrays.world_count)
        self.users: ArrayTable = ArrayTable(UserConstraints)
        self.user_count = 0
        self.soft: SoftArrays = SoftArrays()

    def repeated(self, arrays: WorldArrays) -> ContactArrays:
        """Copies of the contact arrays for many worlds, all with the content of the first world."""
        other = ContactArrays(arrays)
        other.shapes = deepcopy(self.shapes)
        other.contacts = self.contacts.copy(
            arrays.world_count,
            {
                "contact": max(_MIN_CONTACTS, self.contact_count),
                "overlap": max(_MIN_CONTACTS, self.overlap_count),
                "count": CONTACT_COLUMNS,
            },
        )
        other.users = self.users.copy()
        other.user_count = self.user_count
        other.soft = deepcopy(self.soft)
        return other

    @property
    def contact_count(self) -> int:
        """Current number of contacts in the first world."""
        return int(self.contacts.numpy["count_contacts"][0, THERE])

    @property
    def overlap_count(self) -> int:
        """Current number of overlaps in the first world."""
        return int(self.contacts.numpy["count_contacts"][0, OVERLAPS])

    def drop_contacts(self, change: Change) -> None:
        """Drop all contacts and overlaps with a change; the next step finds them anew."""
        change.write(self.contacts.numpy["count_contacts"][:, :RESETS], 0)

    def drop_contacts_in(self, worlds: slice | np.ndarray) -> None:
        """Drop all contacts and overlaps of some worlds; the next step finds them anew."""
        self.contacts.numpy["count_contacts"][worlds, :RESETS] = 0

    def forget_contacts(self) -> None:
        """Drop all contacts and overlaps, because the rows of their shapes will change."""
        self.contacts.numpy["count_contacts"][:, :RESETS] = 0

    def remove(self, change: Change, rows: TreeRows) -> None:
        """Remove a body's shapes and contacts from a single world with a change; all others keep theirs.

        Args:
            change: The change.
            rows: Rows of its tree, which are still present.
        """
        first, count = self.shapes.shape_rows(rows)
        links = rows.first["link"], rows.count["link"]
        kept = kept_rows(self.contacts, range(first, first + count))
        counts = self.contacts.numpy["count_contacts"][0].copy()
        if len(kept["contact_shapes"]) < counts[THERE]:
            # For its island as if it had been moved, see `cold_starts`.
            counters, near = kept["contact_warm_start"], self._neighbours(rows.tree, kept)
            counters[near] = cold_start(counters[near])
        renumber(kept, (first, count), links)
        counts[KNOWN] -= max(0, min(count, int(counts[KNOWN]) - first))
        self.shapes.remove(change, rows)
        self._replace_contacts(change, kept, counts)

    def _neighbours(self, tree: int, kept: Rows) -> np.ndarray:
        """Which of the rows of a single world's contacts, (n,), are of the island of a tree."""
        trees = self.shapes.table.numpy["shape_tree"]
        pairs = trees[self.contacts.numpy["contact_shapes"][0, : self.contact_count, :2]]
        can_move = self._arrays.model.numpy["tree_dof_count"] > 0
        island = island_of(tree, pairs, can_move)
        return np.any(island[trees[kept["contact_shapes"][:, :2]]], axis=1)

    def part(self, change: Change, *parted: Sequence[int]) -> None:
        """Drop the contacts of links of a single world, which may collide with others after a change.

        The next step finds them anew, after those of all other bodies, as in Bullet.

        Args:
            change: The change.
            *parted: Rows of links, of one body after the other.
        """
        rows = self.shapes.table.numpy
        first, count = rows["link_first_shape"], rows["link_shape_count"]
        counts = self.contacts.numpy["count_contacts"][0].copy()
        numbers = self._arrays.state.numpy["tree_reset"][0]
        lost: list[int] = []
        for links in parted:
            shapes = [row for link in links for row in range(first[link], first[link] + count[link])]
            lost += shapes
            # As if they had been moved, see `note_resets`.
            counts[RESETS] = resets = min(int(counts[RESETS]) + 1, MAX_RESETS)
            for tree in {int(rows["shape_tree"][shape]) for shape in shapes}:
                change.write(numbers[tree : tree + 1], -resets)
        self._replace_contacts(change, kept_rows(self.contacts, lost), counts)

    def _replace_contacts(self, change: Change, kept: Rows, counts: np.ndarray) -> None:
        """Replace contacts, overlaps and counts of a single world; counts lack the numbers of both."""
        numpy = self.contacts.numpy
        for name, rows in kept.items():
            change.write(numpy[name][0, : len(rows)], rows)
        counts[THERE], counts[OVERLAPS] = counts_of(kept)
        counts[SORTED] = 0
        change.write(numpy["count_contacts"][0], counts)

    def forget_order(self) -> None:
        """Sort rows anew in the next step: movable trees, constraints or parameters may be others."""
        self.contacts.numpy["count_contacts"][:, SORTED] = 0

    def cold_starts(self, worlds: slice | np.ndarray) -> tuple[Any, slice | np.ndarray, Any]:
        """What to write where bodies were moved: an array, the index of the worlds in it, and the values.

        Contacts are not warm started in the next step then: it depends only on the new poses. In a single
        world `QuickScene.cold_start` does it.
        """
        counters = self.contacts.numpy["contact_warm_start"]
        return counters, worlds, cold_start(counters[worlds])

    def note_resets(self, change: Change, tree: int, *moved: bool) -> None:
        """Note that a change resets a body of a single world, for the order in which contacts are relaxed.

        Only PyBullet's functions do so, since only there the order of calls is known to matter.

        Args:
            change: The change.
            tree: Its tree.
            *moved: For each of its resets, whether it has another pose then; else only the first one after
                a step counts.
        """
        counts = self.contacts.numpy["count_contacts"][0, RESETS : RESETS_SEEN + 1]
        numbers = self._arrays.state.numpy["tree_reset"][0, tree : tree + 1]
        (count, seen), (number,) = counts.tolist(), numbers.tolist()
        before = count, number
        for moves in moved:
            if moves or abs(number) <= seen:
                count = min(count + 1, MAX_RESETS)
                number = -count if moves else count
        if (count, number) != before:
            change.write_numbers(counts, (count, seen), "i")
            change.write_numbers(numbers, (number,), "i")

    def reserve(self) -> None:
        """Grow arrays to the capacity of the arrays with the same axes."""
        self.shapes.reserve({"link": self._arrays.model.capacity["link"]})
        self.users.reserve({"user": self.user_count})
        used = self._arrays.used
        self._arrays.state.reserve({"user": self.user_count, "batch": max(used["tree"], used["constraint"])})

    def structs(self) -> dict[str, Any]:
        """Structs over the current arrays, by the names of kernel arguments."""
        return {
            "shapes": self.shapes.struct(),
            "contacts": self.contacts.struct(),
            "users": self.users.struct(),
            "soft": self.soft.struct(),
        }
