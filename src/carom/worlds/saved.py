"""Saved states of worlds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.checks import Array
from carom.engine.engine import Engine
from carom.layouts.contacts import COUNTED
from carom.layouts.types import STATE
from carom.native.block_copies import copy_worlds


@dataclass(frozen=True, slots=True)
class SavedWorlds:
    """States of some worlds; get them from `Worlds.snapshot`.

    Attributes:
        worlds: The worlds whose states these are, shape (n,).
        times: Simulated time of each [s], shape (n,).
        unspent_times: Part of it not yet covered by a substep [s], shape (n,).
        state: Fields of `State`; first axis: worlds.
        contacts: Fields of `Contacts`, likewise, with the rows of the world with the most contacts.
        sizes: Sizes of shapes with which these contacts were found, (n, shapes, 3), or (1, shapes, 3) if they
            were the same in all worlds; None if they are those that the worlds have.
    """

    worlds: np.ndarray
    times: Array
    unspent_times: Array
    state: dict[str, np.ndarray]
    contacts: dict[str, np.ndarray]
    sizes: np.ndarray | None = None

    @classmethod
    def take(cls, engine: Engine, worlds: np.ndarray, times: Array, unspent_times: Array) -> SavedWorlds:
        """The present states of some worlds."""
        most = _most_rows(np.asarray(engine.contact_arrays.contacts.numpy["count_contacts"])[worlds])
        state = {name: array[worlds] for name, array in engine.arrays.state.of_kind(STATE).items()}
        table = engine.contact_arrays.contacts
        contacts = {
            name: array[worlds, : most[axis]] if (axis := table.axis_of(name)) in most else array[worlds]
            for name, array in table.of_kind(STATE).items()
        }
        sizes = _sizes(engine)
        own = sizes[worlds] if len(sizes) > 1 else sizes.copy()
        return cls(worlds.copy(), times.copy(), unspent_times.copy(), state, contacts, own)

    def __len__(self) -> int:
        return len(self.worlds)

    def rows_for(self, worlds: np.ndarray, count: int) -> np.ndarray:
        """For each of some worlds, the index of its saved state; `ValueError` if their number is wrong."""
        if len(self) == 1:
            return np.zeros(len(worlds), dtype=np.int64)
        if len(self) == count:
            return worlds
        if len(self) != len(worlds):
            raise ValueError(
                f"these are states of {len(self)} worlds; {len(worlds)} are to be restored: give as many, "
                f"or one, or states of all {count} worlds"
            )
        return np.arange(len(worlds))

    def put_back(self, engine: Engine, worlds: np.ndarray, rows: np.ndarray) -> None:
        """Restore worlds to saved states; `rows` are the indices of the states that they get.

        Where shapes have other sizes now, contacts are dropped, and detected again at the next step.

        Raises:
            ValueError: They are states of other bodies; nothing is changed.
        """
        fields = engine.arrays.state.of_kind(STATE)
        if {name: array.shape[1:] for name, array in fields.items()} != {
            name: array.shape[1:] for name, array in self.state.items()
        }:
            raise ValueError("these are states of worlds with other bodies")
        most = _most_rows(np.asarray(self.contacts["count_contacts"])[rows])
        if engine.contact_arrays.contacts.reserve(most):
            engine.changed()
        pairs: list[tuple[np.ndarray, np.ndarray, int | None]]
        pairs = [(self.state[name], array, None) for name, array in fields.items()]
        table = engine.contact_arrays.contacts
        for name, array in table.of_kind(STATE).items():
            pairs.append((self.contacts[name], array, most.get(table.axis_of(name))))
        on_host = [it for it in pairs if isinstance(it[1], np.ndarray) and it[2] != 0]
        copy_worlds([(source, target, count or 0) for source, target, count in on_host], rows, worlds)
        for source, array, count in pairs:
            # Those on a device copy rows themselves.
            if not isinstance(array, np.ndarray):
                array[(worlds, *_first(count))] = source[(rows, *_first(count))]
        engine.status[worlds] = 0
        self._drop_contacts(engine, worlds, rows)
        engine.contact_arrays.forget_order()
        engine.activity_changed()

    def _drop_contacts(self, engine: Engine, worlds: np.ndarray, rows: np.ndarray) -> None:
        """Drop the contacts of shapes that had another size."""
        if self.sizes is None:
            return
        present, saved = _sizes(engine), self.sizes
        if len(present) == len(saved) == 1 < engine.arrays.world_count:
            # Whoever sets the size of a shape gives each world sizes of its own.
            return
        own = present[worlds if len(present) > 1 else [0] * len(worlds)]
        before = saved[rows if len(saved) > 1 else [0] * len(worlds)]
        differs = (own != before).any(axis=(1, 2))
        if differs.any():
            engine.contact_arrays.drop_contacts_in(worlds[differs])


def _sizes(engine: Engine) -> np.ndarray:
    return engine.contact_arrays.shapes.table.numpy["shape_size"]


def _first(count: int | None) -> tuple[slice, ...]:
    """The index of the first rows of the second axis; of all of them without one."""
    return () if count is None else (slice(count),)


def _most_rows(counts: np.ndarray) -> dict[str, int]:
    """The greatest number of rows of a world by axis, from rows of `count_contacts`."""
    return {axis: int(counts[:, column].max(initial=0)) for axis, column in COUNTED.items()}
