"""Contacts of two bodies in each of many worlds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom.checks import Array
from carom.engine.engine import Engine
from carom.layouts.contacts import THERE


class ContactSummary(NamedTuple):
    """How a body touches another in each world.

    Attributes:
        touching: Whether there is a contact that pushes, (count,).
        number: Number of contact points, those included whose points are still apart, (count,).
        forces: Force on the body, friction included, in world axes [N], (count, 3).
        distances: Of the deepest point [m], negative for penetration; infinite without any, (count,).
        deepest: That point on the body in world axes [m], (count, 3); NaN without any.
    """

    touching: NDArray[np.bool_]
    number: NDArray[np.int64]
    forces: Array
    distances: Array
    deepest: Array


def summarise_contacts(
    engine: Engine, first: np.ndarray, second: np.ndarray | None, substep_time: float
) -> ContactSummary:
    """The contacts of some links with others.

    Args:
        engine: The worlds.
        first: Rows of links.
        second: Rows of other links; None for any.
        substep_time: Of a substep [s]; makes forces of impulses.
    """
    contacts = engine.contact_arrays.contacts.numpy
    counts = contacts["count_contacts"][:, THERE]
    rows = slice(int(counts.max(initial=0)))
    there = np.arange(rows.stop) < counts[:, None]
    on_a, on_b = contacts["contact_shapes"][:, rows, 2], contacts["contact_shapes"][:, rows, 3]
    is_a, is_b = np.isin(on_a, first), np.isin(on_b, first)
    if second is not None:
        is_a, is_b = is_a & np.isin(on_b, second), is_b & np.isin(on_a, second)
    # Within a body a contact has its first link on side a.
    is_b &= ~is_a
    is_a, is_b = is_a & there, is_b & there
    chosen = is_a | is_b
    impulses = contacts["contact_impulse"][:, rows]
    directions = [contacts[f"contact_{name}"][:, rows] for name in ("normal", "direction1", "direction2")]
    on_side_a = sum(impulses[..., axis, None] * way for axis, way in enumerate(directions))
    # Normals point from b to a and the impulses along them push a away.
    sign = np.where(is_a, 1.0, -1.0)[..., None] * chosen[..., None]
    forces = (sign * on_side_a).sum(axis=1) / substep_time
    distance = np.where(chosen, contacts["contact_distance"][:, rows], np.inf)
    touching = np.asarray((chosen & (impulses[..., 0] > 0.0)).any(axis=1))
    if rows.stop == 0:
        nowhere = np.full((len(counts), 3), np.nan)
        return ContactSummary(touching, chosen.sum(axis=1), forces, np.full(len(counts), np.inf), nowhere)
    lowest = distance.argmin(axis=1)
    worlds = np.arange(len(counts))
    point = np.where(
        is_a[worlds, lowest, None],
        contacts["contact_point_a"][worlds, lowest],
        contacts["contact_point_b"][worlds, lowest],
    )
    least = distance[worlds, lowest]
    deepest = np.where(np.isfinite(least)[:, None], point, np.nan)
    return ContactSummary(touching, chosen.sum(axis=1), forces, least, deepest)


def links_in_contact(engine: Engine, first: np.ndarray, second: np.ndarray) -> NDArray[np.bool_]:
    """Which of some links have a contact point with some others in each world.

    Args:
        engine: The worlds.
        first: Rows of links, which follow each other.
        second: Rows of the others, likewise.

    Returns:
        (worlds, links) booleans.
    """
    contacts = engine.contact_arrays.contacts.numpy
    counts = contacts["count_contacts"][:, THERE]
    touching = np.zeros((len(counts), len(first)), dtype=bool)
    worlds, points = np.nonzero(np.arange(counts.max(initial=0)) < counts[:, None])
    sides = contacts["contact_shapes"][worlds, points, 2:4]
    for own, other in (sides.T, sides.T[::-1]):
        places = own - first[0]
        chosen = (places >= 0) & (places < len(first)) & (other >= second[0]) & (other <= second[-1])
        touching[worlds[chosen], places[chosen]] = True
    return touching
