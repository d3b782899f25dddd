"""Several worlds of the same scene in one set of arrays, stepped by the fine launches that are for GPUs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from tests.gpu.native_device import NativeDevice

from carom import World
from carom.engine.can_collide import can_sleep
from carom.engine.program import Plan
from carom.engine.workspace import Workspace
from carom.gpu.parallel_step import Extent, ParallelStep
from carom.native.tables import ArrayTable


class SideBySide:
    """Worlds of the same bodies, as they are now, each with its parameters; they themselves stay as they are.

    There is room for all pairs, and for as many contacts and rows as are asked for.

    Attributes:
        tables: Their arrays, by the names that kernels give them.
        coupled: Whether their bodies can touch, are tied together or can fall asleep.
    """

    def __init__(self, worlds: Sequence[World], *, contacts: int = 256, rows: int = 512) -> None:
        for world in worlds:
            world.prepare()
        first = worlds[0]
        arrays = first.arrays.repeated(len(worlds))
        contact_arrays = first.contact_arrays.repeated(arrays)
        contact_arrays.contacts.reserve({"contact": contacts})
        contact_arrays.reserve()
        self.tables: dict[str, ArrayTable] = {"state": arrays.state, "contacts": contact_arrays.contacts}
        self._parameters: dict[str, ArrayTable] = {
            "model": arrays.model,
            "shapes": contact_arrays.shapes.table,
            "users": contact_arrays.users,
        }
        for table in self._parameters.values():
            for name in [name for name in table.numpy if table.is_per_world(name)]:
                table.spread(name, len(worlds))
        for number, world in enumerate(worlds):
            for ours, theirs in (*self._beside(world), *self._parameters_beside(world)):
                ours[number, : theirs.shape[1]] = theirs[0, : ours.shape[1]]
        workspace = Workspace(len(worlds))
        workspace.fit(arrays, contact_arrays)
        workspace.pairs.reserve({"pair": 256})
        workspace.pair_rows.reserve({"row": rows, "jacobian": 8 * rows, "run": 8 * rows})
        shared = {
            "settings": first.engine.structs()["settings"],
            **arrays.structs(),
            **contact_arrays.structs(),
        }
        touching, sleeping = first.engine.can_collide, can_sleep(first.arrays)
        self.coupled = touching or sleeping or contact_arrays.user_count > 0
        self.step = ParallelStep(
            workspace.bind(shared),
            Extent(
                len(worlds),
                arrays.used["tree"],
                contact_arrays.shapes.shape_count,
                contact_arrays.contacts.capacity["contact"],
                workspace.pairs.capacity["pair"],
            ),
            max(1, first.parameters.substeps),
            NativeDevice(),
            Plan(touching, sleeping, self.coupled),
        )

    def differences(self, number: int, world: World) -> list[str]:
        """Names of the arrays of which a bit differs between one of these worlds and a lone one."""
        contacts = world.contact_arrays.contact_count
        found = []
        for name, (ours, theirs) in zip(self._names, self._beside(world), strict=True):
            if name == "status_entry":
                continue
            count = contacts if name.startswith("contact_") else min(ours.shape[1], theirs.shape[1])
            if not np.array_equal(ours[number, :count], theirs[0, :count], equal_nan=True):
                found.append(name)
        return found

    def _parameters_beside(self, world: World) -> list[tuple[np.ndarray, np.ndarray]]:
        lone = {
            "model": world.arrays.model,
            "shapes": world.contact_arrays.shapes.table,
            "users": world.contact_arrays.users,
        }
        return [
            (values, lone[name].numpy[field])
            for name, table in self._parameters.items()
            for field, values in table.numpy.items()
            if table.is_per_world(field)
        ]

    @property
    def _names(self) -> list[str]:
        return [name for table in self.tables.values() for name in table.numpy]

    def _beside(self, world: World) -> list[tuple[np.ndarray, np.ndarray]]:
        lone = {"state": world.arrays.state, "contacts": world.contact_arrays.contacts}
        return [
            (values, lone[name].numpy[field])
            for name, table in self.tables.items()
            for field, values in table.numpy.items()
        ]
