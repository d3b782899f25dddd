"""The arrays of everything bodies do to each other: shapes, contacts, constraints between them."""

from __future__ import annotations

from typing import Any

from carom.model.arrays import ArrayTable
from carom.model.builder import WorldArrays
from carom.model.contact_structs import (
    COUPLING_ENTRY_VIEWS,
    Contacts,
    Couplings,
    UserConstraints,
)
from carom.model.shape_arrays import ShapeArrays

ROWS_PER_PAIR = 6


class TouchArrays:
    """Shapes, contacts, user constraints and the solver's rows over two trees."""

    def __init__(self, arrays: WorldArrays, device: str) -> None:
        self._arrays = arrays
        self._device = device
        worlds = arrays.world_count
        self.shapes = ShapeArrays()
        self.contacts = ArrayTable(Contacts, worlds)
        self.users = ArrayTable(UserConstraints, None)
        self.couplings = ArrayTable(Couplings, worlds, COUPLING_ENTRY_VIEWS)
        self.user_count = 0

    def grow(self) -> None:
        """Double the room for contacts and rows."""
        contacts = 2 * self.contacts.capacity["contact"]
        self.contacts.reserve({"contact": contacts})
        self.couplings.reserve(
            {
                "coupling": 2 * self.couplings.capacity["coupling"],
                "jacobian": 2 * self.couplings.capacity["jacobian"],
            }
        )

    def structs(self) -> tuple[Any, Any, Any, Any]:
        """Warp structs of shapes, contacts, user constraints and couplings over the present arrays."""
        trees = self._arrays.model.capacity["tree"]
        self.shapes.reserve({"link": self._arrays.model.capacity["link"]})
        self.users.reserve({"user": self.user_count})
        self.couplings.reserve(
            {
                "tree": trees,
                "contact": self.contacts.capacity["contact"],
                "constraint": self._arrays.model.capacity["constraint"],
                "visit": self._arrays.scratch.capacity["row"] + ROWS_PER_PAIR * self.users.capacity["user"],
                "user": self.users.capacity["user"],
            }
        )
        return (
            self.shapes.struct(self._device),
            self.contacts.struct(self._device),
            self.users.struct(self._device),
            self.couplings.struct(self._device),
        )
