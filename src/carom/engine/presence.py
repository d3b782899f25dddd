"""Bodies that are absent: part of the scene, and so of all arrays, but not there in some worlds.

`State.tree_activity` says so. Kernels leave absent trees out of dynamics and constraints, and give their
shapes empty bounds; contacts and overlaps are dropped here, when a body goes. So the other bodies move bit
for bit as in a world made without it. Its own state stays as it is until it comes back.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from carom.engine.lost_contacts import counts_of, kept_rows
from carom.layouts.codes import ABSENT, ACTIVE, ASLEEP
from carom.layouts.contacts import OVERLAPS, SORTED, THERE
from carom.native.change import Change

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from carom.engine.contact_arrays import ContactArrays
    from carom.model.body_rows import TreeRows
    from carom.model.builder import WorldArrays
    from carom.native.tables import ArrayTable

    Mask = NDArray[np.bool_]


def any_absent(arrays: WorldArrays) -> bool:
    """Whether a body is absent in some world."""
    activity = np.asarray(arrays.state.numpy["tree_activity"])
    return bool((activity[:, : arrays.used["tree"]] == ABSENT).any())


def is_present(arrays: WorldArrays, rows: TreeRows) -> Mask:
    """In which worlds a body is present, a copy (worlds,)."""
    return np.asarray(arrays.state.numpy["tree_activity"])[:, rows.tree] != ABSENT


def absent_links(arrays: WorldArrays, links: np.ndarray, worlds: np.ndarray) -> Mask | None:
    """Which links belong to bodies that are absent.

    Args:
        arrays: The bodies.
        links: Rows of links, (n,).
        worlds: Indices of worlds.

    Returns:
        A mask (worlds, n); None if none is absent.
    """
    count = arrays.used["tree"]
    absent = np.asarray(arrays.state.numpy["tree_activity"])[worlds, :count] == ABSENT
    if not absent.any():
        return None
    trees = np.searchsorted(arrays.model.numpy["tree_first_link"][:count], links, side="right") - 1
    return absent[:, trees]


def change_presence(
    arrays: WorldArrays,
    contact_arrays: ContactArrays,
    rows: TreeRows,
    worlds: np.ndarray,
    present: Mask,
    change: Change | None = None,
) -> None:
    """Let a body come or go in some worlds.

    Where it goes, its contacts are dropped. Where it comes or goes, bodies are woken, and contacts are not
    warm started in the next step.

    Args:
        arrays: All bodies.
        contact_arrays: Their shapes, contacts and constraints.
        rows: Rows of the body.
        worlds: Indices of the worlds, (n,).
        present: Whether it is to be present in each, (n,).
        change: Notes what is written; without it, it is written at once.

    Raises:
        ValueError: The body is soft, or a soft body is anchored to it.
    """
    if rows.count["node"]:
        raise ValueError("a soft body is present in all worlds; only bodies of rigid links can be absent")
    if any(it.body is not None and it.body.tree == rows.tree for it in contact_arrays.soft.anchors.values()):
        raise ValueError("a soft body is anchored to this body, which has to be present; remove the anchor")
    state, tree = _numpy(arrays.state, change), rows.tree
    activity = state["tree_activity"]
    was_present = activity[worlds, tree] != ABSENT
    going, coming = worlds[was_present & ~present], worlds[~was_present & present]
    changed = np.concatenate([going, coming])
    first, count = contact_arrays.shapes.shape_rows(rows)
    contacts = contact_arrays.contacts
    kept = {
        world: kept_rows(contacts, range(first, first + count), world)
        for world in going[_are_met(contact_arrays, first, count, going)].tolist()
    }
    users = contact_arrays.users.numpy
    own = (users["user_tree_a"] == tree) | (users["user_tree_b"] == tree)
    tied = np.flatnonzero(own[: contact_arrays.user_count])
    numpy = _numpy(contacts, change)
    for world, left in kept.items():
        for name, rows_left in left.items():
            numpy[name][world, : len(rows_left)] = rows_left
        numpy["count_contacts"][world, [THERE, OVERLAPS]] = counts_of(left)
    activity[going, tree], activity[coming, tree] = ABSENT, ACTIVE
    for user in tied.tolist():
        state["user_impulse"][changed, user] = 0.0
    _wake(arrays, state, changed)
    numpy["count_contacts"][changed, SORTED] = 0
    numpy["contact_warm_start"][changed] = 0.0


def _numpy(table: ArrayTable, change: Change | None) -> Mapping[str, np.ndarray]:
    """The arrays of a table to write to."""
    return table.numpy if change is None else change.arrays(table.numpy)


def _are_met(contact_arrays: ContactArrays, first: int, count: int, worlds: np.ndarray) -> Mask:
    """In which worlds some shapes, by row, have contacts or overlaps."""
    numpy = contact_arrays.contacts.numpy
    counts = numpy["count_contacts"][worlds]
    met = np.zeros(len(worlds), dtype=bool)
    for name, column in (("contact_shapes", THERE), ("overlap_shapes", OVERLAPS)):
        used = int(counts[:, column].max(initial=0))
        shapes = numpy[name][worlds, :used, :2]
        own = ((shapes >= first) & (shapes < first + count)).any(axis=2)
        met |= (own & (np.arange(used) < counts[:, column, None])).any(axis=1)
    return met


def _wake(arrays: WorldArrays, state: Mapping[str, np.ndarray], worlds: np.ndarray) -> None:
    """Wake all bodies that are asleep in some worlds and may wake: what they rested on may be gone."""
    count = arrays.used["tree"]
    asleep = state["tree_activity"][worlds, :count] == ASLEEP
    if not asleep.any():
        return
    places, trees = np.nonzero(asleep & (arrays.model.numpy["tree_can_wake"][:count] != 0))
    state["tree_activity"][worlds[places], trees] = ACTIVE
    state["tree_wants_sleep"][worlds[places], trees] = 0
    state["tree_idle_time"][worlds[places], trees] = 0.0
