"""Several worlds of the same scene in one set of arrays, stepped by the fine launches that are for GPUs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from tests.gpu.native_device import NativeDevice

from carom import World
from carom.gpu.engine import DeviceEngine
from carom.layouts.contacts import SORTED
from carom.native.tables import ArrayTable


class SideBySide:
    """Worlds of the same bodies, as they are now, each with its parameters; they themselves stay as they are.

    There is room for all pairs, and for as many contacts and rows as are asked for.

    Attributes:
        engine: What steps them.
        tables: Their arrays, by the names that kernels give them.
    """

    def __init__(self, worlds: Sequence[World], *, contacts: int = 256, rows: int = 512) -> None:
        for world in worlds:
            world.prepare()
        first = worlds[0]
        self.engine = DeviceEngine.like(NativeDevice(), first.arrays, first.contact_arrays, len(worlds))
        self.engine.update_settings(first.parameters)
        arrays, contact_arrays, workspace = (
            self.engine.arrays,
            self.engine.contact_arrays,
            self.engine.workspace,
        )
        contact_arrays.contacts.reserve({"contact": contacts, "overlap": 256})
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
        workspace.pairs.reserve({"pair": 256, "queue": 512})
        workspace.pair_rows.reserve(
            {"row": rows, "jacobian": 8 * rows, "matrix": 8 * rows, "single": rows // 8}
        )
        self.engine.due[0] = max(1, first.parameters.substeps)
        self.engine.prepare()

    def step(self) -> None:
        """A step of all of them; worlds in which something does not fit stay where it began."""
        self.engine.run(self.engine._steppers)

    def differences(self, number: int, world: World) -> list[str]:
        """Names of the arrays of which a bit differs between one of these worlds and a lone one."""
        contacts = world.contact_arrays.contact_count
        found = []
        for name, (ours, theirs) in zip(self._names, self._beside(world), strict=True):
            if name == "status_entry":
                continue
            count = contacts if name.startswith("contact_") else min(ours.shape[1], theirs.shape[1])
            if name == "count_contacts":
                # What follows says whether the order of the overlaps is known already.
                count = SORTED
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
