"""Several worlds of the same scene in one set of arrays, stepped by the fine launches that are for GPUs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from carom import World
from carom.model.arrays import ArrayTable
from carom.model.contact_structs import COUPLING_ENTRY_VIEWS, Contacts, Couplings, Pairs
from carom.model.structs import ENTRY_VIEWS, Scratch, State
from carom.parallel_step import Extent, ParallelStep
from carom.prospects import can_sleep, can_touch

DEVICE = "cpu"


class SideBySide:
    """Worlds of the same bodies, as they are now; they themselves stay as they are.

    Attributes:
        tables: Their arrays with a leading world axis, by the names that kernels give them.
        coupled: Whether their bodies can touch, are tied together or can fall asleep.
    """

    def __init__(self, worlds: Sequence[World]) -> None:
        for world in worlds:
            world.step(0)
            world._make_stepper()
        first = worlds[0]
        self.tables: Mapping[str, ArrayTable] = {
            "state": _stack(State, [world.arrays.state for world in worlds]),
            "scratch": _stack(Scratch, [world.arrays.scratch for world in worlds], ENTRY_VIEWS),
            "pairs": _stack(Pairs, [world.touch.pairs for world in worlds]),
            "contacts": _stack(Contacts, [world.touch.contacts for world in worlds]),
            "couplings": _stack(Couplings, [world.touch.couplings for world in worlds], COUPLING_ENTRY_VIEWS),
        }
        structs: dict[str, Any] = dict(first._kernel_structs())
        structs |= {name: table.struct(DEVICE) for name, table in self.tables.items()}
        extent = Extent(
            len(worlds),
            first.arrays.used["tree"],
            first.touch.shapes.shape_count,
            self.tables["contacts"].capacity["contact"],
        )
        touching, sleeping = can_touch(first), can_sleep(first)
        self.coupled = touching or sleeping or first.touch.user_count > 0
        self.step = ParallelStep(
            structs,
            extent,
            max(1, first.parameters.substeps),
            DEVICE,
            coupled=self.coupled,
            touching=touching,
            sleeping=sleeping,
        )

    def differences(self, number: int, world: World) -> list[str]:
        """Names of the arrays of which a bit differs between one of these worlds and a lone one."""
        lone = {"state": world.arrays.state, "contacts": world.touch.contacts}
        found = []
        for name, table in lone.items():
            for field, values in table.numpy.items():
                ours = self.tables[name].numpy[field][number, : values.shape[1]]
                if not np.array_equal(ours, values[0], equal_nan=True):
                    found.append(field)
        impulses = world.touch.couplings.numpy["user_impulse"]
        if not np.array_equal(
            self.tables["couplings"].numpy["user_impulse"][number, : impulses.shape[1]], impulses[0]
        ):
            found.append("user_impulse")
        return found


def _stack(struct: Any, tables: Sequence[ArrayTable], views: Mapping[str, str] | None = None) -> ArrayTable:
    stacked = ArrayTable(struct, len(tables), views)
    stacked.reserve({axis: max(table.capacity[axis] for table in tables) for axis in stacked.capacity})
    for number, table in enumerate(tables):
        for name, values in table.numpy.items():
            stacked.numpy[name][number, : values.shape[1]] = values[0]
    return stacked
