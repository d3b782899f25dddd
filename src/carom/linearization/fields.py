"""Fields of tables in one world."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

    from carom.native.tables import ArrayTable


class Fields:
    """Fields of a table in one of its worlds, by name."""

    __slots__ = ("_found", "_table", "_world")

    def __init__(self, table: ArrayTable, world: int) -> None:
        self._table = table
        self._world = world
        self._found: dict[str, np.ndarray] = {}

    def __getitem__(self, name: str) -> np.ndarray:
        found = self._found.get(name)
        if found is None:
            found = self._table.numpy[name]
            if self._table.is_per_world(name):
                found = found[self._world if len(found) > 1 else 0]
            self._found[name] = found
        return found
