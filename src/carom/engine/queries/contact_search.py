"""Contact queries: arrays of their arguments and results."""

from __future__ import annotations

from collections.abc import Iterable
from struct import Struct
from typing import Any, NamedTuple

import numpy as np

from carom.engine.queries.question import Question
from carom.engine.quick_scene import QuickScene
from carom.layouts.queries import ContactReport
from carom.native.kernels import report_contacts_kernel
from carom.native.launch import KernelStructs
from carom.native.tables import NUMPY_REAL, ArrayTable, numbers_of

_VECTOR = Struct(f"3{np.dtype(NUMPY_REAL).char}")


class ContactColumns(NamedTuple):
    """Contacts in columns, to be read before the next query.

    Attributes:
        found: Number of contacts.
        columns: An iterable for each of: number of the first body, of the second body, link of the first
            body, of the second body (-1: the base), point on the first body, on the second body (in world
            axes [m]), normal on the second body towards the first, distance (negative: penetration [m]),
            normal force [N], force along the first friction direction [N], that direction, force along the
            second friction direction [N], that direction. Only the first `found` entries are valid; the
            iterables may be longer.
    """

    found: int
    columns: tuple[Iterable[Any], ...]


NO_CONTACTS = ContactColumns(0, ())


class ContactSearch:
    """Query the contacts of a world; addresses for quick calls are set in `quick`."""

    def __init__(self, structs: KernelStructs, contacts: ArrayTable, quick: QuickScene) -> None:
        self._contacts = contacts
        self._quick = quick
        asked = {"body_a": -1, "link_a": -2, "body_b": -1, "link_b": -2, "time_step": NUMPY_REAL(0.0)}
        self._search = Question(
            report_contacts_kernel, structs, "report", ArrayTable(ContactReport), asked, world=0
        )
        self._view()

    def __call__(
        self, count: int, overlaps: int, body_a: int, link_a: int, body_b: int, link_b: int, time_step: float
    ) -> ContactColumns:
        """The contacts, of which there are `count`, that match the query, in a world with so many overlaps.

        For the arguments see `report_contacts_kernel`.
        """
        if max(count, overlaps) > self._search.room:
            self._search.reserve(max(count, overlaps), self._view)
        self._search(count, body_a, link_a, body_b, link_b, time_step)
        found = self._found[0]
        if not found:
            return NO_CONTACTS
        on_a, on_b, normal, direction1, direction2 = map(_VECTOR.iter_unpack, self._vectors)
        distance, force, force1, force2 = self._reals
        return ContactColumns(
            found,
            (*self._indices, on_a, on_b, normal, distance, force, force1, direction1, force2, direction2),
        )

    def _view(self) -> None:
        """Keep views of the memory of the present arrays."""
        arrays, memory = self._search.arrays.numpy, self._search.arrays.bytes_of
        self._found: memoryview[int] = arrays["report_count"].data
        self._indices: list[memoryview[int]] = [
            arrays[f"report_{name}"].data for name in ("body_a", "body_b", "link_a", "link_b")
        ]
        self._reals = [
            numbers_of(arrays[f"report_{name}"]) for name in ("distance", "force", "force1", "force2")
        ]
        self._vectors = [
            memory(f"report_{name}") for name in ("point_a", "point_b", "normal", "direction1", "direction2")
        ]
        contacts = self._contacts.struct()
        self._quick.set_contact_addresses(self._search, contacts.count_contacts.data, contacts)
