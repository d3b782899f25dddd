"""Contacts of two bodies in each of many worlds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom.checks import Array
from carom.engine.engine import Engine
from carom.engine.threads import WORLDS_PER_THREAD
from carom.layouts.queries import Touching
from carom.native.kernels import touching_kernel
from carom.native.launch import KernelStructs, Launch
from carom.worlds.soft_contacts import SoftTouches


class ContactSummary(NamedTuple):
    """Contacts of a body with another in each world.

    Attributes:
        touching: Whether there is a contact with a force, (count,).
        number: Number of contact points, including those that do not touch yet, (count,).
        forces: Force on the body, friction included, in world axes [N], (count, 3).
        distances: Distance at the deepest point [m], < 0 for penetration, inf without contacts, (count,).
        deepest: Deepest point on the body in world axes [m], (count, 3); NaN without contacts.
    """

    touching: NDArray[np.bool_]
    number: NDArray[np.int32]
    forces: Array
    distances: Array
    deepest: Array

    def include(self, touches: Sequence[tuple[int, SoftTouches]]) -> None:
        """Include contacts of soft bodies, by world."""
        if not touches:
            return
        # Changed on the host, as the arrays may be on a device.
        touching, number, forces, distances, deepest = (np.array(field) for field in self)
        for world, found in touches:
            touching[world] |= bool((found.pushes > 0.0).any())
            number[world] += len(found.links)
            forces[world] += found.forces.sum(axis=0)
            nearest = int(found.distances.argmin())
            if found.distances[nearest] < distances[world]:
                distances[world] = found.distances[nearest]
                deepest[world] = found.points[nearest]
        for own, changed in zip(self, (touching, number, forces, distances, deepest), strict=True):
            own[...] = changed


class ContactFinder:
    """Finds contacts between links in all worlds of an engine."""

    def __init__(self, engine: Engine) -> None:
        self._count = engine.arrays.world_count
        self._table = engine.table(Touching)
        self._table.reserve({"world": self._count, "link": engine.arrays.used["link"]})
        self._links = 0
        self._anything = False
        # The two groups of links of the last query.
        self._asked: tuple[bytes, bytes] | None = None
        self._find = engine.task(self._launches, WORLDS_PER_THREAD)

    def summary(self, first: np.ndarray, second: np.ndarray | None, substep_time: float) -> ContactSummary:
        """Summary of the contacts of links with others, by row; None for any.

        Impulses are converted to forces by the duration of a substep [s].
        """
        self._ask(first, second)
        touching, number, impulse, distance, deepest = (
            self._table.numpy[f"world_{name}"][: self._count].copy()
            for name in ("touching", "number", "impulse", "distance", "deepest")
        )
        return ContactSummary(touching.view(np.bool_), number, impulse / substep_time, distance, deepest)

    def links(self, first: np.ndarray, second: np.ndarray) -> NDArray[np.bool_]:
        """Whether each of some links has a contact point with any of others, by row: (worlds, links)."""
        self._ask(first, second)
        touching = self._table.numpy["place_touching"][: self._count * len(first)].copy()
        return touching.view(np.bool_).reshape(self._count, len(first))

    def _ask(self, first: np.ndarray, second: np.ndarray | None) -> None:
        others = np.zeros(0, dtype=np.int64) if second is None else second
        asked = first.tobytes(), others.tobytes()
        moved = self._table.reserve({"place": self._count * len(first)})
        if moved or (self._links, self._anything) != (len(first), second is None):
            self._links, self._anything = len(first), second is None
            self._find.renew()
        if moved or asked != self._asked:
            links = self._table.capacity["link"]
            places, is_other = np.full(links, -1, dtype=np.int32), np.zeros(links, dtype=np.int32)
            places[first] = np.arange(len(first))
            is_other[others] = 1
            self._table.numpy["link_place"][:] = places
            self._table.numpy["link_other"][:] = is_other
            self._asked = asked
        self._find()

    def _launches(self, structs: KernelStructs) -> list[Launch]:
        structs.update(touching=self._table.struct())
        anything = int(self._anything)
        return [structs.launch(touching_kernel, links=self._links, anything=anything, first_world=0)]
