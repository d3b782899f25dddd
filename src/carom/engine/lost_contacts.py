"""Contacts and overlaps that shapes lose between steps, because they are removed or may meet others now.

As in Bullet, all other contacts stay, with their impulses, and overlaps keep their order.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom.layouts.contacts import OVERLAPS, THERE
from carom.model.overlap_order import without_overlaps
from carom.native.tables import ArrayTable

_OVERLAPS = (
    "overlap_shapes",
    "overlap_place",
    "overlap_manifold",
    "overlap_breaking",
    "overlap_solved_up_to",
)

Rows = dict[str, np.ndarray]
"""Fields of contacts and of overlaps of a world, with all rows there are."""


def kept_rows(contacts: ArrayTable, lost: Sequence[int], world: int = 0) -> Rows:
    """The contacts and overlaps of a world, except those of some shapes, by row."""
    numpy = contacts.numpy
    counts = numpy["count_contacts"][world]
    there = int(counts[THERE])
    shapes = numpy["contact_shapes"][world, :there, :2]
    stays = np.ones(there, dtype=bool)
    for shape in lost:
        stays &= (shapes != shape).all(axis=1)
    fields = {name: rows[world] for name, rows in numpy.items() if name.startswith("contact_")}
    # Most bodies touch nothing: then only row numbers can change.
    changed = ("contact_shapes", "contact_warm_start") if stays.all() else fields
    rows = {name: fields[name][:there][stays] for name in changed}
    pairs, places, manifolds, *distances = (numpy[name][world, : counts[OVERLAPS]] for name in _OVERLAPS)
    rows.update(zip(_OVERLAPS, without_overlaps(pairs, places, manifolds, distances, lost), strict=True))
    return rows


def island_of(tree: int, pairs: np.ndarray, can_move: np.ndarray) -> np.ndarray:
    """The trees that a tree touches, those that can move and touch these, and so on.

    Args:
        tree: The tree.
        pairs: The trees that each contact is of, -1 for the world, (contacts, 2).
        can_move: Whether each tree can move, (trees,).

    Returns:
        Whether each tree is of the island, then whether the world is, which is never so, (trees + 1,).
    """
    can_move = np.append(can_move, False)
    island = np.zeros(len(can_move), dtype=bool)
    island[tree] = True
    while True:
        met = pairs[island[pairs].any(axis=1)]
        new = met[can_move[met] & ~island[met]]
        if not len(new):
            return island
        island[new] = True


def renumber(rows: Rows, shapes: tuple[int, int], links: tuple[int, int]) -> None:
    """Renumber rows for the removal of some shapes and links; of each the first row and their number."""
    for numbers, (first, count) in (
        (rows["overlap_shapes"], shapes),
        (rows["contact_shapes"][:, :2], shapes),
        (rows["contact_shapes"][:, 2:], links),
    ):
        numbers -= count * (numbers >= first + count)


def counts_of(rows: Rows) -> tuple[int, int]:
    """The numbers of contacts and of overlaps."""
    return len(rows["contact_shapes"]), len(rows["overlap_shapes"])
