"""Parameters of bodies, shapes and constraints that may differ between worlds."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from carom.engine.contact_arrays import ContactArrays
from carom.model.builder import WorldArrays
from carom.native.tables import ArrayTable


class WorldParameters(ABC):
    """Reading and setting parameters of each world; `Engine` has the tables."""

    arrays: WorldArrays
    contact_arrays: ContactArrays

    @abstractmethod
    def changed(self) -> None:
        """Renew the launches before the next step."""

    def spread(self, table: str, field: str) -> None:
        """Give each world its own value of a parameter that was shared.

        Args:
            table: "model", "shapes" or "users".
            field: The field in it.
        """
        if self.table_of(table).spread(field, self.arrays.world_count):
            self.changed()

    def parameter(self, table: str, field: str, rows: int | slice) -> np.ndarray:
        """A copy of a parameter as it is in each world: (worlds, ...).

        Args:
            table: "model", "shapes" or "users".
            field: The field in it.
            rows: The rows to read.
        """
        values = self.table_of(table).numpy[field][:, rows]
        return np.broadcast_to(values, (self.arrays.world_count, *values.shape[1:])).copy()

    def set_parameter(
        self,
        table: str,
        field: str,
        rows: int | slice,
        values: np.ndarray,
        worlds: slice | np.ndarray = slice(None),
    ) -> None:
        """Set a parameter in each world, or in some.

        Args:
            table: "model", "shapes" or "users".
            field: The field in it.
            rows: The rows to set.
            values: New values; the first axis is that of the worlds.
            worlds: Index of the worlds; all by default.
        """
        self.spread(table, field)
        parameters = self.table_of(table)
        parameters.numpy[field][worlds, rows] = values
        parameters.written(field)

    def table_of(self, table: str) -> ArrayTable:
        """The table with parameters that can differ between worlds: "model", "shapes" or "users"."""
        return {
            "model": self.arrays.model,
            "shapes": self.contact_arrays.shapes.table,
            "users": self.contact_arrays.users,
        }[table]
