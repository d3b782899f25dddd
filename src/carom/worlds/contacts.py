"""Contacts of two bodies in each of many worlds."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom.checks import Array
from carom.engine.engine import Engine
from carom.engine.threads import WORLDS_PER_THREAD
from carom.layouts.contacts import THERE
from carom.layouts.queries import Touching
from carom.native.kernels import touching_kernel
from carom.native.launch import KernelStructs, Launch
from carom.native.tables import ArrayTable
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


class ContactList(NamedTuple):
    """Contact points of a body in many worlds, n of them, sorted by world.

    Attributes:
        worlds: Index of the world of each, (n,).
        links: Link of the body, -1 is the base, (n,).
        other_bodies: Id of the other body, (n,).
        other_links: Link of the other body, (n,).
        points: Point on the body in world axes [m], (n, 3).
        other_points: Point on the other body, (n, 3).
        normals: Unit vector from the other body towards the body, (n, 3).
        distances: Distance [m], < 0 for penetration, (n,).
        normal_forces: Force along the normal [N], (n,).
        forces: Force on the body, friction included, in world axes [N], (n, 3).
    """

    worlds: NDArray[np.int64]
    links: NDArray[np.int64]
    other_bodies: NDArray[np.int64]
    other_links: NDArray[np.int64]
    points: Array
    other_points: Array
    normals: Array
    distances: Array
    normal_forces: Array
    forces: Array

    def __repr__(self) -> str:
        return f"<ContactList of {len(self.worlds)} points>"


class ContactFinder:
    """Finds contacts between links in all worlds of an engine."""

    def __init__(self, engine: Engine) -> None:
        self._count = engine.arrays.world_count
        self._table = engine.table(Touching)
        self._table.reserve({"world": self._count, "link": engine.arrays.used["link"]})
        # Of the last query: the number of links, and whether all others count.
        self._kind = [0, False]
        # The two groups of links of the last query.
        self._asked: tuple[bytes, bytes] | None = None
        self._find = engine.task(partial(_launches, self._table, self._kind), WORLDS_PER_THREAD)

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

    def forces(self, first: np.ndarray, second: np.ndarray | None, substep_time: float) -> Array:
        """Force on each of some links by its contacts with others, by row; None for any: (worlds, links, 3).

        Impulses are converted to forces by the duration of a substep [s].
        """
        self._ask(first, second)
        impulses = np.array(self._table.numpy["place_impulse"][: self._count * len(first)])
        return impulses.reshape(self._count, len(first), 3) / substep_time

    def _ask(self, first: np.ndarray, second: np.ndarray | None) -> None:
        others = np.zeros(0, dtype=np.int64) if second is None else second
        asked = first.tobytes(), others.tobytes()
        moved = self._table.reserve({"place": self._count * len(first)})
        kind = [len(first), second is None]
        if moved or self._kind != kind:
            self._kind[:] = kind
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


def _launches(table: ArrayTable, kind: list[int], structs: KernelStructs) -> list[Launch]:
    structs.update(touching=table.struct())
    links, anything = map(int, kind)
    return [structs.launch(touching_kernel, links=links, anything=anything, first_world=0)]


def contact_list(
    engine: Engine,
    rows: np.ndarray,
    others: np.ndarray | None,
    places: Sequence[tuple[int, int]],
    substep_time: float,
) -> ContactList:
    """The contact points of links with others, by row; None for any.

    Args:
        engine: The engine.
        rows: The links.
        others: The other links.
        places: Body and link of each row.
        substep_time: Converts impulses to forces [s].
    """
    contacts = engine.contact_arrays.contacts.numpy
    counts = np.asarray(contacts["count_contacts"])[:, THERE]
    worlds = np.repeat(np.arange(len(counts)), counts)
    places_in_world = np.arange(len(worlds)) - np.repeat(np.cumsum(counts) - counts, counts)

    def field(name: str) -> np.ndarray:
        return np.asarray(contacts[f"contact_{name}"])[worlds, places_in_world]

    shapes, normals, impulses = field("shapes"), field("normal"), field("impulse")
    pushes = (
        impulses[:, :1] * normals
        + impulses[:, 1:2] * field("direction1")
        + impulses[:, 2:3] * field("direction2")
    )
    own = np.isin(np.arange(len(places)), rows)
    far = np.ones(len(places), dtype=bool) if others is None else np.isin(np.arange(len(places)), others)
    ends = shapes[:, 2], shapes[:, 3]
    # Each contact as seen from its side a, then as seen from its side b.
    wanted = np.stack([own[ends[0]] & far[ends[1]], own[ends[1]] & far[ends[0]]], axis=1)
    contact, side = np.nonzero(wanted)
    on_a = side == 0
    links = np.where(on_a, ends[0][contact], ends[1][contact])
    other_links = np.where(on_a, ends[1][contact], ends[0][contact])
    points = np.stack([field("point_a"), field("point_b")], axis=1)
    signs = np.where(on_a, 1.0, -1.0)[:, None]
    bodies_and_links = np.array(places, dtype=np.int64).reshape(-1, 2)
    return ContactList(
        worlds[contact],
        bodies_and_links[links, 1],
        bodies_and_links[other_links, 0],
        bodies_and_links[other_links, 1],
        points[contact, side],
        points[contact, 1 - side],
        signs * normals[contact],
        field("distance")[contact],
        impulses[contact, 0] / substep_time,
        signs * pushes[contact] / substep_time,
    )
