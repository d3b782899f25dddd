"""The arrays of everything bodies do to each other: shapes, contacts, constraints between them."""

from __future__ import annotations

from typing import Any

from carom.collision.capacity import scratch_capacity
from carom.collision.hierarchy import PAIRS
from carom.collision.manifold import REPEATED, THERE, WANTED
from carom.model.arrays import ArrayTable
from carom.model.builder import WorldArrays
from carom.model.contact_structs import COUPLING_ENTRY_VIEWS, Contacts, Couplings, Pairs, UserConstraints
from carom.model.shape_arrays import ShapeArrays
from carom.physics.couplings import ROWS_PER_PAIR


class TouchArrays:
    """Shapes, pairs, contacts, user constraints and the solver's rows over two trees."""

    def __init__(self, arrays: WorldArrays, device: str) -> None:
        self._arrays = arrays
        self._device = device
        worlds = arrays.world_count
        self.shapes: ShapeArrays = ShapeArrays()
        self.pairs: ArrayTable = ArrayTable(Pairs, worlds)
        self.contacts: ArrayTable = ArrayTable(Contacts, worlds)
        self.users: ArrayTable = ArrayTable(UserConstraints, None)
        self.couplings: ArrayTable = ArrayTable(Couplings, worlds, COUPLING_ENTRY_VIEWS)
        self.user_count = 0

    @property
    def contact_count(self) -> int:
        """Number of contacts now."""
        return int(self.contacts.numpy["count_contacts"][0, THERE])

    def forget_contacts(self) -> None:
        """Drop all contacts; the rows of their shapes are about to move."""
        self.contacts.numpy["count_contacts"][:] = 0

    def distrust_contacts(self) -> None:
        """Let no contact start from its last impulses: somebody has put a body elsewhere.

        So what follows depends on where everything is put, and not on what was there before.
        """
        count = int(self.contacts.numpy["count_contacts"][0, THERE])
        if count > 0:
            self.contacts.numpy["contact_impulse"][:, :count, 3] = 0.0

    def grow_detection(self) -> bool:
        """Make room for pairs and contacts that did not fit; true if there were some."""
        pairs = int(self.pairs.numpy["count_pairs"][0, PAIRS])
        contacts = int(self.contacts.numpy["count_contacts"][0, WANTED])
        grown = self.pairs.reserve({"pair": pairs})
        return self.contacts.reserve({"contact": contacts}) or grown

    def grow_couplings(self) -> None:
        """Double the room for rows over two trees; the step will be repeated, its detection as well."""
        self.contacts.numpy["count_contacts"][:, REPEATED] = 1
        capacity = self.couplings.capacity
        self.couplings.reserve({axis: 2 * capacity[axis] for axis in ("coupling", "jacobian", "run")})

    def reserve(self) -> None:
        """Bring arrays that go with others to the length of those."""
        model, contacts = self._arrays.model.capacity, self.contacts.capacity["contact"]
        self.shapes.reserve({"link": model["link"]})
        self.users.reserve({"user": self.user_count})
        self.pairs.reserve(scratch_capacity(self.shapes.shape_count, contacts))
        self.couplings.reserve(
            {
                "tree": model["tree"],
                "contact": contacts,
                "unit": contacts,
                "run": contacts,
                "patch": contacts // 2,
                "constraint": model["constraint"],
                "visit": self._arrays.scratch.capacity["row"] + ROWS_PER_PAIR * self.users.capacity["user"],
                "user": self.users.capacity["user"],
            }
        )

    def structs(self) -> dict[str, Any]:
        """Warp structs over the present arrays, by the name kernels give them."""
        self.reserve()
        return {
            "shapes": self.shapes.struct(self._device),
            "pairs": self.pairs.struct(self._device),
            "contacts": self.contacts.struct(self._device),
            "users": self.users.struct(self._device),
            "couplings": self.couplings.struct(self._device),
        }
